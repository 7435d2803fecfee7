"""Modes of an emulated controller: power, protective stop and emergency stop, as RTDE and the dashboard name them."""

from __future__ import annotations

from enum import IntEnum


class UrRobotMode(IntEnum):
    """RTDE variable `robot_mode`."""

    POWER_OFF = 3
    POWER_ON = 4
    IDLE = 5
    BACKDRIVE = 6
    RUNNING = 7


class UrSafetyMode(IntEnum):
    """RTDE variable `safety_mode`, and the words of the dashboard."""

    NORMAL = 1
    REDUCED = 2
    PROTECTIVE_STOP = 3
    RECOVERY = 4
    SAFEGUARD_STOP = 5
    SYSTEM_EMERGENCY_STOP = 6
    ROBOT_EMERGENCY_STOP = 7
    VIOLATION = 8
    FAULT = 9


_NORMAL_BIT, _PROTECTIVE_BIT, _ROBOT_EMERGENCY_BIT, _EMERGENCY_BIT, _STOPPED_BIT = 0, 2, 6, 7, 10
UNLOCK_DELAY_S = 5.0
"""A protective stop cannot be unlocked earlier: a person has to look at its cause first."""


class ControllerSafety:
    """The state of power and of stops; times are those of the controller's clock."""

    def __init__(self) -> None:
        self.robot_mode = UrRobotMode.RUNNING
        self.safety_mode = UrSafetyMode.NORMAL
        self._stopped_at_s = 0.0

    @property
    def is_powered(self) -> bool:
        """Whether the joints have power."""
        return self.robot_mode is not UrRobotMode.POWER_OFF

    @property
    def can_move(self) -> bool:
        """Whether programs may move the arm."""
        return self.robot_mode is UrRobotMode.RUNNING and self.safety_mode is UrSafetyMode.NORMAL

    @property
    def joint_mode(self) -> int:
        """RTDE variable `joint_mode`: 253 is running, 255 idle."""
        return 253 if self.robot_mode is UrRobotMode.RUNNING else 255

    @property
    def status_bits(self) -> int:
        """RTDE variable `safety_status_bits`."""
        if self.safety_mode is UrSafetyMode.PROTECTIVE_STOP:
            return 1 << _PROTECTIVE_BIT | 1 << _STOPPED_BIT
        if self.safety_mode is UrSafetyMode.ROBOT_EMERGENCY_STOP:
            return 1 << _ROBOT_EMERGENCY_BIT | 1 << _EMERGENCY_BIT | 1 << _STOPPED_BIT
        return 1 << _NORMAL_BIT

    def protective_stop(self, now_s: float) -> None:
        """Stop, with power; the earliest time of unlocking counts from now."""
        if self.safety_mode is UrSafetyMode.NORMAL:
            self.safety_mode = UrSafetyMode.PROTECTIVE_STOP
            self._stopped_at_s = now_s

    def can_unlock(self, now_s: float) -> bool:
        """Whether there is a protective stop that is old enough."""
        return self.safety_mode is UrSafetyMode.PROTECTIVE_STOP and now_s - self._stopped_at_s >= UNLOCK_DELAY_S

    def unlock(self) -> None:
        """End a protective stop."""
        self.safety_mode = UrSafetyMode.NORMAL

    def emergency_stop(self) -> None:
        """Take the power off the joints."""
        self.safety_mode = UrSafetyMode.ROBOT_EMERGENCY_STOP
        self.robot_mode = UrRobotMode.POWER_OFF

    def release_emergency_stop(self) -> None:
        """Pull the button out: the joints stay without power."""
        if self.safety_mode is UrSafetyMode.ROBOT_EMERGENCY_STOP:
            self.safety_mode = UrSafetyMode.NORMAL

    def power_on(self) -> None:
        """Give the joints power, with their brakes on."""
        if self.robot_mode is UrRobotMode.POWER_OFF and self.safety_mode is not UrSafetyMode.ROBOT_EMERGENCY_STOP:
            self.robot_mode = UrRobotMode.IDLE

    def release_brakes(self) -> None:
        """Make the arm ready to move, with power on where it is off."""
        self.power_on()
        if self.robot_mode is UrRobotMode.IDLE:
            self.robot_mode = UrRobotMode.RUNNING

    def power_off(self) -> None:
        """Take the power off the joints."""
        self.robot_mode = UrRobotMode.POWER_OFF
