"""Setup, request and result of perception as data that can be sent to the camera process."""

from __future__ import annotations

import msgspec

from engine.messages.sensing import CameraStatus, DepthImage, ObservedSpace, OccupancyGrid
from engine.skills.simulated_world import CameraFault
from engine.skills.vision import Detections
from robots.port import Array
from robots.scene.sim_scene import FixtureBody, SimScene
from robots.vision.cameras.camera import CameraSpec
from robots.vision.voxel_box import VoxelBox


class PerceptionSetup(msgspec.Struct, frozen=True, kw_only=True, tag="setup"):
    """A simulated cell with its cameras; `seed` is that of the noise.

    `box` is the mapped box, None without a map. `observes` says that motions ask which space is unknown. `fixtures` are
    those that are in the world now, None for all of the scene; a setup with others replaces an earlier one.
    """

    scene: SimScene
    cameras: tuple[CameraSpec, ...]
    box: VoxelBox | None
    observes: bool = False
    seed: int = 0
    fixtures: tuple[FixtureBody, ...] | None = None

    @property
    def present(self) -> SimScene:
        """The scene with the fixtures that are in the world now."""
        return self.scene if self.fixtures is None else msgspec.structs.replace(self.scene, fixtures=self.fixtures)


class PerceptionRequest(msgspec.Struct, frozen=True, kw_only=True, tag="look"):
    """A request for images of `cameras` at world time `time_s`; `returned` are those whose images are returned too.

    The cameras in `detecting` also detect objects. `state` is as `WorldHost.image`. With `forget` the map
    restarts with these images. With `observed` the result says when each voxel was last seen. `faults` are those
    of cameras, by name.
    """

    time_s: float
    state: Array
    cameras: tuple[str, ...]
    returned: tuple[str, ...] = ()
    detecting: tuple[str, ...] = ()
    forget: bool = False
    observed: bool = False
    faults: dict[str, CameraFault] = {}


class PerceptionResult(msgspec.Struct, frozen=True, kw_only=True, tag="seen"):
    """The map after a request, the requested images, and the times for rendering and mapping.

    `grid` is None without a map, or if no images were taken; `observed` also if it was not asked for.
    `statuses` are those of the requested cameras.
    """

    grid: OccupancyGrid | None
    observed: ObservedSpace | None = None
    images: tuple[DepthImage, ...]
    statuses: tuple[CameraStatus, ...] = ()
    detections: tuple[Detections, ...] = ()
    render_s: float
    map_s: float
