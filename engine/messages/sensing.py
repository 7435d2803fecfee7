"""What cameras see and what is made of it: depth images and the occupancy of the cell's space, as messages."""

from __future__ import annotations

from engine.messages.geometry import Message, Pose, Vector3


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
    the scene. `depth_m` are float32 distances along z by rows, top row first; 0 where nothing was measured,
    infinity where it was measured that nothing is there as far as the camera can see (as in ROS, REP 117).
    """

    time_s: float
    camera: str
    intrinsics: CameraIntrinsics
    pose: Pose
    depth_m: bytes


class OccupancyGrid(Message, frozen=True, kw_only=True):
    """Which voxels of a box along the world's axes are taken by something unknown, published on `cell/occupancy`.

    `corner_m` is the box's lowest corner, `shape` the number of voxels along x, y and z. `occupied` are bits,
    x slowest and z fastest, packed eight to a byte with the first one highest (`numpy.packbits`). The arms
    themselves, what they hold and the known obstacles are taken out. `revision` rises with every change,
    `time_s` is the time of the newest image in it.
    """

    time_s: float
    revision: int
    corner_m: Vector3
    voxel_m: float
    shape: tuple[int, int, int]
    occupied: bytes


class CameraInfo(Message, frozen=True, kw_only=True):
    """What a depth camera is, the latest value of `<camera>/camera_info`; `pose` is that of its optical frame.

    The images themselves may be smaller, and carry their own intrinsics.
    """

    camera: str
    intrinsics: CameraIntrinsics
    pose: Pose
    rate_hz: float
    range_m: tuple[float, float]


class OccupancyState(Message, frozen=True, kw_only=True):
    """Whether `cell/occupancy` can be relied on, the latest value of `cell/occupancy_state`.

    `stale_reason` says why not, and is empty while it can. `made` says how the depth images are made. `looks`
    counts the images' moments since the cell was opened, `dropped` those left out because the one before was
    still being mapped. `image_s` and `mapping_s` are how long the newest images took to make and to map.
    """

    stale_reason: str
    made: str
    revision: int
    looks: int
    dropped: int
    image_s: float
    mapping_s: float
