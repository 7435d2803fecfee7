"""Explains why a goal has no solution: distance out of reach, remaining error, joints at limits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from engine.errors import RobotError
from robots.model.inverse_kinematics.chain import KinematicChain
from robots.model.inverse_kinematics.pose_match import PoseMatch
from robots.model.transform import RigidTransform
from robots.port import Array

_AT_LIMIT_RAD = 1e-3
_REACHED_M = 1e-3


@dataclass(frozen=True, kw_only=True)
class DescentAttempt:
    """The end of a descent: joints (n,), and the remaining error."""

    joints: Array
    distance_m: float
    angle_rad: float


def unreachable_error(
    target: RigidTransform,
    match: PoseMatch,
    best: DescentAttempt,
    *,
    chain: KinematicChain,
    names: Sequence[str],
    starts: Sequence[Array],
    to_position: Callable[[Array], DescentAttempt],
) -> RobotError:
    """Return the error for a goal that no attempt reached.

    `best` came closest; `to_position` descends towards the position only; it is
    tried from `best` and, while it fails, from `starts`.
    """
    place = "({:.3f}, {:.3f}, {:.3f})".format(*target.xyz)
    free = best if match is PoseMatch.POSITION else to_position(best.joints)
    for start in starts:
        if free.distance_m <= _REACHED_M:
            break
        other = to_position(start)
        free = other if other.distance_m < free.distance_m else free
    if free.distance_m > _REACHED_M or match is PoseMatch.POSITION:
        return RobotError(f"{place} is out of reach by {free.distance_m:.3f} m{_at_limits(chain, names, free.joints)}")
    error = f"error {best.angle_rad:.2f} rad and {best.distance_m * 1e3:.1f} mm"
    what = "in this orientation" if match is PoseMatch.POSE else "with the tool's axis in this direction"
    needed = 6 if match is PoseMatch.POSE else 5
    hint = None
    if chain.dof < needed:
        parts = "position or axis" if match is PoseMatch.POSE and chain.dof == 5 else "position"
        hint = f"an arm of {chain.dof} joints cannot choose its orientation: request the {parts} only (`match`)"
    limits = _at_limits(chain, names, best.joints)
    return RobotError(f"{place} is reachable, but not {what}: {error}{limits}", hint=hint)


def _at_limits(chain: KinematicChain, names: Sequence[str], joints: Array) -> str:
    words = [
        f"{name} at its {'lower' if joint - lower < _AT_LIMIT_RAD else 'upper'} limit"
        f" {lower if joint - lower < _AT_LIMIT_RAD else upper:.3f}"
        for name, joint, lower, upper in zip(names, joints, chain.bounds[0], chain.bounds[1], strict=True)
        if joint - lower < _AT_LIMIT_RAD or upper - joint < _AT_LIMIT_RAD
    ]
    return f" with {' and '.join(words)}" if words else ""
