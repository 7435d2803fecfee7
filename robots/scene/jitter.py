"""Random displacement of parts from a seed, independent from part to part."""

from __future__ import annotations

import math
import zlib

import numpy as np

from engine.messages import Pose


def jitter_pose(pose: Pose, *, name: str, seed: int, xy_m: float, yaw_rad: float) -> Pose:
    """Return `pose` moved by up to ±`xy_m` in x and y and turned by up to ±`yaw_rad` about world z.

    The draw depends on `seed` and the part's `name` only, so adding a part does not move the others.
    """
    stream = np.random.default_rng([seed, zlib.crc32(name.encode())])
    dx, dy, turn = (float(share) for share in stream.uniform(-1.0, 1.0, size=3))
    x, y, z = pose.xyz
    return Pose(
        xyz=(x + dx * xy_m, y + dy * xy_m, z),
        xyzw=_turned_about_z(pose.xyzw, turn * yaw_rad),
        frame=pose.frame,
    )


def _turned_about_z(xyzw: tuple[float, float, float, float], angle_rad: float) -> tuple[float, float, float, float]:
    x, y, z, w = xyzw
    s, c = math.sin(angle_rad / 2), math.cos(angle_rad / 2)
    return (c * x - s * y, c * y + s * x, c * z + s * w, c * w - s * z)
