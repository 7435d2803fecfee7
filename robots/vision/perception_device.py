"""The cameras of a simulated cell as a device: takes images on demand and publishes map and detections."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping

import msgspec

from engine.bus import SkillBus, Topic
from engine.errors import SkillFailed
from engine.messages.sensing import (
    CameraInfo,
    CameraStatus,
    DepthImage,
    ObservedSpace,
    OccupancyGrid,
    OccupancyState,
)
from engine.robot import DeviceStatus
from engine.skills.simulated_world import CameraFault, SetCameraFault, SetCameraFaultResult
from engine.wording import did_you_mean
from robots.planning.scene.planning_scene import PlanningScene
from robots.port import GraspCommand
from robots.scene.sim_scene import SimScene
from robots.sim.world.sim_world import SimWorld
from robots.vision.cameras.camera import CameraSpec, camera_of
from robots.vision.detection.detection_service import DetectionService
from robots.vision.known_geometry import KnownGeometry
from robots.vision.occupancy.occupancy_map import LiveOccupancyMap
from robots.vision.occupancy.occupancy_source import Unsubscribe
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup

PROCESSING_S = 0.03
"""Time from an image to the map in virtual time: near the 99th percentile that `benchmarks/perception.py` measures."""

_FRESH_IMAGES = 3
_LEAST_FRESH_S = 0.5
_log = logging.getLogger("flexcell.vision")


class PerceptionDevice:
    """Implements `engine.robot.Robot` for a world and `OccupancySource` for planners.

    `LockstepPerception` and `RealTimePerception` produce the images: they fetch requests here and deliver
    results here.
    """

    name = "cell/cameras"

    def __init__(self, setup: PerceptionSetup, *, world: SimWorld, now_s: Callable[[], float]) -> None:
        self.setup = setup
        self._world = world
        slowest_s = max(1.0 / camera.rate_hz for camera in setup.cameras)
        self.map = LiveOccupancyMap(
            now_s=now_s,
            fresh_s=max(_FRESH_IMAGES * slowest_s, _LEAST_FRESH_S) + PROCESSING_S,
            periods_s={camera.name: 1.0 / camera.rate_hz for camera in setup.cameras},
        )
        self.detections = DetectionService(setup.cameras)
        self.known: KnownGeometry | None = None
        self.status = DeviceStatus.DISCONNECTED
        self.dropped = 0
        self.made = ""
        self._looks = 0
        self._forget = self._forgets = False
        self._base = 0
        self._last: PerceptionResult | None = None
        self.observed: ObservedSpace | None = None
        self._statuses = {
            camera.name: CameraStatus(time_s=0.0, camera=camera.name, condition="unknown") for camera in setup.cameras
        }
        self._faults: dict[str, CameraFault] = {}
        self._status_topics: dict[str, Topic[CameraStatus]] = {}
        self._grids: Topic[OccupancyGrid] | None = None
        self._spaces: Topic[ObservedSpace] | None = None
        self._states: Topic[OccupancyState] | None = None
        self._depths: dict[str, Topic[DepthImage]] = {}

    # `OccupancySource`, for planners.

    @property
    def latest(self) -> OccupancyGrid | None:
        """The latest map."""
        return self.map.latest

    @property
    def camera_statuses(self) -> tuple[CameraStatus, ...]:
        """The status of each camera."""
        return tuple(self._statuses.values())

    @property
    def stale_reason(self) -> str:
        """Why the map is not valid."""
        return self.map.stale_reason

    @property
    def confirmed_age_s(self) -> float:
        """The time since which some camera has not shown what is there, infinite before two images of each."""
        return self.map.confirmed_age_s

    @property
    def starting(self) -> bool:
        """Whether the cameras are still starting."""
        return self.map.starting

    def subscribe(self, callback: Callable[[], None]) -> Unsubscribe:
        """Call `callback` whenever the revision or the stale reason has changed."""
        return self.map.subscribe(callback)

    def require(self) -> None:
        """Take images until as many `release` calls."""
        self.map.required += 1

    def release(self) -> None:
        """Undo one `require`."""
        self.map.required = max(0, self.map.required - 1)

    def forget(self) -> None:
        """Restart with an empty map at the next image."""
        self._forget = True

    def know(self, scene: PlanningScene) -> None:
        """Exclude the obstacles and held parts of `scene` from the next image on."""
        known = KnownGeometry.of(scene)
        if known != self.known:
            self.known = known

    def take_scene(self, scene: SimScene) -> None:
        """Take what is in the world from the next image on."""
        document = self._world.modules.document
        cameras = document.cameras if document is not None else {}
        self.setup = msgspec.structs.replace(
            self.setup,
            fixtures=scene.fixtures,
            cameras=tuple(
                camera_of(each.name, cameras[each.name]) if each.name in cameras else each
                for each in self.setup.cameras
            ),
        )

    # Interface of the image producers.

    @property
    def needed(self) -> bool:
        """Whether the map, an image or detections are in demand."""
        return self._needs_images or self.detections.needed

    def next_look(self, due: tuple[CameraSpec, ...], *, now_s: float) -> PerceptionRequest | None:
        """Return the request for the present world state with the needed cameras among `due`.

        None if no camera is needed, or while the world is lost.
        """
        if self._world.lost_reason:
            return None
        detecting = self.detections.due(due, now_s=now_s)
        requested = self._requested_depths()
        is_mapped = self.setup.box is not None and self._needs_images
        names = tuple(camera.name for camera in due if is_mapped or camera.name in requested)
        if not names and not detecting:
            return None
        image = self._world.host.image()
        forget = self._forget and bool(names)
        self._forget = self._forget and not forget
        self._forgets = self._forgets or forget
        return PerceptionRequest(
            # An image begins with the step count.
            time_s=round(float(image[0])) * self._world.host.summary.step_s,
            state=image,
            cameras=names,
            returned=tuple(name for name in requested if name in names),
            detecting=detecting,
            forget=forget,
            observed=bool(names) and self._needs_observed_space,
            faults=self._faults,
        )

    def restart_revisions(self) -> None:
        """Prepare for the maps of a new camera rig; revisions keep increasing."""
        self._base = self.map.latest.revision if self.map.latest is not None else 0
        self.map.begins_anew()

    def take_result(self, seen: PerceptionResult, *, looked_at_s: float) -> None:
        """Publish a result; results that arrive after the loss of the world are discarded."""
        if self._world.lost_reason:
            return
        self.status = DeviceStatus.READY
        self._take_statuses(seen.statuses)
        if seen.grid is not None:
            self._looks += 1
            self._last = seen
            self._take_observed(seen.observed)
            grid = msgspec.structs.replace(seen.grid, revision=seen.grid.revision + self._base)
            if self._forgets:
                self.map.begins_anew()
                self._forgets = False
            # The images of an unhealthy camera are not in the map.
            mapped = [status.camera for status in seen.statuses if not status.unhealthy]
            if self.map.arrived(grid, looked_at_s=looked_at_s, cameras=mapped) and self._grids is not None:
                self._grids.publish(grid)
        for image in seen.images:
            self._depths[image.camera].publish(image)
        self.detections.take_result(seen.detections)

    def _take_statuses(self, statuses: tuple[CameraStatus, ...]) -> None:
        """Keep the statuses, publish those that have changed, and notify the users of the map."""
        for status in statuses:
            if status == self._statuses[status.camera]:
                continue
            if status.unhealthy:
                _log.warning("camera %s is %s: %s", status.camera, status.condition, status.cause)
            self._statuses[status.camera] = status
            if status.camera in self._status_topics:
                self._status_topics[status.camera].publish(status)
        self.map.unhealthy = frozenset(status.camera for status in self._statuses.values() if status.unhealthy)

    def _take_observed(self, observed: ObservedSpace | None) -> None:
        self.observed = observed
        if observed is not None and self._spaces is not None and self._spaces.subscriber_count > 0:
            self._spaces.publish(observed)

    def fail(self, reason: str) -> None:
        """Report why no images arrive."""
        if reason != self.map.lost_reason:
            _log.error("no camera images: %s", reason)
        self.status = DeviceStatus.FAULT
        self.map.lost(reason)
        self.detections.fail(reason)

    def set_rendering(self, words: str) -> None:
        """Set the name of the rendering method."""
        if words != self.made:
            self.made = words
            _log.info("depth images are rendered %s", words)

    # Interface of a device of the world.

    def grips(self) -> dict[str, GraspCommand]:
        """Cameras hold nothing."""
        return {}

    def recall(self, grips: Mapping[str, GraspCommand]) -> None:
        """Discard the map, as the world was restored to an earlier state."""
        self._forget = True
        self.observed = None
        self.map.outdated()

    def world_lost(self, reason: str) -> None:
        """Invalidate the map: images of a stopped world would look like a cell at rest."""
        self.fail(reason)

    def world_restored(self) -> None:
        """Resume with an empty map."""
        self.recall({})

    def register(self, bus: SkillBus) -> None:
        """Publish the list of cameras; map, images and detections are published while they have subscribers."""
        if self.setup.box is not None:
            self._grids = bus.topic("cell/occupancy", OccupancyGrid)
            self._spaces = bus.topic("cell/observed_space", ObservedSpace)
            self._states = bus.topic("cell/occupancy_state", OccupancyState)
            self._states.provide(self._state)
            self.map.subscribe(self._publish_state)
        self.detections.register(bus)
        bus.advertise_service(SetCameraFault, self._set_fault, namespace="cell")
        for camera in self.setup.cameras:
            self._status_topics[camera.name] = bus.topic(f"{camera.name}/status", CameraStatus)
            self._status_topics[camera.name].publish(self._statuses[camera.name])
            self._depths[camera.name] = bus.topic(f"{camera.name}/depth", DepthImage)
            bus.topic(f"{camera.name}/camera_info", CameraInfo).publish(
                CameraInfo(
                    camera=camera.name,
                    intrinsics=camera.intrinsics,
                    pose=camera.pose,
                    rate_hz=camera.rate_hz,
                    range_m=camera.range_m,
                )
            )

    async def _set_fault(self, request: SetCameraFault) -> SetCameraFaultResult:
        """Set the fault of a camera; raises SkillFailed for an unknown camera."""
        if request.camera not in self._statuses:
            raise SkillFailed(
                f"there is no camera {request.camera}",
                where=self.name,
                hint=did_you_mean(request.camera, self._statuses),
            )
        self._faults = {**self._faults, request.camera: request.fault}
        return SetCameraFaultResult(camera=request.camera, kind=request.fault.kind)

    async def stop(self) -> None:
        """Nothing here moves."""

    @property
    def _needs_observed_space(self) -> bool:
        return self.setup.observes or (self._spaces is not None and self._spaces.subscriber_count > 0)

    @property
    def _needs_images(self) -> bool:
        read = any(topic is not None and topic.subscriber_count > 0 for topic in (self._grids, self._spaces))
        return self.map.required > 0 or read or bool(self._requested_depths())

    def _requested_depths(self) -> tuple[str, ...]:
        return tuple(name for name, topic in self._depths.items() if topic.subscriber_count > 0)

    def _publish_state(self) -> None:
        assert self._states is not None
        if self._states.subscriber_count > 0:
            self._states.publish(self._state())

    def _state(self) -> OccupancyState:
        latest, last = self.map.latest, self._last
        return OccupancyState(
            stale_reason=self.map.stale_reason,
            made=self.made,
            revision=latest.revision if latest is not None else 0,
            looks=self._looks,
            dropped=self.dropped,
            image_s=last.render_s if last is not None else 0.0,
            mapping_s=last.map_s if last is not None else 0.0,
        )
