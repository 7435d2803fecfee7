"""Speed and separation monitoring on the bus: what it measures and permits."""

from __future__ import annotations

from engine.messages import Message, Vector3


class SeparationState(Message, frozen=True, kw_only=True):
    """What speed and separation monitoring permits an arm, the latest value of `<arm>/separation`.

    `distance_m` is the smallest distance of the arm's body `nearest` (`left/panda_hand`, or a held part) from a
    measured unknown body, whose nearest point is `at_m` (world); None where nothing is measured. `protective_m` is
    the distance that the full speed of the present motion requires, `permitted_speed_m_s` the speed that its fastest
    point may have, `permitted_share` that of its full speed. `reason` says why nothing is permitted although nobody is
    near: no valid measurement. While the arm has no motion nothing is measured and `monitoring` is false.
    """

    time_s: float
    monitoring: bool
    distance_m: float | None = None
    nearest: str = ""
    at_m: Vector3 | None = None
    protective_m: float = 0.0
    permitted_speed_m_s: float | None = None
    permitted_share: float = 1.0
    reason: str = ""
