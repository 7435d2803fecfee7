"""A recorded motion: joints, tool poses and wrenches over time, taught by hand or logged from a run."""

from __future__ import annotations

import math
from typing import Annotated

import msgspec

from engine.messages.geometry import Message

Sample = tuple[float, ...]

_UNIT_TOLERANCE = 1e-3


class Trajectory(Message, frozen=True, kw_only=True):
    """A motion recorded at strictly increasing `times_s`; each other list has one row per time, or is empty.

    `joints` are radians in the order of `names` or of the robot; `poses` are x y z (m) and a unit
    quaternion x y z w of the tool centre point in `frame`; `wrenches` are force (N) and torque (Nm) of
    the environment on the tool along the axes of `wrench_frame`.
    """

    times_s: Annotated[tuple[float, ...], msgspec.Meta(min_length=2)]
    joints: tuple[Sample, ...] = ()
    names: tuple[str, ...] = ()
    poses: tuple[Sample, ...] = ()
    frame: str = "world"
    wrenches: tuple[Sample, ...] = ()
    wrench_frame: str = "world"

    def __post_init__(self) -> None:
        self._check_times()
        if not self.joints and not self.poses:
            raise ValueError("give `joints`, `poses` or both")
        width = len(self.names) or (len(self.joints[0]) if self.joints else 0)
        for name, rows, length in (
            ("joints", self.joints, width),
            ("poses", self.poses, 7),
            ("wrenches", self.wrenches, 6),
        ):
            self._check_rows(name, rows, length)
        for index, pose in enumerate(self.poses):
            if abs(math.hypot(*pose[3:]) - 1.0) > _UNIT_TOLERANCE:
                raise ValueError(
                    f"the quaternion of poses[{index}] has length {math.hypot(*pose[3:]):.4g} instead of 1"
                )

    def _check_times(self) -> None:
        for index in range(1, len(self.times_s)):
            if not self.times_s[index] > self.times_s[index - 1]:
                raise ValueError(
                    f"times_s[{index}] = {self.times_s[index]} is not greater than {self.times_s[index - 1]}"
                )
        if not (math.isfinite(self.times_s[0]) and math.isfinite(self.times_s[-1])):
            raise ValueError("times_s is not finite")

    def _check_rows(self, name: str, rows: tuple[Sample, ...], length: int) -> None:
        if rows and len(rows) != len(self.times_s):
            raise ValueError(f"{name} has {len(rows)} rows where times_s has {len(self.times_s)}")
        for index, row in enumerate(rows):
            if len(row) != length or length == 0:
                raise ValueError(f"{name}[{index}] has {len(row)} values, not {length}")
            if not all(map(math.isfinite, row)):
                raise ValueError(f"{name}[{index}] has a non-finite number")
