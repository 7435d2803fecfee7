"""The emulated hand: the firmware around its motor, which follows a reference in time and draws current."""

from __future__ import annotations

from collections.abc import Callable

from robots.drivers.emulation.plant import ToolPlant

CLOSED_TICKS = 19000
_OPEN_MA, _SPRINGS_MA = 60.0, 200.0
_PULL_MA = 750.0
"""Motor current of the greatest force, beyond that for closing equally far on nothing."""
# What the firmware of the hand itself limits the motor to.
_MOST_MA = 1000.0


class EmulatedHand:
    """Measurements with time behind them; `now_s` is its clock, `motor` winds the tendon.

    Attributes:
        active: Whether the motor is on.
        extra_ma: Current that a defect draws.
        reference_ticks: What it follows while it is active.
        commands: Number of commands received.
    """

    def __init__(self, now_s: Callable[[], float], motor: ToolPlant, *, active: bool) -> None:
        self.now_s = now_s
        self.active = active
        self.extra_ma = 0.0
        self.reference_ticks = 0
        self.commands = 0
        self._motor = motor

    @property
    def position_ticks(self) -> int:
        """The measured position now."""
        return round(CLOSED_TICKS * self._motor.measured().closed_share)

    @property
    def current_ma(self) -> int:
        """The measured motor current now."""
        if not self.active:
            return round(self.extra_ma)
        now = self._motor.measured()
        free_ma = _OPEN_MA + _SPRINGS_MA * now.closed_share
        return round(min(_MOST_MA, free_ma + _PULL_MA * now.force_share) + self.extra_ma)

    @property
    def moving(self) -> bool:
        """Whether the motor turns."""
        return self.active and self._motor.measured().moving

    def follow(self, ticks: int) -> None:
        """Take a reference."""
        self.commands += 1
        self.reference_ticks = min(CLOSED_TICKS, max(0, ticks))
        self._drive()

    def activate(self, *, on: bool) -> None:
        """Switch the motor on or off."""
        self.commands += 1
        self.switch(on=on)

    def switch(self, *, on: bool) -> None:
        """Switch the motor on or off, without a command; its gear keeps the tendon wound."""
        self.active = on
        if on:
            self._drive()
        else:
            self._motor.stop()

    def restart(self) -> None:
        """Switch off and on: the motor is off, and the fingers are where they were."""
        self.extra_ma = 0.0
        self.switch(on=False)
        self.reference_ticks = self.position_ticks

    def _drive(self) -> None:
        if self.active:
            self._motor.close_to(self.reference_ticks / CLOSED_TICKS)
