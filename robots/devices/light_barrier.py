"""The beam of a light barrier in simulation, and whether a part is in it."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from engine.document import LightBarrier
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import PartBody

# Points of the beam at which is looked are so far apart: thinner parts can be overlooked.
_PITCH_M = 0.001


def is_interrupted(beam: LightBarrier, body: RigidTransform, parts: Iterable[tuple[PartBody, RigidTransform]]) -> bool:
    """Return whether one of the parts, with their poses in the world, is in a beam of a body at its pose."""
    start, end = np.array(beam.start_m), np.array(beam.end_m)
    count = max(2, int(np.linalg.norm(end - start) / _PITCH_M) + 1)
    points = body.xyz + (start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)) @ body.rotation.T
    return any(_holds_any(part, (points - pose.xyz) @ pose.rotation) for part, pose in parts)


def _holds_any(part: PartBody, points: Array) -> bool:
    """Return whether any of the points (n, 3), in the frame of the part, is in it."""
    match part.shape:
        case "sphere":
            return bool((np.linalg.norm(points, axis=1) <= part.size_m[0] / 2).any())
        case "cylinder":
            across = np.hypot(points[:, 0], points[:, 1]) <= part.size_m[0] / 2
            return bool((across & (np.abs(points[:, 2]) <= part.size_m[1] / 2)).any())
        case _:
            return bool((np.abs(points) <= np.array(part.size_m) / 2).all(axis=1).any())
