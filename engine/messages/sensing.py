"""Messages of cameras: depth images and the occupancy grid computed from them."""

from __future__ import annotations

from typing import Literal

from engine.messages.geometry import Message, Pose, Vector3

CameraCondition = Literal["unknown", "healthy", "covered", "dark", "frozen", "late", "displaced", "miscalibrated"]


class CameraIntrinsics(Message, frozen=True, kw_only=True):
    """A pinhole camera without distortion, in pixels; pixel centres are at whole numbers."""

    width_px: int
    height_px: int
    fx_px: float
    fy_px: float
    cx_px: float
    cy_px: float


class DepthImage(Message, frozen=True, kw_only=True):
    """One image of a depth camera, published on `<camera>/depth`.

    `pose` is that of the optical frame in the world when the image was taken: x to the right, y down, z into
    the scene. `depth_m` are float32 distances along z by rows, top row first; 0 for an invalid measurement,
    infinity where nothing is within the camera's range (as in ROS, REP 117). `brightness` is the mean of the
    camera's own light image from 0 to 1, None if it has none.
    """

    time_s: float
    camera: str
    intrinsics: CameraIntrinsics
    pose: Pose
    depth_m: bytes
    brightness: float | None = None


class OccupancyGrid(Message, frozen=True, kw_only=True):
    """The voxels of an axis-aligned box occupied by unknown objects, published on `cell/occupancy`.

    `corner_m` is the box's lowest corner, `shape` the number of voxels along x, y and z. `occupied` are bits,
    x slowest and z fastest, packed eight to a byte with the first one highest (`numpy.packbits`). The arms,
    their held parts and the known obstacles are excluded. `revision` increases with every change,
    `time_s` is the time of the latest image in the grid.
    """

    time_s: float
    revision: int
    corner_m: Vector3
    voxel_m: float
    shape: tuple[int, int, int]
    occupied: bytes


NEVER_SEEN, LONG_UNSEEN = 255, 254
"""Ages in `ObservedSpace`: never seen, and seen so long ago that the age does not fit."""
AGES_PER_S = 10
"""Ages are in tenths of a second."""


class ObservedSpace(Message, frozen=True, kw_only=True):
    """When the cameras last saw each voxel of the mapped box, published on `cell/observed_space`.

    `ages` has one byte per voxel, x slowest and z fastest: tenths of a second before `time_s`, at most
    `LONG_UNSEEN`, or `NEVER_SEEN`. A voxel is seen when a healthy camera measures something at or behind it. Space
    that is known, such as fixtures, parts and the arms, has the age 0. Space older than `limit_s` is unknown.
    """

    time_s: float
    corner_m: Vector3
    voxel_m: float
    shape: tuple[int, int, int]
    limit_s: float
    ages: bytes

    @property
    def greatest_known_age(self) -> int:
        """The age, as in `ages`, beyond which a voxel is unknown."""
        return min(round(AGES_PER_S * self.limit_s), LONG_UNSEEN - 1)


class CameraInfo(Message, frozen=True, kw_only=True):
    """The properties of a depth camera, the latest value of `<camera>/camera_info`; `pose` is its optical frame's.

    The images may be smaller, and have their own intrinsics.
    """

    camera: str
    intrinsics: CameraIntrinsics
    pose: Pose
    rate_hz: float
    range_m: tuple[float, float]


class CameraStatus(Message, frozen=True, kw_only=True):
    """Whether the images of a camera can be relied on, the latest value of `<camera>/status`.

    `unknown` stands before the first image. The `cause` of every other condition than `healthy` is a sentence.
    """

    time_s: float
    camera: str
    condition: CameraCondition
    cause: str = ""

    @property
    def unhealthy(self) -> bool:
        """True if the images are there but cannot be relied on."""
        return self.condition not in ("healthy", "unknown")


class OccupancyState(Message, frozen=True, kw_only=True):
    """Whether `cell/occupancy` is reliable, the latest value of `cell/occupancy_state`.

    `stale_reason` is empty while the grid is reliable. `made` describes how the depth images are made. `looks`
    counts the image times since the cell was opened, `dropped` those skipped because the previous one was
    still being mapped. `image_s` and `mapping_s` are the durations of making and mapping the latest images.
    """

    stale_reason: str
    made: str
    revision: int
    looks: int
    dropped: int
    image_s: float
    mapping_s: float
