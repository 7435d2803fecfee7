"""The template of a detector as a typed record: an image crop, its camera pose, and the detector."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages.geometry import Message, Pose
from engine.messages.sensing import CameraIntrinsics

MAX_IMAGE_BYTES = 4 * 1024 * 1024
"""Size limit of one encoded crop; with base64 it stays below the size limit of an entry."""
_STARTS = {"png": b"\x89PNG\r\n\x1a\n", "jpeg": b"\xff\xd8\xff"}


class TemplateImage(Message, frozen=True, kw_only=True):
    """An encoded crop; `corner_px` is its upper left corner in the whole image, as (column, row)."""

    format: Literal["png", "jpeg"]
    data: Annotated[bytes, msgspec.Meta(min_length=8, max_length=MAX_IMAGE_BYTES)]
    width_px: Annotated[int, msgspec.Meta(ge=1, le=16_384)]
    height_px: Annotated[int, msgspec.Meta(ge=1, le=16_384)]
    corner_px: tuple[int, int] = (0, 0)

    def __post_init__(self) -> None:
        if not self.data.startswith(_STARTS[self.format]):
            raise ValueError(f"data is not in {self.format} format")
        if self.format == "png":
            size = tuple(int.from_bytes(self.data[at : at + 4]) for at in (16, 20))
            if size != (self.width_px, self.height_px):
                raise ValueError(f"data is an image of {size[0]} x {size[1]}, not {self.width_px} x {self.height_px}")


class DetectionTemplate(Message, frozen=True, kw_only=True):
    """The template that `detector` searches for: `image` or `pose`, or both.

    `image` was taken by `camera` with `intrinsics` and its optical frame at `camera_pose`; `pose` is the pose of the
    object in the image. `settings` are specific to the detector, such as a threshold.
    """

    detector: Annotated[str, msgspec.Meta(min_length=1, max_length=80)]
    label: Annotated[str, msgspec.Meta(max_length=200)] = ""
    image: TemplateImage | None = None
    pose: Pose | None = None
    camera: Annotated[str, msgspec.Meta(max_length=80)] = ""
    camera_pose: Pose | None = None
    intrinsics: CameraIntrinsics | None = None
    settings: Annotated[dict[str, bool | int | float | str], msgspec.Meta(max_length=64)] = {}

    def __post_init__(self) -> None:
        if self.image is None and self.pose is None:
            raise ValueError("give `image`, `pose` or both")
        if self.intrinsics is not None and min(self.intrinsics.width_px, self.intrinsics.height_px) < 1:
            raise ValueError("intrinsics: the image has no pixels")
