"""Detections in the images of a camera and the detection service, served under the camera's name.

A detector publishes on `<camera>/detections` while the topic has subscribers, or while the parameter
`<camera>/detect_always` is true; the parameter `<camera>/detection_rate_hz` is the rate.
"""

from __future__ import annotations

from itertools import product
from typing import Annotated, cast

import msgspec

from engine.messages import Message, Pose, Vector3
from engine.messages.pose_algebra import compose_poses, rotate_vector
from engine.skill import Service

Score = Annotated[float, msgspec.Meta(ge=0.0, le=1.0, description="Confidence of the detector, 0 to 1")]
Vertices = tuple[Vector3, Vector3, Vector3, Vector3, Vector3, Vector3, Vector3, Vector3]
Rectangle = tuple[float, float, float, float]


class Detection(Message, frozen=True, kw_only=True):
    """One detected object: its label and its oriented bounding box.

    `pose` is that of the box's centre in the frame that it names, `size_m` its full edge lengths along its own
    axes. `rectangle_px` are left, top, right and bottom of its visible area in the camera's image, in pixels
    whose centres are at whole numbers; None when the detector does not provide it.
    """

    label: Annotated[str, msgspec.Meta(min_length=1, max_length=80)]
    score: Score
    pose: Pose
    size_m: Vector3
    rectangle_px: Rectangle | None = None

    def __post_init__(self) -> None:
        if not min(self.size_m) > 0.0:
            raise ValueError(f"the edges of a box must be positive, not {self.size_m} m")

    @property
    def vertices_m(self) -> Vertices:
        """The corners of the box in the frame of `pose`, x slowest and z fastest, lower values first."""
        corners: list[Vector3] = []
        for signs in product((-0.5, 0.5), repeat=3):
            x, y, z = (sign * edge for sign, edge in zip(signs, self.size_m, strict=True))
            a, b, c = rotate_vector(self.pose.xyzw, (x, y, z))
            corners.append((self.pose.xyz[0] + a, self.pose.xyz[1] + b, self.pose.xyz[2] + c))
        return cast("Vertices", tuple(corners))


class Detections(Message, frozen=True, kw_only=True):
    """All detections in one image, published on `<camera>/detections`; highest scores first.

    `time_s` is that of the image, `image_px` its width and height. All boxes are in `frame`, which was at
    `frame_pose` in the world. After `fresh_s` they are stale: newer ones should have arrived.
    """

    camera: str
    frame: str
    time_s: float
    detections: tuple[Detection, ...]
    image_px: tuple[int, int]
    frame_pose: Pose = Pose(xyz=(0.0, 0.0, 0.0))
    fresh_s: float = 1.0

    def in_world(self, detection: Detection) -> Pose:
        """Return the pose of a detection's box in the world."""
        return compose_poses(self.frame_pose, detection.pose)

    def only(self, *, labels: tuple[str, ...] = (), minimal_score: float = 0.0) -> Detections:
        """Return the detections with one of the labels (any label when empty) and at least the minimal score."""
        kept = tuple(
            each for each in self.detections if each.score >= minimal_score and (not labels or each.label in labels)
        )
        return msgspec.structs.replace(self, detections=kept)


class DetectObjects(Service[Detections], frozen=True, kw_only=True):
    """Return the detections in the camera's next image with one of `labels` (any when empty) and a minimal score.

    Refused while the camera provides no images.
    """

    labels: tuple[str, ...] = ()
    minimal_score: Score = 0.0
