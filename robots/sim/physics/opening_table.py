"""The pad opening of a turning linkage at each motor angle, measured on the compiled model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.port import Array
from robots.sim.physics.physics import mujoco

_SAMPLES = 257


@dataclass(frozen=True, kw_only=True)
class OpeningTable:
    """Widths at evenly spaced angles from `first_rad`, with linear interpolation and extrapolation."""

    first_rad: float
    pitch_rad: float
    width_m: tuple[float, ...]

    def at(self, angle_rad: float) -> tuple[float, float]:
        """Return the width and its derivative, metres per radian."""
        place = (angle_rad - self.first_rad) / self.pitch_rad
        index = min(max(int(place), 0), len(self.width_m) - 2)
        low, high = self.width_m[index], self.width_m[index + 1]
        return low + (place - index) * (high - low), (high - low) / self.pitch_rad


def read_openings(
    model: Any, *, qpos: NDArray[np.intp], factors: Array, pads: tuple[int, int], first_rad: float, last_rad: float
) -> OpeningTable:
    """Return the table of one linkage.

    Args:
        model: The compiled model.
        qpos: Addresses of the motor's joint and its followers.
        factors: Ratio of each joint to the motor's joint, 1 for itself.
        pads: The geometries of the pads.
        first_rad: Angle at one end of the stroke.
        last_rad: Angle at the other end, where the pads touch.
    """
    data = mujoco.MjData(model)

    def pose_at(angle: float) -> None:
        data.qpos[qpos] = factors * angle
        mujoco.mj_kinematics(model, data)

    pose_at(last_rad)
    left, right = pads
    across = data.geom_xpos[right] - data.geom_xpos[left]
    across = across / np.linalg.norm(across)
    # The face of a pad is the side of its box that faces the other pad when they touch.
    inward = [_face(model, data, left, across), _face(model, data, right, -across)]
    angles = np.linspace(first_rad, last_rad, _SAMPLES)
    widths: list[float] = []
    for angle in angles.tolist():
        pose_at(angle)
        faces = [
            data.geom_xpos[pad] + data.geom_xmat[pad].reshape(3, 3) @ offset
            for pad, offset in zip(pads, inward, strict=True)
        ]
        widths.append(float((faces[1] - faces[0]) @ across))
    return OpeningTable(first_rad=first_rad, pitch_rad=float(angles[1] - angles[0]), width_m=tuple(widths))


def _face(model: Any, data: Any, pad: int, towards: Array) -> Array:
    """Return the position, in the pad's frame, of the face in direction `towards` (world)."""
    local = data.geom_xmat[pad].reshape(3, 3).T @ towards
    axis = int(np.argmax(np.abs(local)))
    offset = np.zeros(3)
    offset[axis] = np.sign(local[axis]) * model.geom_size[pad][axis]
    return offset
