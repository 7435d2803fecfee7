"""Renders the cameras of a simulated cell and updates the map: one call per instant, in any process."""

from __future__ import annotations

import time
from collections.abc import Mapping

import numpy as np

from engine.errors import CellError
from engine.messages.sensing import CameraStatus, DepthImage, ObservedSpace, OccupancyGrid
from engine.skills.vision import Detections
from robots.planning.scene.cell_planning_scene import known_obstacles
from robots.vision.cameras.camera import CameraSpec
from robots.vision.cameras.depth_renderer import new_depth_renderer
from robots.vision.cameras.physics_copy import PhysicsCopy
from robots.vision.cameras.simulated_cameras import SimulatedCameras
from robots.vision.detection.part_detector import PartDetector
from robots.vision.health.camera_health import CameraHealth
from robots.vision.health.expected_view import ExpectedView
from robots.vision.known_geometry import ArmConfiguration, KnownGeometry, MeasuredState
from robots.vision.occupancy.arm_body import ArmBody
from robots.vision.occupancy.occupancy_mapper import OccupancyMapper
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup

_NO_BALLS = np.empty((0, 4))


class CameraRig:
    """The cameras of a simulated cell; owned by the thread that created it.

    Args:
        setup: The cell and its cameras.
        repeatable: Whether the images must be identical on every machine.

    Raises:
        CellError: the cell cannot be built, or the rendering method set in the environment is unavailable.
    """

    def __init__(self, setup: PerceptionSetup, *, repeatable: bool) -> None:
        self._setup = setup
        self._cameras = {camera.name: camera for camera in setup.cameras}
        self._cell = PhysicsCopy(setup.scene)
        self._depth = new_depth_renderer(self._cell, setup.cameras, box=setup.box, repeatable=repeatable)
        self._port = SimulatedCameras(self._depth, seed=setup.seed)
        self._bodies = {arm.name: ArmBody(arm) for arm in setup.scene.arms}
        self._health = self._new_health()
        self._detector = PartDetector(self._cell, setup.scene.parts, seed=setup.seed)
        self._mapper = _new_mapper(setup)
        self.know(KnownGeometry(obstacles=known_obstacles(setup.present)))

    @property
    def words(self) -> str:
        """Human-readable name of the rendering method."""
        return self._depth.words

    def know(self, known: KnownGeometry) -> None:
        """Exclude these obstacles and held parts from the next image on."""
        if self._mapper is not None:
            self._mapper.know(known)

    def change(self, setup: PerceptionSetup) -> None:
        """Take the fixtures and the frames of detectors as they are from the next image on."""
        self._setup = setup
        self._cameras = {camera.name: camera for camera in setup.cameras}
        self._health = self._new_health()

    def look(self, look: PerceptionRequest) -> PerceptionResult:
        """Render the images, update the map and detect objects.

        Raises:
            CellError: the known geometry does not fit the cell; the map is unchanged.
        """
        unknown = [name for name in (*look.cameras, *look.detecting) if name not in self._cameras]
        if unknown:
            raise CellError(
                f"there is no camera {unknown[0]}", where="cameras", hint=f"the cameras are {[*self._cameras]}"
            )
        started_s = time.perf_counter()
        self._cell.go_to(look.state)
        shown = {
            name: self._port.image(self._cameras[name], time_s=look.time_s, faults=look.faults) for name in look.cameras
        }
        rendered_s = time.perf_counter()
        moment = self._cell.moment(look.time_s)
        statuses = self._judged(shown, moment)
        # The images of an unhealthy camera fill no voxels, and clear and free none.
        usable = tuple(
            image
            for image, status in zip(shown.values(), statuses, strict=True)
            if image is not None and not status.unhealthy
        )
        grid = self._mapped(look, usable, moment)
        observed = self._observed(look, usable)
        mapped_s = time.perf_counter()
        return PerceptionResult(
            grid=grid,
            observed=observed,
            images=tuple(image for name, image in shown.items() if image is not None and name in look.returned),
            statuses=statuses,
            detections=tuple(self._found(self._cameras[name], look.time_s) for name in look.detecting),
            render_s=rendered_s - started_s,
            map_s=mapped_s - rendered_s,
        )

    def warm(self) -> None:
        """Compile and load everything that the first request needs; the map stays empty."""
        home = {arm.name: ArmConfiguration(joints=arm.robot().home_rad) for arm in self._setup.scene.arms}
        shown = {camera.name: self._port.image(camera, time_s=0.0, faults={}) for camera in self._setup.cameras}
        images = [image for image in shown.values() if image is not None]
        self._judged(shown, MeasuredState(time_s=0.0, arms=home))
        self._health = self._new_health()
        if self._mapper is not None:
            self._mapper.update(images, MeasuredState(time_s=0.0, arms=home))
            self._mapper.observe(images, time_s=0.0)
            self._mapper.forget()

    def close(self) -> None:
        """Release the graphics context."""
        self._depth.close()

    def _judged(self, shown: Mapping[str, DepthImage | None], moment: MeasuredState) -> tuple[CameraStatus, ...]:
        if not shown:
            return ()
        balls = np.vstack([_NO_BALLS, *(self._bodies[name].balls(arm) for name, arm in moment.arms.items())])
        return tuple(self._health[name].judge(image, balls, now_s=moment.time_s) for name, image in shown.items())

    def _new_health(self) -> dict[str, CameraHealth]:
        bodies = {fixture.name for fixture in self._setup.present.fixtures if fixture.spring_n_m == 0.0}
        fixtures = [one for one in known_obstacles(self._setup.present) if one.name in bodies]
        return {
            name: CameraHealth(camera, ExpectedView(camera, self._depth.intrinsics(camera), fixtures))
            for name, camera in self._cameras.items()
        }

    def _mapped(
        self, look: PerceptionRequest, images: tuple[DepthImage, ...], moment: MeasuredState
    ) -> OccupancyGrid | None:
        if self._mapper is None or not look.cameras:
            return None
        if look.forget:
            self._mapper.forget()
        return self._mapper.update(images, moment)

    def _observed(self, look: PerceptionRequest, images: tuple[DepthImage, ...]) -> ObservedSpace | None:
        if self._mapper is None or not look.cameras or not look.observed:
            return None
        return self._mapper.observe(images, time_s=look.time_s)

    def _found(self, camera: CameraSpec, time_s: float) -> Detections:
        if camera.detector is None:
            raise CellError(
                f"{camera.name} has no detector", where="cameras", hint="add `detect: {}` to it in the cell document"
            )
        return self._detector.detections(camera, camera.detector, time_s=time_s)


def _new_mapper(setup: PerceptionSetup) -> OccupancyMapper | None:
    if setup.box is None:
        return None
    return OccupancyMapper(
        setup.box, setup.scene.arms, far_m={camera.name: camera.range_m[1] for camera in setup.cameras}
    )
