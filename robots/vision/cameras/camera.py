"""The specification of a depth camera: intrinsics, pose of its optical frame, range and noise."""

from __future__ import annotations

import math

import msgspec
import numpy as np
from numpy.typing import NDArray

from engine.document import DepthCamera, ObjectDetector
from engine.errors import CellError
from engine.messages import Pose, Vector3
from engine.messages.sensing import CameraIntrinsics, DepthImage
from robots.model.transform import RigidTransform
from robots.port import Array

Image = NDArray[np.float32]

_UPRIGHT = 1e-6


class CameraSpec(msgspec.Struct, frozen=True, kw_only=True):
    """A depth camera of a cell; `pose` is that of its optical frame (x right, y down, z forward) in the world.

    Depths outside `range_m` are not measured. `noise_m` is the standard deviation at 1 m and grows with the
    square of the depth.
    """

    name: str
    intrinsics: CameraIntrinsics
    pose: Pose
    rate_hz: float
    range_m: tuple[float, float]
    noise_m: float
    detector: ObjectDetector | None = None


def camera_of(name: str, camera: DepthCamera) -> CameraSpec:
    """Return the specification of a camera in a cell document.

    Raises:
        CellError: it looks at its own position, or its range is empty.
    """
    near, far = camera.range_m
    if not near < far:
        raise CellError(
            f"the range from {near:g} to {far:g} m is empty",
            where=f"camera {name}",
            hint="give the near limit, then the far limit",
        )
    return CameraSpec(
        name=name,
        intrinsics=pinhole(camera.size_px, camera.fov_rad),
        pose=optical_frame_pose(camera.at, camera.look_at, name=name),
        rate_hz=camera.rate_hz,
        range_m=camera.range_m,
        noise_m=camera.noise_m,
        detector=camera.detect,
    )


def pinhole(size_px: tuple[int, int], fov_rad: float) -> CameraIntrinsics:
    """Return the intrinsics of an image of `size_px` (width, height) whose height spans `fov_rad`."""
    width, height = size_px
    focal = height / 2.0 / math.tan(fov_rad / 2.0)
    return CameraIntrinsics(
        width_px=width,
        height_px=height,
        fx_px=focal,
        fy_px=focal,
        cx_px=(width - 1) / 2.0,
        cy_px=(height - 1) / 2.0,
    )


def reduced(intrinsics: CameraIntrinsics, step: int) -> CameraIntrinsics:
    """Return the intrinsics of an image reduced by `step` in both directions."""
    shift = (step - 1) / 2.0
    return CameraIntrinsics(
        width_px=intrinsics.width_px // step,
        height_px=intrinsics.height_px // step,
        fx_px=intrinsics.fx_px / step,
        fy_px=intrinsics.fy_px / step,
        cx_px=(intrinsics.cx_px - shift) / step,
        cy_px=(intrinsics.cy_px - shift) / step,
    )


def optical_frame_pose(at: Vector3, look_at: Vector3, *, name: str = "camera") -> Pose:
    """Return the pose of an optical frame: up in the image is up in the world, or +y if it looks along z.

    Raises:
        CellError: the two points coincide.
    """
    ahead = np.subtract(look_at, at)
    length = float(np.linalg.norm(ahead))
    if not length > _UPRIGHT:
        raise CellError(
            "`look_at` is the position of the camera itself", where=f"camera {name}", hint="change `look_at`"
        )
    ahead = ahead / length
    right = np.cross(ahead, (0.0, 0.0, 1.0))
    if float(np.linalg.norm(right)) < _UPRIGHT:
        right = np.cross(ahead, (0.0, 1.0, 0.0))
    right = right / np.linalg.norm(right)
    return RigidTransform.of(at, _quaternion(np.column_stack((right, np.cross(ahead, right), ahead)))).to_pose("world")


def directions(intrinsics: CameraIntrinsics) -> Array:
    """Return for each pixel, row by row, its point at depth 1 m, (pixels, 3), optical frame."""
    x = (np.arange(intrinsics.width_px) - intrinsics.cx_px) / intrinsics.fx_px
    y = (np.arange(intrinsics.height_px) - intrinsics.cy_px) / intrinsics.fy_px
    across, down = np.meshgrid(x, y)
    return np.column_stack((across.ravel(), down.ravel(), np.ones(across.size))).astype(np.float64)


def pixels(intrinsics: CameraIntrinsics, points: Array) -> Array:
    """Project points (k, 3) of the optical frame, in front of the camera, into the image, (k, 2): u, v."""
    ratio = points[:, :2] / points[:, 2:]
    focal = np.array([intrinsics.fx_px, intrinsics.fy_px])
    return ratio * focal + np.array([intrinsics.cx_px, intrinsics.cy_px])


def depths(image: DepthImage) -> Image:
    """Return the depths of an image, (height, width) float32, as in `DepthImage`.

    Raises:
        CellError: their number differs from the number of pixels.
    """
    shape = (image.intrinsics.height_px, image.intrinsics.width_px)
    if len(image.depth_m) != 4 * shape[0] * shape[1]:
        raise CellError(
            f"{len(image.depth_m)} bytes are not an image of {shape[1]} x {shape[0]} pixels",
            where=f"camera {image.camera}",
            hint="send four bytes per pixel",
        )
    return np.frombuffer(image.depth_m, dtype=np.float32).reshape(shape)


def _quaternion(rotation: Array) -> Array:
    """Return x y z w of a rotation matrix, by its largest component."""
    trace = float(np.trace(rotation))
    squares = np.array([*(1.0 + 2.0 * np.diag(rotation) - trace), 1.0 + trace])
    largest = int(np.argmax(squares))
    (r00, r01, r02), (r10, r11, r12), (r20, r21, r22) = rotation.tolist()
    rows = (
        (1.0 + r00 - r11 - r22, r01 + r10, r02 + r20, r21 - r12),
        (r01 + r10, 1.0 - r00 + r11 - r22, r12 + r21, r02 - r20),
        (r02 + r20, r12 + r21, 1.0 - r00 - r11 + r22, r10 - r01),
        (r21 - r12, r02 - r20, r10 - r01, 1.0 + r00 + r11 + r22),
    )
    chosen = np.array(rows[largest])
    return chosen / np.linalg.norm(chosen)
