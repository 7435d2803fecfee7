"""Converts exact depths to a camera measurement: range, noise, and the value for no measurement."""

from __future__ import annotations

import zlib

import numpy as np

from engine.messages.sensing import CameraIntrinsics, DepthImage
from robots.vision.cameras.camera import CameraSpec, Image


def measured_image(
    camera: CameraSpec, exact: Image, *, intrinsics: CameraIntrinsics, time_s: float, frame: int, seed: int
) -> DepthImage:
    """Return the measurement of `exact` depths (height, width), infinite where nothing is hit.

    Too near surfaces are not measured; too far surfaces count as nothing.
    The noise depends on the camera's name, the number of the frame and the seed only.
    """
    near, far = camera.range_m
    depth = exact
    if camera.noise_m > 0.0:
        stream = np.random.default_rng([seed, zlib.crc32(camera.name.encode()), frame])
        noise = stream.standard_normal(exact.shape, dtype=np.float32)
        depth = exact + noise * (np.float32(camera.noise_m) * np.minimum(exact, np.float32(far)) ** 2)
    # The range is applied before the noise, else its border would be speckled.
    depth = np.where(exact < near, np.float32(0.0), np.where(exact > far, np.float32(np.inf), depth))
    return DepthImage(
        time_s=time_s,
        camera=camera.name,
        intrinsics=intrinsics,
        pose=camera.pose,
        depth_m=depth.astype(np.float32).tobytes(),
    )


def frame_number(camera: CameraSpec, time_s: float) -> int:
    """Return the frame number of a camera at world time `time_s`, the same for every observer."""
    return max(0, round(time_s * camera.rate_hz))
