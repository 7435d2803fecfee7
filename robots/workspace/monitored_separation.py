"""What separation monitoring permits the arms, for motions that have to wait for somebody or to keep away from them."""

from __future__ import annotations

import math

from engine.messages.separation import SeparationState

_SLOW_SHARE = 0.15
# Voxels flicker by about that; an arm that starts nearer than this beyond the distance at rest stands again at once.
_SPARE_M = 0.03
# New paths keep this much more, so that an arm gets on at more than a creep.
_WIDER_M = 0.15


class MonitoredSeparation:
    """The latest measurement of each arm, and since when it has made an arm creep or stand.

    Args:
        rest_distance_m: The protective distance of an arm at rest: nothing moves while somebody is nearer.
    """

    def __init__(self, rest_distance_m: float) -> None:
        self._rest_distance_m = rest_distance_m
        self._states: dict[str, SeparationState] = {}
        self._slow_since_s: dict[str, float] = {}

    def record(self, arm: str, state: SeparationState) -> None:
        """Take the measurement of an arm."""
        self._states[arm] = state
        if state.monitoring and state.distance_m is not None and state.permitted_share < _SLOW_SHARE:
            self._slow_since_s.setdefault(arm, state.time_s)
        else:
            self._slow_since_s.pop(arm, None)

    def begin(self, arm: str) -> None:
        """Take note that an arm begins to move: how long it creeps counts from here."""
        self._slow_since_s.pop(arm, None)

    def slow_reason(self, arm: str, *, for_s: float) -> str:
        """Return who has made an arm creep or stand for so long or longer; empty if nobody has."""
        since_s = self._slow_since_s.get(arm)
        if since_s is None or self._states[arm].time_s - since_s < for_s:
            return ""
        return self._describe(arm)

    def near_reason(self, arm: str) -> str:
        """Return who is so near that an arm may not start; empty if nobody is, or if the arm has no motion."""
        state = self._states.get(arm)
        if state is None or not state.monitoring or state.distance_m is None:
            return ""
        return self._describe(arm) if state.distance_m < self._rest_distance_m + _SPARE_M else ""

    def apart_m(self, arm: str) -> float:
        """Return the distance from all unknown bodies that a new path of an arm should keep, no more than it has."""
        state = self._states.get(arm)
        now_m = math.inf if state is None or state.distance_m is None else state.distance_m
        return max(0.0, min(self._rest_distance_m + _WIDER_M, now_m - _SPARE_M))

    def _describe(self, arm: str) -> str:
        state = self._states[arm]
        assert state.distance_m is not None
        return (
            f"an obstacle seen by the cameras is {state.distance_m:.2f} m from {state.nearest}: separation monitoring"
            f" permits hardly any motion there, and none below {self._rest_distance_m:.2f} m"
        )
