"""The ports of simulated arms and grippers, alike over both hosts."""

from __future__ import annotations

import numpy as np

from engine.errors import RobotError
from robots.control.playback import verified
from robots.port import ArmSample, GripperSample, JointTrajectory, Tolerance
from robots.sim.commands import AnyCommand, CloseTo, Follow
from robots.sim.host import Host
from robots.sim.motion_board import MotionBoard, SimMotion
from robots.sim.snapshot import ArmSummary


class _OneMotion:
    """At most one motion of one device at a time."""

    def __init__(self, device: str, board: MotionBoard) -> None:
        self._device = device
        self._board = board
        self._motion: SimMotion | None = None

    def number(self) -> int:
        """Return the number for the next motion; raises RobotError while one is under way."""
        if self._motion is not None and not self._motion.ended:
            raise RobotError(
                "another motion is under way", where=self._device, hint="wait for its report, or cancel it first"
            )
        return self._board.next_number()

    def start(self, motion: SimMotion, host: Host, command: AnyCommand) -> SimMotion:
        """Give the command and keep the motion; what could not be sent is not under way."""
        host.send(command)
        self._board.add(motion)
        self._motion = motion
        return motion


class SimArmPort:
    """Implements `robots.port.ArmPort` for one arm of a simulated world."""

    def __init__(self, host: Host, board: MotionBoard, arm: ArmSummary) -> None:
        self._host = host
        self._arm = arm
        self._one = _OneMotion(arm.name, board)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names in order."""
        return self._arm.joints

    def sample(self) -> ArmSample:
        """The newest measurement."""
        return self._host.snapshot().arm(self._arm.name)

    def follow(self, trajectory: JointTrajectory, *, tolerance: Tolerance) -> SimMotion:
        """Start following.

        Raises:
            RobotError: another motion is under way, the trajectory does not start at the set point
                at rest, or the world is gone.
        """
        number = self._one.number()
        name, host = self._arm.name, self._host
        checked = verified(trajectory, start_rad=np.asarray(self.sample().desired_rad), joints=self._arm.joints)
        motion = SimMotion(number, send=host.send, progress=lambda: host.snapshot().arm_progress(name, number))
        return self._one.start(motion, host, Follow.of(name, number, checked, tolerance))


class SimGripperPort:
    """Implements `robots.port.GripperPort` for the hand of one arm of a simulated world."""

    def __init__(self, host: Host, board: MotionBoard, arm: ArmSummary) -> None:
        self._host = host
        self._arm = arm
        self._one = _OneMotion(f"{arm.name}/gripper", board)

    @property
    def max_width_m(self) -> float:
        """Opening when fully open."""
        return self._arm.gripper_width_m

    def sample(self) -> GripperSample:
        """The newest measurement."""
        return self._host.snapshot().gripper(self._arm.name)

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> SimMotion:
        """Move the fingers towards `width_m`, pressing with at most `force_n`.

        Raises:
            RobotError: another motion is under way, a number is senseless, or the world is gone.
        """
        number = self._one.number()
        for what, value in (("width_m", width_m), ("speed_m_s", speed_m_s), ("force_n", force_n)):
            if not np.isfinite(value) or value < 0.0 or (value == 0.0 and what != "width_m"):
                raise RobotError(f"{what} cannot be {value}", where=f"{self._arm.name}/gripper")
        name, host = self._arm.name, self._host
        motion = SimMotion(number, send=host.send, progress=lambda: host.snapshot().gripper_progress(name, number))
        command = CloseTo(arm=name, motion=number, width_m=width_m, speed_m_s=speed_m_s, force_n=force_n)
        return self._one.start(motion, host, command)
