"""From exact depths to what a camera measures: its range, its noise, and what stands for nothing."""

from __future__ import annotations

import zlib

import numpy as np

from engine.messages.sensing import CameraIntrinsics, DepthImage
from robots.vision.camera import CameraSpec, Image


def measured_image(
    camera: CameraSpec, exact: Image, *, intrinsics: CameraIntrinsics, time_s: float, frame: int, seed: int
) -> DepthImage:
    """Return what a camera measures where the depths are `exact` (height, width), infinite where there is nothing.

    What is too near is not measured; what is too far is as if there were nothing.
    The noise depends on the camera's name, the number of the frame and the seed only.
    """
    near, far = camera.range_m
    depth = exact
    if camera.noise_m > 0.0:
        stream = np.random.default_rng([seed, zlib.crc32(camera.name.encode()), frame])
        noise = stream.standard_normal(exact.shape, dtype=np.float32)
        depth = exact + noise * (np.float32(camera.noise_m) * np.minimum(exact, np.float32(far)) ** 2)
    # What is out of range is so before the noise: else the border of the range would be speckled.
    depth = np.where(exact < near, np.float32(0.0), np.where(exact > far, np.float32(np.inf), depth))
    return DepthImage(
        time_s=time_s,
        camera=camera.name,
        intrinsics=intrinsics,
        pose=camera.pose,
        depth_m=depth.astype(np.float32).tobytes(),
    )


def frame_number(camera: CameraSpec, time_s: float) -> int:
    """Return the number of the frame that a camera takes at `time_s` of the world, whoever looks at it."""
    return max(0, round(time_s * camera.rate_hz))
