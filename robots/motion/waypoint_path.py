"""Computes the configurations of a list of waypoints, each nearest to the previous one, or the reason why not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.errors import RobotError
from robots.model.inverse_kinematics import InverseKinematicsSolver, PoseMatch
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion.joint_profile import within_limits
from robots.port import Array

_LOOKS = 9
# The tool may swing around the base between two poses; beyond this the arm changes its configuration.
_DETOUR_SHARE, _DETOUR_M, _DETOUR_RAD = 2.0, 0.3, np.pi / 2


def waypoint_joints(
    kinematics: ArmKinematics, start: Array, waypoints: Sequence[Array | RigidTransform], *, match: PoseMatch
) -> Array:
    """Return the configurations from `start` through all waypoints, (waypoints + 1, n), radians.

    A waypoint is a configuration (n,) or a pose of the tool in the world, of which `match` counts.

    Raises:
        RobotError: a waypoint is out of reach, or its pose needs another configuration of the arm than the previous
            waypoint; the message has its index.
    """
    inverse, model = InverseKinematicsSolver(kinematics), kinematics.model
    rows = [start]
    for index, waypoint in enumerate(waypoints):
        try:
            if isinstance(waypoint, RigidTransform):
                joints = inverse.nearest(waypoint, seed=rows[-1], match=match)
                _require_same_configuration(kinematics, rows[-1], joints, match)
            else:
                joints = within_limits(waypoint, model.limits, model.arm_joints)
        except RobotError as error:
            hint = error.hint or "choose a waypoint that the arm reaches within its limits"
            raise RobotError(f"waypoints[{index}]: {error.message}", hint=hint) from error
        rows.append(joints)
    return np.array(rows)


def _require_same_configuration(kinematics: ArmKinematics, before: Array, after: Array, match: PoseMatch) -> None:
    """Raise RobotError if the tool makes a detour on the straight joint line to a pose.

    The nearest configuration of a pose is far from the previous one where the arm would have to turn over its wrist,
    its elbow or a whole turn of a joint. Its tool then leaves the space between the two poses.
    """
    looks = [kinematics.tool_pose(before + share * (after - before)) for share in np.linspace(0.0, 1.0, _LOOKS)]
    first, last = looks[0], looks[-1]
    allowed_m = _DETOUR_SHARE * first.distance_m(last) + _DETOUR_M
    allowed_rad = first.angle_rad(last) + _DETOUR_RAD
    path_m = max(first.distance_m(look) + look.distance_m(last) for look in looks)
    path_rad = max(first.angle_rad(look) + look.angle_rad(last) for look in looks)
    is_turned = match is PoseMatch.POSE and path_rad > allowed_rad
    if path_m <= allowed_m and not is_turned:
        return
    joint = int(np.argmax(np.abs(after - before)))
    detour = (
        f"the tool would turn by {path_rad:.1f} rad between poses that differ by {first.angle_rad(last):.1f} rad"
        if is_turned
        else f"the tool would move by {path_m:.2f} m between poses that are {first.distance_m(last):.2f} m apart"
    )
    turn = abs(float(after[joint] - before[joint]))
    raise RobotError(
        f"the pose needs another configuration of the arm: {kinematics.model.arm_joints[joint]} would turn by"
        f" {turn:.2f} rad and {detour}",
        hint="add a waypoint between, or give the joints",
    )
