"""Factory kinematics calibration files of Universal Robots, applied to the joint origins of a URDF.

The file gives, for every joint, the pose of its frame in the previous frame (z is the joint's axis).
A URDF may place its link frames elsewhere; the file that describes that URDF unchanged (the
nominal one) determines where, because a frame may be shifted along its joint's axis and rotated by
a constant about it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from engine.document import StrictModel, decode_document, load_source
from engine.errors import CellError, DocumentError
from engine.wording import did_you_mean
from robots.model.folder.folder_document import CalibrationFormat
from robots.model.urdf.urdf_tree import Element, joints_of, set_origin
from robots.port import Array

# Tolerance between the URDF and its nominal file: truncated digits.
_SAME_M, _SAME_RAD = 1e-6, 1e-5


class CalibrationSegment(StrictModel, frozen=True, kw_only=True):
    """A frame in the previous one: metres, and radians about fixed x, y, z axes in turn."""

    x: float
    y: float
    z: float
    roll: float
    pitch: float
    yaw: float

    def matrix(self) -> Array:
        """Return the homogeneous transform, shape (4, 4)."""
        return transform((self.x, self.y, self.z), (self.roll, self.pitch, self.yaw))


class _CalibrationDocument(StrictModel, frozen=True, kw_only=True):
    kinematics: dict[str, CalibrationSegment]
    hash: str = ""


@dataclass(frozen=True, kw_only=True)
class Calibration:
    """A calibration file: the segments in the order of the file, and the hash assigned by the robot."""

    file: Path
    segments: dict[str, CalibrationSegment]
    hash: str


def load_calibration(file: Path) -> Calibration:
    """Read a calibration file.

    Raises:
        DocumentError: it cannot be read or is not a calibration file; `where` is the position.
    """
    document = decode_document(load_source(file), _CalibrationDocument)
    return Calibration(file=file, segments=document.kinematics, hash=document.hash)


def apply_calibration(
    robot: Element, described: CalibrationFormat, calibration: Calibration, *, nominal: Calibration
) -> None:
    """Replace the joint origins of a URDF by those of `calibration`.

    Raises:
        DocumentError: a segment is missing or unknown.
        CellError: `nominal` does not describe this URDF.
    """
    for file in (calibration, nominal):
        _require_segments(file, described)
    joints = joints_of(robot)
    inner = transform((0.0, 0.0, 0.0), described.base_rpy)
    for name, joint_name in described.joints.items():
        joint = joints[joint_name]
        before = inner
        # The link frame of the URDF in the frame of the file, at this end of the joint.
        inner = _inverse(nominal.segments[name].matrix()) @ before @ _origin(joint)
        _require_same_axis(inner, joint, nominal)
        placed = _inverse(before) @ calibration.segments[name].matrix() @ inner
        set_origin(joint, xyz=tuple(placed[:3, 3].tolist()), rpy=roll_pitch_yaw(placed))


def transform(xyz: Sequence[float], rpy: Sequence[float]) -> Array:
    """Return the homogeneous transform of a position and a rotation about fixed x, y, z axes in turn."""
    (cr, cp, cy), (sr, sp, sy) = (tuple(f(angle) for angle in rpy) for f in (math.cos, math.sin))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, xyz[0]],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr, xyz[1]],
            [-sp, cp * sr, cp * cr, xyz[2]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def roll_pitch_yaw(placed: Array) -> tuple[float, float, float]:
    """Return the angles about fixed x, y, z axes of a transform; exact at a pitch of 90 degrees too."""
    r: Array = placed[:3, :3]
    level = math.hypot(r[0, 0], r[1, 0])
    yaw = math.atan2(r[1, 0], r[0, 0]) if level > 1e-9 else 0.0
    # With the yaw determined first, the roll compensates its uncertainty.
    sin, cos = math.sin(yaw), math.cos(yaw)
    roll = math.atan2(sin * r[0, 2] - cos * r[1, 2], cos * r[1, 1] - sin * r[0, 1])
    return roll, math.atan2(-r[2, 0], cos * r[0, 0] + sin * r[1, 0]), yaw


def _require_segments(calibration: Calibration, described: CalibrationFormat) -> None:
    for name in described.joints:
        if name not in calibration.segments:
            raise DocumentError(f"the segment {name} is missing", where=str(calibration.file))
    for name in calibration.segments:
        if name not in described.joints:
            hint = did_you_mean(name, described.joints)
            raise DocumentError(f"this robot has no segment {name}", where=str(calibration.file), hint=hint)


def _require_same_axis(inner: Array, joint: Element, nominal: Calibration) -> None:
    """Require that the joint's axis is the z axis of the file's frame, and passes through its origin."""
    described = joint.find("axis")
    axis = np.array([float(v) for v in described.attrib["xyz"].split()] if described is not None else [1.0, 0.0, 0.0])
    off_rad = float(np.linalg.norm(inner[:3, :3] @ axis - [0.0, 0.0, 1.0]))
    off_m = math.hypot(inner[0, 3], inner[1, 3])
    if off_rad > _SAME_RAD or off_m > _SAME_M:
        raise CellError(
            f"{nominal.file.name} is not the calibration of this URDF: {joint.attrib['name']} differs by "
            f"{off_m * 1e3:.3f} mm and {off_rad:.5f} rad",
            where=str(nominal.file),
            hint="correct `calibration: {nominal: …}` of the robot model",
        )


def _origin(joint: Element) -> Array:
    origin = joint.find("origin")
    attributes = origin.attrib if origin is not None else {}
    xyz = [float(v) for v in attributes.get("xyz", "0 0 0").split()]
    return transform(xyz, [float(v) for v in attributes.get("rpy", "0 0 0").split()])


def _inverse(matrix: Array) -> Array:
    result = np.eye(4)
    result[:3, :3] = matrix[:3, :3].T
    result[:3, 3] = -matrix[:3, :3].T @ matrix[:3, 3]
    return result
