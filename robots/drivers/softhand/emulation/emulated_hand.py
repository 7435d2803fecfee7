"""The emulated hand: a motor that follows its reference in time, and draws current where it is blocked."""

from __future__ import annotations

from collections.abc import Callable

CLOSED_TICKS = 19000
_FASTEST_TICKS_S = 30000.0
_OPEN_MA, _SPRINGS_MA = 60.0, 200.0
_BLOCKED_MA_TICK = 0.25
# What the firmware of the hand itself limits the motor to.
_MOST_MA = 1000.0


class EmulatedHand:
    """Measurements with time behind them; `now_s` is its clock.

    Attributes:
        active: Whether the motor is on.
        object_share: Closed share at which an object blocks the fingers, None for nothing.
        extra_ma: Current that a defect draws.
        stuck: Whether the motor does not turn, and draws no more for it.
        reference_ticks: What it follows while it is active.
        travel: Ticks that the motor has passed.
        commands: Number of commands received.
    """

    def __init__(self, now_s: Callable[[], float], *, active: bool) -> None:
        self.now_s = now_s
        self.active = active
        self.object_share: float | None = None
        self.extra_ma = 0.0
        self.stuck = False
        self.reference_ticks = 0
        self.travel = 0.0
        self.commands = 0
        self._position_ticks = 0.0
        self._time_s = now_s()

    @property
    def position_ticks(self) -> int:
        """The measured position now."""
        self.advance()
        return round(self._position_ticks)

    @property
    def current_ma(self) -> int:
        """The measured motor current now."""
        self.advance()
        if not self.active:
            return round(self.extra_ma)
        springs_ma = _OPEN_MA + _SPRINGS_MA * self._position_ticks / CLOSED_TICKS
        pressed = self._end_ticks() != self.reference_ticks and self._position_ticks >= self._end_ticks()
        blocked_ma = _BLOCKED_MA_TICK * (self.reference_ticks - self._position_ticks) if pressed else 0.0
        return round(min(_MOST_MA, springs_ma + blocked_ma) + self.extra_ma)

    @property
    def moving(self) -> bool:
        """Whether the motor turns."""
        self.advance()
        return self.active and self._position_ticks != self._end_ticks()

    def follow(self, ticks: int) -> None:
        """Take a reference."""
        self.advance()
        self.commands += 1
        self.reference_ticks = min(CLOSED_TICKS, max(0, ticks))

    def activate(self, *, on: bool) -> None:
        """Switch the motor on or off."""
        self.advance()
        self.commands += 1
        self.active = on

    def restart(self) -> None:
        """Switch off and on: the motor is off, and the fingers are where they were."""
        self.advance()
        self.active, self.extra_ma = False, 0.0
        self.reference_ticks = round(self._position_ticks)

    def advance(self) -> None:
        """Move the fingers up to now."""
        now_s = self.now_s()
        elapsed_s, self._time_s = now_s - self._time_s, now_s
        if not self.active or self.stuck:
            return
        distance = self._end_ticks() - self._position_ticks
        travelled = min(abs(distance), _FASTEST_TICKS_S * elapsed_s)
        self.travel += travelled
        self._position_ticks += travelled if distance > 0 else -travelled

    def _end_ticks(self) -> float:
        """Return where the fingers stop."""
        if self.object_share is None:
            return self.reference_ticks
        touch = self.object_share * CLOSED_TICKS
        # What is put there while the hand is closed further does not push it open.
        return min(float(self.reference_ticks), max(touch, self._position_ticks))
