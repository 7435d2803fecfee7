"""Renders the cameras of a simulated cell and updates the map: one call per instant, in any process."""

from __future__ import annotations

import time

from engine.errors import CellError
from engine.messages.sensing import DepthImage, OccupancyGrid
from engine.skills.vision import Detections
from robots.planning.scene.cell_planning_scene import known_obstacles
from robots.vision.cameras.camera import CameraSpec
from robots.vision.cameras.depth_image import frame_number, measured_image
from robots.vision.cameras.depth_renderer import new_depth_renderer
from robots.vision.cameras.physics_copy import PhysicsCopy
from robots.vision.detection.part_detector import PartDetector
from robots.vision.known_geometry import ArmConfiguration, KnownGeometry, MeasuredState
from robots.vision.occupancy.occupancy_mapper import OccupancyMapper
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup


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
        self._detector = PartDetector(self._cell, setup.scene.parts, seed=setup.seed)
        self._mapper = OccupancyMapper(setup.box, setup.scene.arms) if setup.box is not None else None
        self.know(KnownGeometry(obstacles=known_obstacles(setup.scene)))

    @property
    def words(self) -> str:
        """Human-readable name of the rendering method."""
        return self._depth.words

    def know(self, known: KnownGeometry) -> None:
        """Exclude these obstacles and held parts from the next image on."""
        if self._mapper is not None:
            self._mapper.know(known)

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
        images = tuple(self._image(self._cameras[name], look.time_s) for name in look.cameras)
        rendered_s = time.perf_counter()
        grid = self._mapped(look, images)
        mapped_s = time.perf_counter()
        return PerceptionResult(
            grid=grid,
            images=tuple(image for image in images if image.camera in look.returned),
            detections=tuple(self._found(self._cameras[name], look.time_s) for name in look.detecting),
            render_s=rendered_s - started_s,
            map_s=mapped_s - rendered_s,
        )

    def warm(self) -> None:
        """Compile and load everything that the first request needs; the map stays empty."""
        home = {arm.name: ArmConfiguration(joints=arm.robot().home_rad) for arm in self._setup.scene.arms}
        images = [self._image(camera, 0.0) for camera in self._setup.cameras]
        if self._mapper is not None:
            self._mapper.update(images, MeasuredState(time_s=0.0, arms=home))
            self._mapper.forget()

    def close(self) -> None:
        """Release the graphics context."""
        self._depth.close()

    def _mapped(self, look: PerceptionRequest, images: tuple[DepthImage, ...]) -> OccupancyGrid | None:
        if self._mapper is None or not images:
            return None
        if look.forget:
            self._mapper.forget()
        return self._mapper.update(images, self._cell.moment(look.time_s))

    def _found(self, camera: CameraSpec, time_s: float) -> Detections:
        if camera.detector is None:
            raise CellError(
                f"{camera.name} has no detector", where="cameras", hint="add `detect: {}` to it in the cell document"
            )
        return self._detector.detections(camera, camera.detector, time_s=time_s)

    def _image(self, camera: CameraSpec, time_s: float) -> DepthImage:
        return measured_image(
            camera,
            self._depth.exact(camera),
            intrinsics=self._depth.intrinsics(camera),
            time_s=time_s,
            frame=frame_number(camera, time_s),
            seed=self._setup.seed,
        )
