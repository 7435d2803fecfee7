"""Movement primitives: joint and Cartesian DMPs, their learned offsets, a force reference (RCL tables 6 to 8).

All of them are sums of Gaussian kernels over the phase x, which decays from 1 at the start as
exp(-a_x t / tau): psi_i(x) = exp(-(x - c_i)² / (2 sigma_i)). So `sigma` holds variances, as in the
library of the Jožef Stefan Institute that defines the tables; its data needs no conversion.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Annotated

import msgspec

from engine.messages.geometry import Message, Pose, Quaternion

Gain = Annotated[float, msgspec.Meta(gt=0)]
Seconds = Annotated[float, msgspec.Meta(gt=0)]
Row = tuple[float, ...]
Variances = tuple[Annotated[float, msgspec.Meta(gt=0)], ...]

_UNIT_TOLERANCE = 1e-3
_IDENTITY_4 = 16


class JointDmp(Message, frozen=True, kw_only=True):
    """A dynamic movement primitive in joint space (RCL table 6) for n joints and `N` kernels.

    `goal`, `y0` (rad) and `dy0` (rad/s) have n values; `c` and `sigma`, the centres and variances of
    the kernels over the phase, have `N`; `w` has one row of `N` weights for each joint, the table's w1
    to wn. `tau` is the duration in seconds, `a_z` and `a_x` the dimensionless gains of transformation
    and phase. `tasktrans` is a linear map of the joints, n x n row by row, applied to the output of the
    primitive; empty for none. `id` is free for the user.
    """

    N: Annotated[int, msgspec.Meta(ge=1)]
    a_z: Gain
    a_x: Gain
    tau: Seconds
    id: int = 0
    goal: Annotated[Row, msgspec.Meta(min_length=1)]
    y0: Row
    dy0: Row
    c: Row
    sigma: Variances
    w: tuple[Row, ...]
    tasktrans: Row = ()

    @property
    def start(self) -> Row:
        """The joints at the start: `y0`, mapped by `tasktrans`."""
        if not self.tasktrans:
            return self.y0
        n = len(self.y0)
        rows = [self.tasktrans[joint * n : (joint + 1) * n] for joint in range(n)]
        return tuple(sum(a * b for a, b in zip(row, self.y0, strict=True)) for row in rows)

    def __post_init__(self) -> None:
        joints = len(self.goal)
        where = f"({joints} joints, N = {self.N})"
        _check_lengths(
            (
                ("y0", self.y0, joints),
                ("dy0", self.dy0, joints),
                ("w", self.w, joints),
                ("c", self.c, self.N),
                ("sigma", self.sigma, self.N),
                *((f"w[{joint}]", weights, self.N) for joint, weights in enumerate(self.w)),
                *((("tasktrans", self.tasktrans, joints * joints),) if self.tasktrans else ()),
            ),
            where,
        )
        rows = (
            ("goal", self.goal), ("y0", self.y0), ("dy0", self.dy0), ("c", self.c), ("sigma", self.sigma),
            ("tasktrans", self.tasktrans),
        )  # fmt: skip
        _check_finite((*rows, *((f"w[{joint}]", weights) for joint, weights in enumerate(self.w))))
        _check_gains(self)


class CartDmp(Message, frozen=True, kw_only=True):
    """A dynamic movement primitive of the tool centre point (RCL table 7), with a quaternion DMP for its orientation.

    `goal` and `y0` are x y z in metres and a unit quaternion x y z w, `dy0` the velocity (m/s) and the
    angular velocity (rad/s) at the start. `w1` to `w3` are the weights of the motion along x, y and z,
    `w4` to `w6` those of the rotation about x, y and z; the other fields are as in `JointDmp`. All values
    are along the axes of `frame`: `world`, or a frame of the arm. `tasktrans` is a rigid transform
    of the whole motion in that frame, 4 x 4 row by row; empty for none. The signs of the quaternions
    matter: the rotation takes the direction in which the quaternion reaches `goal` without a change of sign.
    """

    N: Annotated[int, msgspec.Meta(ge=1)]
    a_z: Gain
    a_x: Gain
    tau: Seconds
    id: int = 0
    goal: Row
    y0: Row
    dy0: Row = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    c: Row
    sigma: Variances
    w1: Row
    w2: Row
    w3: Row
    w4: Row
    w5: Row
    w6: Row
    tasktrans: Row = ()
    frame: str = "world"

    @property
    def weights(self) -> tuple[Row, ...]:
        """The six rows `w1` to `w6`."""
        return (self.w1, self.w2, self.w3, self.w4, self.w5, self.w6)

    @property
    def start(self) -> Pose:
        """The pose of the tool at the start: `y0`, moved by `tasktrans`."""
        x, y, z, qx, qy, qz, qw = self.y0
        if not self.tasktrans:
            return Pose(xyz=(x, y, z), xyzw=(qx, qy, qz, qw), frame=self.frame)
        rows = [self.tasktrans[4 * row : 4 * row + 4] for row in range(3)]
        px, py, pz = (a * x + b * y + c * z + shift for a, b, c, shift in rows)
        return Pose(xyz=(px, py, pz), xyzw=_turned(self.tasktrans, (qx, qy, qz, qw)), frame=self.frame)

    def __post_init__(self) -> None:
        rows = (("c", self.c), ("sigma", self.sigma), *_numbered("w{}", self.weights))
        _check_lengths(((name, row, self.N) for name, row in rows), f"(N = {self.N})")
        fixed = (("goal", self.goal, 7), ("y0", self.y0, 7), ("dy0", self.dy0, 6))
        _check_lengths(fixed, "(x y z and a quaternion x y z w; for dy0 m/s and rad/s)")
        _check_finite((*rows, *((name, row) for name, row, _ in fixed), ("tasktrans", self.tasktrans)))
        _check_gains(self)
        for name, pose in (("goal", self.goal), ("y0", self.y0)):
            if abs(math.hypot(*pose[3:]) - 1.0) > _UNIT_TOLERANCE:
                raise ValueError(f"the quaternion of {name} has length {math.hypot(*pose[3:]):.4g} instead of 1")
        if self.tasktrans:
            _check_rigid(self.tasktrans)


class CartOffsets(Message, frozen=True, kw_only=True):
    """The offsets that a force-controlled motion adds to a Cartesian DMP over its phase (RCL table 8).

    Metres along (`w1o` to `w3o`) and a rotation vector in radians about (`w4o` to `w6o`) the axes of
    the task frame; the value at phase x is the kernel-weighted mean of the weights.
    """

    c_o: Annotated[Row, msgspec.Meta(min_length=1)]
    sigma_o: Variances
    w1o: Row
    w2o: Row
    w3o: Row
    w4o: Row
    w5o: Row
    w6o: Row

    @property
    def weights(self) -> tuple[Row, ...]:
        """The six rows `w1o` to `w6o`."""
        return (self.w1o, self.w2o, self.w3o, self.w4o, self.w5o, self.w6o)

    def __post_init__(self) -> None:
        kernels = len(self.c_o)
        rows = (("c_o", self.c_o), ("sigma_o", self.sigma_o), *_numbered("w{}o", self.weights))
        _check_lengths(((name, row, kernels) for name, row in rows), f"({kernels} kernels in c_o)")
        _check_finite(rows)


class ForceReference(Message, frozen=True, kw_only=True):
    """The desired force (N, `w1f` to `w3f`) and torque (Nm, `w4f` to `w6f`) over the phase (RCL table 8).

    They are those of the environment on the tool, along and about the axes of the task frame:
    a tool that presses down on a table with 10 N has +10 along the upward z axis.
    """

    N_f: Annotated[int, msgspec.Meta(ge=1)]
    c_f: Row
    sigma_f: Variances
    w1f: Row
    w2f: Row
    w3f: Row
    w4f: Row
    w5f: Row
    w6f: Row

    @classmethod
    def constant(cls, *, force_n: Sequence[float], torque_nm: Sequence[float] = (0.0, 0.0, 0.0)) -> ForceReference:
        """Return the reference of a constant force and torque."""
        one = [(value,) for value in (*force_n, *torque_nm)]
        return cls(
            N_f=1, c_f=(0.5,), sigma_f=(1.0,),
            w1f=one[0], w2f=one[1], w3f=one[2], w4f=one[3], w5f=one[4], w6f=one[5],
        )  # fmt: skip

    @property
    def weights(self) -> tuple[Row, ...]:
        """The six rows `w1f` to `w6f`."""
        return (self.w1f, self.w2f, self.w3f, self.w4f, self.w5f, self.w6f)

    def __post_init__(self) -> None:
        rows = (("c_f", self.c_f), ("sigma_f", self.sigma_f), *_numbered("w{}f", self.weights))
        _check_lengths(((name, row, self.N_f) for name, row in rows), f"(N_f = {self.N_f})")
        _check_finite(rows)


def _check_gains(dmp: JointDmp | CartDmp) -> None:
    for name, value in (("a_z", dmp.a_z), ("a_x", dmp.a_x), ("tau", dmp.tau)):
        if not math.isfinite(value):
            raise ValueError(f"{name} is {value}")


def _numbered(pattern: str, rows: Sequence[Row]) -> tuple[tuple[str, Row], ...]:
    return tuple((pattern.format(number), row) for number, row in enumerate(rows, 1))


def _check_lengths(rows: Iterable[tuple[str, Sequence[object], int]], where: str) -> None:
    for name, row, length in rows:
        if len(row) != length:
            raise ValueError(f"{name} has {len(row)} values, not {length} {where}")


def _check_finite(rows: Iterable[tuple[str, Row]]) -> None:
    for name, row in rows:
        for index, value in enumerate(row):
            if not math.isfinite(value):
                raise ValueError(f"{name}[{index}] is {value}")


def _turned(matrix: Row, xyzw: Quaternion) -> Quaternion:
    """Return the orientation `xyzw` rotated by the rotation of a 4 x 4 transform."""
    a, b, c, _, d, e, f, _, g, h, i = matrix[:11]
    # Of the four formulas for the quaternion of a rotation, use the one with the greatest divisor.
    candidates = (
        (1.0 + a - e - i, b + d, g + c, h - f),
        (b + d, 1.0 - a + e - i, f + h, c - g),
        (g + c, f + h, 1.0 - a - e + i, d - b),
        (h - f, c - g, d - b, 1.0 + a + e + i),
    )
    lx, ly, lz, lw = max(candidates, key=lambda candidate: math.hypot(*candidate))
    x, y, z, w = xyzw
    turned = (
        lw * x + lx * w + ly * z - lz * y,
        lw * y - lx * z + ly * w + lz * x,
        lw * z + lx * y - ly * x + lz * w,
        lw * w - lx * x - ly * y - lz * z,
    )
    length = math.hypot(*turned)
    return (turned[0] / length, turned[1] / length, turned[2] / length, turned[3] / length)


def _check_rigid(matrix: Row) -> None:
    if len(matrix) != _IDENTITY_4:
        raise ValueError(f"tasktrans has {len(matrix)} values, not 16 (4 x 4, row by row)")
    rotation = (matrix[0:3], matrix[4:7], matrix[8:11])
    for first in range(3):
        for second in range(3):
            product = sum(a * b for a, b in zip(rotation[first], rotation[second], strict=True))
            if abs(product - (first == second)) > _UNIT_TOLERANCE:
                raise ValueError("the first three rows and columns of tasktrans are not a rotation matrix")
    (a, b, c), (d, e, f), (g, h, i) = rotation
    if a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0.0:
        raise ValueError("tasktrans is a reflection: the determinant of its rotation is -1")
    if any(abs(value - unit) > _UNIT_TOLERANCE for value, unit in zip(matrix[12:], (0, 0, 0, 1), strict=True)):
        raise ValueError("the last row of tasktrans is not 0 0 0 1")
