"""Temporary external pushes on bodies of a simulated world."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.skills.simulated_world import PushBody
from robots.port import Array
from robots.sim.physics.physics import Physics


@dataclass(kw_only=True)
class _Push:
    """One active push."""

    force: Array
    at: Array
    left_s: float


class ExternalPushes:
    """At most one push per body; call `step` between the halves of a physics step."""

    def __init__(self, physics: Physics) -> None:
        self._physics = physics
        self._hands: dict[int, _Push] = {}

    def push(self, request: PushBody) -> None:
        """Push from the next step on; replaces an earlier push on the same body."""
        body = self._physics.body_number(request.body)
        force, at = np.array(request.force_n), np.array(request.at_m)
        self._hands[body] = _Push(force=force, at=at, left_s=request.duration_s)

    def let_go(self) -> None:
        """End all pushes."""
        self._hands.clear()

    def step(self, step_s: float) -> None:
        """Push for one step."""
        if not self._hands:
            return
        for body, hand in list(self._hands.items()):
            self._physics.attract(body, force=hand.force, point=self._physics.point_of(body, hand.at))
            hand.left_s -= step_s
            if hand.left_s <= step_s / 2.0:
                del self._hands[body]
