"""The emulated gripper: fingers that take time, stop at objects, and refuse while there is a fault."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from robots.drivers.robotiq.gripper_registers import (
    RESET,
    ActivationStatus,
    GripperCommand,
    GripperStatus,
    ObjectStatus,
)
from robots.drivers.robotiq.gripper_units import WidthTable, count_of_width, speed_of_count, width_of_count

WIDTHS: WidthTable = ((3, 0.085), (230, 0.0))
_OPEN, _CLOSED = WIDTHS[0][0], WIDTHS[-1][0]
_COUNTS_M = (_CLOSED - _OPEN) / WIDTHS[0][1]
_RESET_FAULT = 0xA
_NOT_ACTIVATED, _DELAYED = 0x7, 0x5
_MOVING_A, _PRESSING_A = 0.15, 0.5


class EmulatedGripper:
    """Registers with time behind them; `now_s` is its clock.

    Attributes:
        object_m: Width of what is between the fingers, None for nothing.
        ring_m: Inner width of what is around the fingers, None for nothing.
        fault: Its fault code; while there is one, nothing moves.
        travel: Counts that the fingers have passed since it was switched on.
        stopped_s: When the last command to stop arrived, on its clock.
        rested_s: When the fingers last came to rest.
        commands: Number of commands received.
    """

    def __init__(self, now_s: Callable[[], float], *, activation_s: float) -> None:
        self.now_s = now_s
        self._activation_s = activation_s
        self.object_m: float | None = None
        self.ring_m: float | None = None
        self.fault = 0
        self.travel = 0.0
        self.commands = 0
        self.stopped_s = self.rested_s = 0.0
        self._command = RESET
        self._activation = ActivationStatus.RESET
        self._active_at_s = 0.0
        self._contact = ObjectStatus.MOVING
        self._position = float(_CLOSED // 2)
        self._time_s = now_s()

    @property
    def width_m(self) -> float:
        """The opening now."""
        self.advance()
        return width_of_count(round(self._position), WIDTHS)

    def restart(self) -> None:
        """Switch off and on: nothing is activated, and the fingers are where they were."""
        self.advance()
        self._command, self._activation, self.fault = RESET, ActivationStatus.RESET, 0
        self._contact = ObjectStatus.MOVING
        self.travel = 0.0

    def command(self, command: GripperCommand) -> None:
        """Take the command registers."""
        self.advance()
        now_s = self.now_s()
        self.commands += 1
        if not command.activate:
            self._activation = ActivationStatus.RESET
            self.fault = 0 if self.fault >= _RESET_FAULT else self.fault
            command = replace(command, go=False)
        elif self._activation is ActivationStatus.RESET:
            self._activation, self._active_at_s = ActivationStatus.ACTIVATING, now_s + self._activation_s
        if self._command.go and not command.go:
            self.stopped_s = now_s
        if command.go:
            self._contact = ObjectStatus.MOVING
        self._command = command

    def status(self) -> GripperStatus:
        """Return the status registers."""
        self.advance()
        command, moving = self._command, self._moving()
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
            position=round(self._position),
            current_a=_MOVING_A if moving else _PRESSING_A if touching and command.go else 0.0,
        )

    def advance(self) -> None:
        """Move the fingers up to now."""
        now_s = self.now_s()
        elapsed_s, self._time_s = now_s - self._time_s, now_s
        if self._activation is ActivationStatus.ACTIVATING and now_s >= self._active_at_s:
            # It closes and opens once.
            self._activation = ActivationStatus.ACTIVE
            self.travel += _CLOSED - _OPEN
            self._position = float(_OPEN)
            self._contact = ObjectStatus.AT_POSITION
        if not self._moving():
            return
        step = speed_of_count(self._command.speed) * _COUNTS_M * elapsed_s
        end, contact = self._end()
        distance = end - self._position
        travelled = min(abs(distance), step)
        self.travel += travelled
        self._position += travelled if distance > 0 else -travelled
        if travelled == abs(distance):
            self._contact, self.rested_s = contact, now_s

    def _moving(self) -> bool:
        active = self._activation is ActivationStatus.ACTIVE
        return active and self._command.go and not self.fault and self._contact is ObjectStatus.MOVING

    def _end(self) -> tuple[float, ObjectStatus]:
        """Return where the fingers stop, and what they say there."""
        goal = float(min(_CLOSED, max(_OPEN, self._command.position)))
        if goal >= self._position and self.object_m is not None:
            touch = count_of_width(self.object_m, WIDTHS)
            if self._position <= touch < goal:
                return float(touch), ObjectStatus.CONTACT_CLOSING
        if goal <= self._position and self.ring_m is not None:
            touch = count_of_width(self.ring_m, WIDTHS)
            if goal < touch <= self._position:
                return float(touch), ObjectStatus.CONTACT_OPENING
        return goal, ObjectStatus.AT_POSITION
