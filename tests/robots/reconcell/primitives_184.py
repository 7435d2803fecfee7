"""Movement primitives with as many kernels as a packet carries, learned from a smooth motion with a detour."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, JointDmp
from robots.motion.dmp import learn_cart_dmp, learn_joint_dmp
from robots.reconcell.packets import KERNELS

HOME = (0.0, -1.4, 1.6, -1.8, -1.5708, 0.0)
THERE = (0.3, -1.2, 1.5, -1.7, -1.4, 0.2)
"""Joints of a UR10."""
TAU_S = 3.0


def _shares() -> tuple[list[float], list[float], list[float]]:
    times = np.linspace(0.0, TAU_S, 301)
    u = times / TAU_S
    return times.tolist(), (10 * u**3 - 15 * u**4 + 6 * u**5).tolist(), (16 * u**2 * (1 - u) ** 2).tolist()


def joint_dmp(detour_rad: float = 0.2) -> JointDmp:
    """Return a primitive from `HOME` to `THERE`; the first joint makes the detour."""
    times, shares, detours = _shares()
    rows = [
        tuple(a + share * (b - a) + (detour_rad * detour if joint == 0 else 0.0)
              for joint, (a, b) in enumerate(zip(HOME, THERE, strict=True)))
        for share, detour in zip(shares, detours, strict=True)
    ]  # fmt: skip
    learned = learn_joint_dmp(Trajectory(times_s=tuple(times), joints=tuple(rows)), kernels=KERNELS, trim=False)
    return learned.dmp


def cart_dmp(start: Pose, shift_m: tuple[float, float, float], detour_m: float = 0.03) -> CartDmp:
    """Return a primitive that moves the tool by `shift_m` and turns it a little; the detour is along x."""
    times, shares, detours = _shares()
    rows: list[tuple[float, ...]] = []
    for share, detour in zip(shares, detours, strict=True):
        x, y, z = (a + share * b for a, b in zip(start.xyz, shift_m, strict=True))
        half = 0.05 * share
        qx, qy, qz, qw = start.xyzw
        s, c = math.sin(half), math.cos(half)
        turned = (c * qx - s * qy, c * qy + s * qx, c * qz + s * qw, c * qw - s * qz)
        rows.append((x + detour_m * detour, y, z, *turned))
    learned = learn_cart_dmp(Trajectory(times_s=tuple(times), poses=tuple(rows)), kernels=KERNELS, trim=False)
    return msgspec.structs.replace(learned.dmp, id=0)
