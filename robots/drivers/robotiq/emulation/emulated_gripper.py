"""The emulated gripper: registers, activation and faults over fingers, which are its own or those of a world."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from robots.drivers.emulation.plant import ToolPlant
from robots.drivers.robotiq.emulation.kinematic_fingers import (
    CLOSED,
    OPEN,
    count_of_share,
    width_of_share,
)
from robots.drivers.robotiq.gripper_registers import (
    RESET,
    ActivationStatus,
    GripperCommand,
    GripperStatus,
    ObjectStatus,
)
from robots.drivers.robotiq.gripper_units import MAX_FORCE_N, MAX_SPEED_M_S, force_of_count, speed_of_count

_RESET_FAULT = 0xA
_NOT_ACTIVATED, _DELAYED = 0x7, 0x5
_MOVING_A, _PRESSING_A = 0.15, 0.5


class EmulatedGripper:
    """Registers with time behind them; `now_s` is its clock.

    Attributes:
        fault: Its fault code; while there is one, nothing moves.
        stopped_s: When the last command to stop arrived, on its clock.
        commands: Number of commands received.
    """

    def __init__(self, now_s: Callable[[], float], fingers: ToolPlant, *, activation_s: float) -> None:
        self.now_s = now_s
        self._fingers = fingers
        self._activation_s = activation_s
        self.fault = 0
        self.commands = 0
        self.stopped_s = 0.0
        self._command = RESET
        self._activation = ActivationStatus.RESET
        self._active_at_s = 0.0
        self._contact = ObjectStatus.MOVING
        self._closing = False
        self._driving = False

    @property
    def width_m(self) -> float:
        """The opening now."""
        self.advance()
        return width_of_share(self._fingers.measured().closed_share)

    def restart(self) -> None:
        """Switch off and on: nothing is activated, and the fingers are where they were."""
        self.advance()
        self._command, self._activation, self.fault = RESET, ActivationStatus.RESET, 0
        self._contact, self._driving = ObjectStatus.MOVING, False
        self._fingers.stop()

    def command(self, command: GripperCommand) -> None:
        """Take the command registers."""
        self.advance()
        now_s = self.now_s()
        self.commands += 1
        if not command.activate:
            self._activation = ActivationStatus.RESET
            self.fault = 0 if self.fault >= _RESET_FAULT else self.fault
            command = replace(command, go=False)
            self._fingers.stop()
        elif self._activation is ActivationStatus.RESET:
            self._activation, self._active_at_s = ActivationStatus.ACTIVATING, now_s + self._activation_s
            self._fingers.home()
        if self._command.go and not command.go:
            self.stopped_s = now_s
        if command.go:
            self._contact, self._driving = ObjectStatus.MOVING, False
        self._command = command
        self.advance()

    def status(self) -> GripperStatus:
        """Return the status registers."""
        self.advance()
        command, moving = self._command, self._may_move()
        fault = self.fault
        if not fault and command.go and not command.activate:
            fault = _NOT_ACTIVATED
        elif not fault and command.go and self._activation is ActivationStatus.ACTIVATING:
            fault = _DELAYED
        touching = self._contact in (ObjectStatus.CONTACT_OPENING, ObjectStatus.CONTACT_CLOSING)
        return GripperStatus(
            activated=command.activate,
            go=command.go,
            activation=self._activation,
            contact=self._contact,
            fault=fault,
            position_echo=command.position,
            position=count_of_share(self._fingers.measured().closed_share),
            current_a=_MOVING_A if moving else _PRESSING_A if touching and command.go else 0.0,
        )

    def advance(self) -> None:
        """Drive the fingers, or stop them, and see how far they are now."""
        fingers = self._fingers
        reading = fingers.measured()
        if self._activation is ActivationStatus.ACTIVATING:
            if self.now_s() >= self._active_at_s and not reading.moving:
                self._activation, self._contact = ActivationStatus.ACTIVE, ObjectStatus.AT_POSITION
            return
        if self._may_move() != self._driving:
            self._driving = not self._driving
            self._drive() if self._driving else fingers.stop()
            reading = fingers.measured()
        if self._driving and not reading.moving:
            self._driving, self._contact = False, self._end(blocked=reading.blocked)
        elif self._contact in (ObjectStatus.CONTACT_OPENING, ObjectStatus.CONTACT_CLOSING) and self._command.go:
            # What it held is gone: the standing command has moved the fingers on.
            self._contact = self._end(blocked=reading.blocked)

    def _may_move(self) -> bool:
        active = self._activation is ActivationStatus.ACTIVE
        return active and self._command.go and not self.fault and self._contact is ObjectStatus.MOVING

    def _drive(self) -> None:
        command = self._command
        goal = min(CLOSED, max(OPEN, command.position))
        self._closing = goal >= count_of_share(self._fingers.measured().closed_share)
        self._fingers.close_to(
            (goal - OPEN) / (CLOSED - OPEN),
            speed_share=speed_of_count(command.speed) / MAX_SPEED_M_S,
            force_share=force_of_count(command.force) / MAX_FORCE_N,
        )

    def _end(self, *, blocked: bool) -> ObjectStatus:
        if not blocked:
            return ObjectStatus.AT_POSITION
        return ObjectStatus.CONTACT_CLOSING if self._closing else ObjectStatus.CONTACT_OPENING
