"""Fingers without physics: they move at their speed and stop at what the side channel puts there."""

from __future__ import annotations

from collections.abc import Callable

from robots.drivers.emulation.plant import ToolMeasurement
from robots.drivers.robotiq.gripper_units import MAX_SPEED_M_S, WidthTable, count_of_width, width_of_count

WIDTHS: WidthTable = ((3, 0.085), (230, 0.0))
OPEN, CLOSED = WIDTHS[0][0], WIDTHS[-1][0]
_COUNTS_M = (CLOSED - OPEN) / WIDTHS[0][1]


class KinematicFingers:
    """Implements `ToolPlant`; `now_s` is its clock, positions are counts.

    Attributes:
        object_m: Width of what is between the fingers, None for nothing.
        ring_m: Inner width of what is around the fingers, None for nothing.
        travel: Counts that the fingers have passed.
        rested_s: When the fingers last came to rest.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self.object_m: float | None = None
        self.ring_m: float | None = None
        self.travel = 0.0
        self.rested_s = 0.0
        self._position = float(CLOSED // 2)
        self._goal = self._position
        self._speed_m_s = 0.0
        self._moving = self._blocked = False
        self._time_s = now_s()

    def close_to(self, closed_share: float, *, speed_share: float = 1.0, force_share: float = 1.0) -> None:
        """Move from now on."""
        self._advance()
        self._goal = OPEN + closed_share * (CLOSED - OPEN)
        self._speed_m_s = speed_share * MAX_SPEED_M_S
        self._moving, self._blocked = True, False

    def stop(self) -> None:
        """Stop now."""
        self._advance()
        self._moving = False

    def home(self) -> None:
        """Have closed and opened once."""
        self.travel += CLOSED - OPEN
        self._position, self._moving, self._blocked = float(OPEN), False, False

    def measured(self) -> ToolMeasurement:
        """Return where the fingers are now."""
        self._advance()
        share = (self._position - OPEN) / (CLOSED - OPEN)
        return ToolMeasurement(closed_share=share, moving=self._moving, blocked=self._blocked)

    def _advance(self) -> None:
        now_s = self._now_s()
        elapsed_s, self._time_s = now_s - self._time_s, now_s
        if not self._moving:
            return
        end, blocked = self._end()
        distance = end - self._position
        travelled = min(abs(distance), self._speed_m_s * _COUNTS_M * elapsed_s)
        self.travel += travelled
        self._position += travelled if distance > 0 else -travelled
        if travelled == abs(distance):
            self._moving, self._blocked, self.rested_s = False, blocked, now_s

    def _end(self) -> tuple[float, bool]:
        """Return where the fingers stop, and whether something stops them."""
        goal = self._goal
        if goal >= self._position and self.object_m is not None:
            touch = count_of_width(self.object_m, WIDTHS)
            if self._position <= touch < goal:
                return float(touch), True
        if goal <= self._position and self.ring_m is not None:
            touch = count_of_width(self.ring_m, WIDTHS)
            if goal < touch <= self._position:
                return float(touch), True
        return goal, False


def count_of_share(closed_share: float) -> int:
    """Return the measured position in counts."""
    return round(OPEN + min(1.0, max(0.0, closed_share)) * (CLOSED - OPEN))


def width_of_share(closed_share: float) -> float:
    """Return the opening at the measured position."""
    return width_of_count(count_of_share(closed_share), WIDTHS)
