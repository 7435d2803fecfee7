"""The path that an arm takes until it has come to rest, if it begins to brake after its reaction time."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robots.port import Array, JointTrajectory

REACTION_S = 0.12
"""Greatest age of the result of a check when it takes effect: the period of checks, the check, and the command."""

BRAKING_SHARE = 0.4
"""Share of the acceleration limits with which a stream decelerates: 0.5, less for its jerk."""

_STEP_S, _LONGEST_S = 0.01, 3.0


def stopping_path(
    joints: Array, velocity: Array, *, requested: Callable[[Array], Array], braking_rad_s2: Array
) -> JointTrajectory:
    """Return the path from `joints` with `velocity` (n,): towards what is `requested` there, then to rest.

    Changes of the velocity keep its direction and take the joint that needs the longest.
    """
    rows = [joints]
    reaction = round(REACTION_S / _STEP_S)
    for k in range(round(_LONGEST_S / _STEP_S)):
        change = (requested(joints) if k < reaction else 0.0) - velocity
        velocity = velocity + change * _share(change, braking_rad_s2)
        joints = joints + velocity * _STEP_S
        rows.append(joints)
        if k >= reaction and not velocity.any():
            break
    path = np.array(rows)
    return JointTrajectory(dt_s=_STEP_S, position_rad=path, velocity_rad_s=path * 0.0)


def _share(change: Array, braking_rad_s2: Array) -> float:
    """Return the share of a change of velocity that a step allows."""
    return min(1.0, float((braking_rad_s2 * _STEP_S / np.maximum(np.abs(change), 1e-12)).min()))
