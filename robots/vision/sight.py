"""What is looked at, the order to look, and what is seen: as data that crosses the border of the camera process."""

from __future__ import annotations

import msgspec
import numpy as np

from engine.sensing import DepthImage, OccupancyGrid
from robots.port import Array
from robots.sim.scene import Scene
from robots.vision.camera import CameraSpec
from robots.vision.voxel_box import VoxelBox


class Sight(msgspec.Struct, frozen=True, kw_only=True):
    """What is looked at and mapped: a simulated cell, its cameras, the box of voxels; `seed` is that of the noise."""

    scene: Scene
    cameras: tuple[CameraSpec, ...]
    box: VoxelBox
    seed: int = 0


class Look(msgspec.Struct, frozen=True, kw_only=True):
    """An order to take images with `cameras` of the world at `time_s`; `wanted` are those to be handed out too.

    `state` are the float64 of `Host.image`. With `forget` the map begins anew with these images.
    """

    time_s: float
    state: bytes
    cameras: tuple[str, ...]
    wanted: tuple[str, ...] = ()
    forget: bool = False


class Seen(msgspec.Struct, frozen=True, kw_only=True):
    """The map after a look, the images that were wanted, and how long making the images and mapping them took."""

    grid: OccupancyGrid
    images: tuple[DepthImage, ...]
    render_s: float
    map_s: float


def state_bytes(image: Array) -> bytes:
    """Return an image of the world (`Host.image`) as a `Look` carries it."""
    return np.ascontiguousarray(image, dtype=np.float64).tobytes()
