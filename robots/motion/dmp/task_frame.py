"""Transforms a movement primitive: applies its `tasktrans`, and changes its frame.

The equations are invariant under a linear map of joints and a rigid transform of poses, so
the transformed primitive is a primitive again: goal, start, speed and weights are mapped.
"""

from __future__ import annotations

import msgspec
import numpy as np

from engine.messages.primitives import CartDmp, JointDmp
from robots.model.transform import RigidTransform
from robots.motion.dmp.quaternions import of_matrix, product
from robots.port import Array


def joints_in_task_frame(dmp: JointDmp) -> JointDmp:
    """Return the same motion with `tasktrans` applied and empty."""
    if not dmp.tasktrans:
        return dmp
    n = len(dmp.goal)
    matrix = np.array(dmp.tasktrans).reshape(n, n)
    return msgspec.structs.replace(
        dmp,
        goal=_row(matrix @ dmp.goal),
        y0=_row(matrix @ dmp.y0),
        dy0=_row(matrix @ dmp.dy0),
        w=tuple(_row(weights) for weights in matrix @ np.array(dmp.w)),
        tasktrans=(),
    )


def poses_in_task_frame(dmp: CartDmp) -> CartDmp:
    """Return the same motion with `tasktrans` applied and empty."""
    if not dmp.tasktrans:
        return dmp
    matrix = np.array(dmp.tasktrans).reshape(4, 4)
    transform = RigidTransform(xyz=matrix[:3, 3], xyzw=of_matrix(matrix[:3, :3]))
    return transform_dmp(msgspec.structs.replace(dmp, tasktrans=()), transform, frame=dmp.frame)


def transform_dmp(dmp: CartDmp, transform: RigidTransform, *, frame: str) -> CartDmp:
    """Return `dmp` expressed in another frame, in which its own frame is at `transform`; it has no `tasktrans`."""
    turn = transform.rotation
    weights = turn @ np.array(dmp.weights[:3]), turn @ np.array(dmp.weights[3:])
    w1, w2, w3, w4, w5, w6 = (_row(row) for half in weights for row in half)
    return msgspec.structs.replace(
        dmp,
        goal=_moved_pose(transform, dmp.goal),
        y0=_moved_pose(transform, dmp.y0),
        dy0=_row(np.concatenate((turn @ dmp.dy0[:3], turn @ dmp.dy0[3:]))),
        w1=w1, w2=w2, w3=w3, w4=w4, w5=w5, w6=w6,
        frame=frame,
    )  # fmt: skip


def _moved_pose(transform: RigidTransform, pose: tuple[float, ...]) -> tuple[float, ...]:
    xyz = transform.xyz + transform.rotation @ np.array(pose[:3])
    return _row(np.concatenate((xyz, product(transform.xyzw, np.array(pose[3:])))))


def _row(values: Array) -> tuple[float, ...]:
    return tuple(values.tolist())
