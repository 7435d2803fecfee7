"""Movement primitives as the library movement-primitives (0.9) learns them and rolls them out."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from robots.port import Array

Learned = Callable[[], Array]
"""Rolls out: joints (T, n), or poses (T, 7) with the quaternion x y z w last."""


def installed() -> bool:
    """Return whether the library and pytransform3d, which it needs, are there."""
    return find_spec("movement_primitives") is not None and find_spec("pytransform3d") is not None


def learn_joints(times: Array, joints: Array, *, kernels: int) -> Learned:
    """Learn a joint DMP from samples at even times."""
    library: Any = import_module("movement_primitives.dmp")
    dmp = library.DMP(
        n_dims=joints.shape[1],
        execution_time=float(times[-1]),
        dt=float(times[1]),
        n_weights_per_dim=kernels,
    )
    dmp.imitate(times, joints)
    return lambda: np.asarray(dmp.open_loop()[1], dtype=np.float64)


def learn_poses(times: Array, poses: Array, *, kernels: int) -> Learned:
    """Learn a Cartesian DMP from samples at even times."""
    library: Any = import_module("movement_primitives.dmp")
    dmp = library.CartesianDMP(execution_time=float(times[-1]), dt=float(times[1]), n_weights_per_dim=kernels)
    dmp.imitate(times, poses[:, [0, 1, 2, 6, 3, 4, 5]])
    return lambda: np.asarray(dmp.open_loop()[1], dtype=np.float64)[:, [0, 1, 2, 4, 5, 6, 3]]
