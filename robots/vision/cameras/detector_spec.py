"""The specification of a detector: labels, visibility thresholds, noise and frame."""

from __future__ import annotations

import msgspec

from engine.document import ObjectDetector
from engine.messages import Pose


class DetectorSpec(msgspec.Struct, frozen=True, kw_only=True):
    """A detector of a cell; `labels` by part name, `frame_pose` is that of `frame` in the world."""

    rate_hz: float
    always: bool
    labels: dict[str, str]
    min_pixels: int
    min_share: float
    noise_m: float
    noise_rad: float
    frame: str
    frame_pose: Pose


def detector_of(detector: ObjectDetector) -> DetectorSpec:
    """Return the specification of a detector in a cell document."""
    return DetectorSpec(
        rate_hz=detector.rate_hz,
        always=detector.always,
        labels=dict(detector.labels),
        min_pixels=detector.min_pixels,
        min_share=detector.min_share,
        noise_m=detector.noise_m,
        noise_rad=detector.noise_rad,
        frame=detector.frame,
        frame_pose=detector.frame_at.pose(),
    )
