"""What is looked at, the order to look, and what is seen: as data that crosses the border of the camera process."""

from __future__ import annotations

import msgspec
import numpy as np

from engine.messages.sensing import DepthImage, OccupancyGrid
from engine.skills.vision import Detections
from robots.port import Array
from robots.sim.scene.sim_scene import SimScene
from robots.vision.camera import CameraSpec
from robots.vision.voxel_box import VoxelBox


class PerceptionSetup(msgspec.Struct, frozen=True, kw_only=True):
    """What is looked at: a simulated cell, its cameras; `seed` is that of the noise.

    `box` is what is mapped, None where nothing is.
    """

    scene: SimScene
    cameras: tuple[CameraSpec, ...]
    box: VoxelBox | None
    seed: int = 0


class PerceptionRequest(msgspec.Struct, frozen=True, kw_only=True):
    """An order to take images with `cameras` of the world at `time_s`; `wanted` are those to be handed out too.

    With those of `detecting` objects are looked for. `state` are the float64 of `Host.image`. With `forget` the map
    begins anew with these images.
    """

    time_s: float
    state: bytes
    cameras: tuple[str, ...]
    wanted: tuple[str, ...] = ()
    detecting: tuple[str, ...] = ()
    forget: bool = False


class PerceptionResult(msgspec.Struct, frozen=True, kw_only=True):
    """The map after a look, the images that were wanted, and how long making the images and mapping them took.

    `grid` is None where nothing is mapped, or no images were taken.
    """

    grid: OccupancyGrid | None
    images: tuple[DepthImage, ...]
    detections: tuple[Detections, ...] = ()
    render_s: float
    map_s: float


def state_bytes(image: Array) -> bytes:
    """Return an image of the world (`Host.image`) as a `PerceptionRequest` carries it."""
    return np.ascontiguousarray(image, dtype=np.float64).tobytes()
