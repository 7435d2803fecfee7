"""End effector frame and load as libfranka takes them: matrices by columns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from robots.drivers.franka.franka_options import FrankaOptions
from robots.port import Array

# A robot refuses loads without inertia; this is that of a ball of this radius.
_BALL_M = 0.05
IDENTITY = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True, kw_only=True)
class FrankaLoad:
    """Mass, centre of mass at the flange, and inertia about it by columns."""

    mass_kg: float
    com_m: tuple[float, float, float]
    inertia_kg_m2: tuple[float, ...]


def end_effector_frame(flange_to_nominal: Sequence[float], *, tcp_xyz_m: Array, options: FrankaOptions) -> list[float]:
    """Return the end effector frame in the nominal one, which the web interface sets.

    `flange_to_nominal` is `F_T_NE` of a robot state. The option `tcp` counts more than `tcp_xyz_m`, at the flange.
    """
    nominal = np.array(flange_to_nominal).reshape((4, 4), order="F")
    target = nominal.copy()
    if options.tcp is None:
        target[:3, 3] = tcp_xyz_m
    else:
        target[:3, 3] = options.tcp[:3]
        target[:3, :3] = Rotation.from_rotvec(options.tcp[3:]).as_matrix()
    frame = np.eye(4)
    turned = nominal[:3, :3].T
    frame[:3, :3] = turned @ target[:3, :3]
    frame[:3, 3] = turned @ (target[:3, 3] - nominal[:3, 3])
    return frame.flatten(order="F").tolist()


def total_load(load_kg: float, load_com_m: Array, options: FrankaOptions) -> FrankaLoad:
    """Return the payload of the options and a load together."""
    mass_kg = options.payload_kg + load_kg
    if mass_kg <= 0.0:
        return FrankaLoad(mass_kg=0.0, com_m=(0.0, 0.0, 0.0), inertia_kg_m2=(0.0,) * 9)
    payload_m = np.array(options.payload_com_m or (0.0, 0.0, 0.0))
    x, y, z = ((options.payload_kg * payload_m + load_kg * load_com_m) / mass_kg).tolist()
    ball = 0.4 * mass_kg * _BALL_M**2
    return FrankaLoad(mass_kg=mass_kg, com_m=(x, y, z), inertia_kg_m2=(ball, 0.0, 0.0, 0.0, ball, 0.0, 0.0, 0.0, ball))
