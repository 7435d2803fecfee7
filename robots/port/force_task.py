"""The task of a force-tracking motion, and its record."""

from __future__ import annotations

from dataclasses import dataclass, field

import msgspec
import numpy as np

from engine.messages import Quaternion
from engine.skills.dmp import Compliance
from robots.port.arrays import Array
from robots.port.trajectory import JointTrajectory


@dataclass(frozen=True, kw_only=True)
class ForceTask:
    """A tool path with target forces, followed with an admittance.

    Attributes:
        trajectory: The nominal joints over time; starts at the set point at rest and ends at rest.
        offset: Feed-forward offset of the tool from the nominal path, (samples, 6), metres and rotation
            vector, in the task frame; learned in an earlier pass.
        wrench: Target force and torque of the environment on the tool, (samples, 6), in the task frame.
        task_xyzw: Orientation in the world of the task frame that the `frame` of the admittance names.
        admittance: Response of the path to measured forces.
        slow_per_n: Phase stopping: the pace slows to 1 / (1 + slow_per_n · |force error|); 0 for never.
        record_s: Period of the record.
    """

    trajectory: JointTrajectory
    offset: Array
    wrench: Array
    task_xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)
    admittance: Compliance = field(default_factory=Compliance)
    slow_per_n: float = 0.0
    record_s: float = 0.01


class ForceRecord(msgspec.Struct, frozen=True, kw_only=True):
    """The record of a force-tracking motion: `MotionReport.data`, encoded by `to_bytes`.

    `share` (k,) is the elapsed share of the trajectory's time; `offset` (k, 6) the total offset from
    the nominal path and `wrench` (k, 6) the measured one, both in the task frame; float64 row-major bytes.
    """

    share: bytes
    offset: bytes
    wrench: bytes

    @classmethod
    def of(cls, *, share: Array, offset: Array, wrench: Array) -> ForceRecord:
        """Return the record of these samples."""
        return cls(share=_bytes(share), offset=_bytes(offset), wrench=_bytes(wrench))

    @classmethod
    def from_bytes(cls, data: bytes) -> ForceRecord:
        """Decode a record from `to_bytes`."""
        return msgspec.msgpack.decode(data, type=cls)

    def to_bytes(self) -> bytes:
        """Return the record as bytes."""
        return msgspec.msgpack.encode(self)

    def shares(self) -> Array:
        """Elapsed share of the trajectory's time at each sample, (k,)."""
        return np.frombuffer(self.share)

    def offsets(self) -> Array:
        """Offsets, (k, 6)."""
        return np.frombuffer(self.offset).reshape(-1, 6)

    def wrenches(self) -> Array:
        """Measured wrenches, (k, 6)."""
        return np.frombuffer(self.wrench).reshape(-1, 6)


def _bytes(values: Array) -> bytes:
    return np.ascontiguousarray(values, dtype=np.float64).tobytes()
