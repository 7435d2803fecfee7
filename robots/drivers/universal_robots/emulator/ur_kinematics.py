"""Forward and inverse kinematics of the arms of Universal Robots, in the base frame of their controller."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from robots.drivers.universal_robots.emulator.pose_vectors import inverse_of
from robots.drivers.universal_robots.emulator.ur_models import JOINT_RANGE_RAD, ArmGeometry
from robots.port.arrays import Array

_TWISTS = ((0.0, 1.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 0.0))
"""Cosine and sine of the angle between the axes of one joint and the next."""
_SINGULAR = 1e-6
_POSE_ERROR = 1e-6


class UrKinematics:
    """The chain of one arm; `Array`s of six joint angles in rad, homogeneous matrices in m."""

    def __init__(self, geometry: ArmGeometry) -> None:
        self._g = geometry
        self._d = (geometry.d1_m, 0.0, 0.0, geometry.d4_m, geometry.d5_m, geometry.d6_m)
        self._a = (0.0, geometry.a2_m, geometry.a3_m, 0.0, 0.0, 0.0)

    def flange(self, q: Sequence[float] | Array) -> Array:
        """Return the flange in the base."""
        return self.frames(q)[-1]

    def frames(self, q: Sequence[float] | Array) -> list[Array]:
        """Return the base and the frame behind each joint."""
        frames = [np.eye(4)]
        for joint in range(6):
            frames.append(frames[-1] @ self._link(joint, float(q[joint])))
        return frames

    def jacobian(self, q: Sequence[float] | Array, tool: Array) -> Array:
        """Return the derivative of the tool's position and orientation in the base by the joints."""
        frames = self.frames(q)
        tip = (frames[-1] @ tool)[:3, 3]
        columns: list[tuple[float, ...]] = []
        for frame in frames[:6]:
            x, y, z = frame[:3, 2].tolist()
            dx, dy, dz = (tip - frame[:3, 3]).tolist()
            columns.append((y * dz - z * dy, z * dx - x * dz, x * dy - y * dx, x, y, z))
        return np.array(columns).T

    def inverse(self, flange: Array, near: Sequence[float] | Array) -> Array | None:
        """Return the configuration nearest to `near` that reaches the flange pose, or None."""
        solutions = [
            np.array([_nearest_turn(angle, float(near[joint])) for joint, angle in enumerate(solution)])
            for solution in self._solutions(flange, near)
        ]
        for q in sorted(solutions, key=lambda q: float(np.abs(q - near).sum())):
            if float(np.abs(self.flange(q) - flange).max()) < _POSE_ERROR:
                return q
        return None

    def _link(self, joint: int, angle: float) -> Array:
        c, s = math.cos(angle), math.sin(angle)
        ca, sa = _TWISTS[joint]
        a = self._a[joint]
        return np.array(
            [
                [c, -s * ca, s * sa, a * c],
                [s, c * ca, -c * sa, a * s],
                [0.0, sa, ca, self._d[joint]],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )

    def _solutions(self, flange: Array, near: Sequence[float] | Array) -> Iterator[list[float]]:
        """Yield up to eight configurations: shoulder left and right, wrist up and down, elbow up and down."""
        g = self._g
        wrist = flange @ np.array([0.0, 0.0, -g.d6_m, 1.0])
        radius = math.hypot(wrist[0], wrist[1])
        if radius < abs(g.d4_m):
            return
        reach = math.acos(g.d4_m / radius)
        heading = math.atan2(wrist[1], wrist[0]) + math.pi / 2
        for q1 in (heading + reach, heading - reach):
            s1, c1 = math.sin(q1), math.cos(q1)
            cosine5 = (flange[0, 3] * s1 - flange[1, 3] * c1 - g.d4_m) / g.d6_m
            if abs(cosine5) > 1.0 + 1e-7:
                continue
            bend = math.acos(min(1.0, max(-1.0, cosine5)))
            for q5 in (bend, -bend):
                s5 = math.sin(q5)
                if abs(s5) < _SINGULAR:
                    q6 = float(near[5])
                else:
                    q6 = math.atan2(
                        (-flange[0, 1] * s1 + flange[1, 1] * c1) / s5, (flange[0, 0] * s1 - flange[1, 0] * c1) / s5
                    )
                yield from self._elbows(flange, q1, q5, q6)

    def _elbows(self, flange: Array, q1: float, q5: float, q6: float) -> Iterator[list[float]]:
        g = self._g
        forearm = inverse_of(self._link(0, q1)) @ flange @ inverse_of(self._link(5, q6)) @ inverse_of(self._link(4, q5))
        point = forearm @ np.array([0.0, -g.d4_m, 0.0, 1.0])
        length = math.hypot(point[0], point[1])
        cosine3 = (length * length - g.a2_m**2 - g.a3_m**2) / (2.0 * g.a2_m * g.a3_m)
        if abs(cosine3) > 1.0 + 1e-7:
            return
        bend = math.acos(min(1.0, max(-1.0, cosine3)))
        turn = math.atan2(forearm[1, 0], forearm[0, 0])
        for q3 in (bend, -bend):
            q2 = math.atan2(-point[1], -point[0]) - math.atan2(-g.a3_m * math.sin(q3), -g.a2_m - g.a3_m * math.cos(q3))
            yield [q1, q2, q3, turn - q2 - q3, q5, q6]


def _nearest_turn(angle: float, near: float) -> float:
    """Return the angle of the same direction that is nearest to another, within the range of a joint."""
    nearest = angle + 2.0 * math.pi * round((near - angle) / (2.0 * math.pi))
    if nearest > JOINT_RANGE_RAD:
        return nearest - 2.0 * math.pi
    return nearest + 2.0 * math.pi if nearest < -JOINT_RANGE_RAD else nearest
