"""A tendon motor without physics: it winds at its speed and stops at what the side channel puts into the hand."""

from __future__ import annotations

from collections.abc import Callable

from robots.drivers.emulation.plant import ToolMeasurement

_FASTEST_SHARE_S = 1.6
_FORCE_SHARE = 6.3
"""Force for each share of the travel by which the motor is kept from its target."""
_THERE_SHARE = 1e-9


class KinematicTendon:
    """Implements `ToolPlant`; `now_s` is its clock, positions are closed shares.

    Attributes:
        object_share: Closed share at which an object blocks the fingers, None for nothing.
        stuck: Whether the motor does not turn, and draws no more for it.
        travel: Shares that the motor has passed.
    """

    def __init__(self, now_s: Callable[[], float]) -> None:
        self._now_s = now_s
        self.object_share: float | None = None
        self.stuck = False
        self.travel = 0.0
        self._share = self._goal = 0.0
        self._time_s = now_s()

    def close_to(self, closed_share: float, *, speed_share: float = 1.0, force_share: float = 1.0) -> None:
        """Move from now on, as fast as it can."""
        self._advance()
        self._goal = closed_share

    def stop(self) -> None:
        """Stop now."""
        self._advance()
        self._goal = self._share

    def home(self) -> None:
        """Open."""
        self.close_to(0.0)

    def measured(self) -> ToolMeasurement:
        """Return where the motor is now, and how much it presses."""
        self._advance()
        end = self._end()
        there = self._share == end
        blocked = there and abs(self._goal - end) > _THERE_SHARE
        pressed = _FORCE_SHARE * max(0.0, self._goal - self._share) if blocked else 0.0
        moving = not there and not self.stuck
        return ToolMeasurement(closed_share=self._share, moving=moving, blocked=blocked, force_share=pressed)

    def _advance(self) -> None:
        now_s = self._now_s()
        elapsed_s, self._time_s = now_s - self._time_s, now_s
        distance = self._end() - self._share
        travelled = min(abs(distance), _FASTEST_SHARE_S * elapsed_s)
        if self.stuck or not travelled:
            return
        self.travel += travelled
        if travelled == abs(distance):
            self._share = self._end()
        else:
            self._share += travelled if distance > 0 else -travelled

    def _end(self) -> float:
        """Return where the motor stops."""
        if self.object_share is None:
            return self._goal
        # What is put there while the hand is closed further does not push it open.
        return min(self._goal, max(self.object_share, self._share))
