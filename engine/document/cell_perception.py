"""Cameras, occupancy map and people in a cell document."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Annotated, Literal

from msgspec import Meta
from msgspec.structs import replace

from engine.document.placement import (
    Angle,
    Color,
    FrameName,
    ItemName,
    Length,
    Name,
    Offset,
    Placement,
    PositionXyz,
    point_in_world,
)
from engine.document.text.decoding import StrictModel
from engine.document.text.yaml_source import DocumentSource
from engine.errors import DocumentError
from engine.messages import Pose

Pixels = Annotated[int, Meta(ge=16, le=4096, description="Number of pixels")]
Rate = Annotated[float, Meta(gt=0.0, le=120.0, description="Images per second")]
FieldOfView = Annotated[float, Meta(gt=0.05, lt=3.0, description="Angle between the upper and lower edge, radians")]


DetectionRate = Annotated[float, Meta(gt=0.0, le=120.0, description="Detections per second")]
PixelCount = Annotated[int, Meta(ge=1, description="Number of pixels")]
SeenShare = Annotated[float, Meta(ge=0.0, le=1.0, description="Visible share of a part, 0 to 1")]
PartLabel = Annotated[str, Meta(min_length=1, max_length=80, description="Label of a part in detections")]


class ObjectDetector(StrictModel, frozen=True, kw_only=True):
    """Detects the parts of the cell in a camera's images; an ideal detector in place of a learned one.

    It knows the parts and their poses, and reports the sufficiently visible ones: the score is the visible share
    of a part's pixels. Parts with fewer visible pixels than `min_pixels`, or a smaller visible share than
    `min_share`, are not reported. `labels` sets the labels of parts; the default is the part name. Boxes are in
    the frame `frame`, whose origin is at `frame_at`. `noise_m` and `noise_rad` are standard deviations of the pose
    along and about each axis. It runs at most `rate_hz` times per second, while subscribed or with `always`.
    """

    rate_hz: DetectionRate = 4.0
    always: bool = False
    labels: dict[ItemName, PartLabel] = {}
    min_pixels: PixelCount = 25
    min_share: SeenShare = 0.2
    noise_m: Offset = 0.0
    noise_rad: Angle = 0.0
    frame: ItemName = "world"
    frame_at: Placement = Placement()

    def __post_init__(self) -> None:
        if self.frame == "world" and self.frame_at != Placement():
            raise ValueError("the frame `world` cannot be moved; choose another frame name")


class DepthCamera(StrictModel, frozen=True, kw_only=True):
    """A fixed depth camera in the cell, simulated by the world.

    `at` is its position and `look_at` the point in the centre of its image, both in `frame`; up in the image is up in
    the world.
    Distances along the optical axis outside `range_m` are not measured. `noise_m` is the standard deviation at
    1 m; it grows with the square of the distance. With `detect`, which may be `{}`, it detects parts. `driver` is
    `sim`.
    """

    at: PositionXyz
    look_at: PositionXyz
    frame: FrameName = "world"
    size_px: tuple[Pixels, Pixels] = (640, 480)
    fov_rad: FieldOfView = 1.0
    rate_hz: Rate = 10.0
    range_m: tuple[Length, Length] = (0.2, 5.0)
    noise_m: Offset = 0.0
    detect: ObjectDetector | None = None
    driver: Annotated[str, Meta(pattern="^sim$", description="`sim`")] = "sim"

    def in_world(self, poses: Mapping[str, Pose], *, named: Mapping[str, Pose]) -> DepthCamera:
        """Return the same camera in the world, which detects in a frame of the cell where it names one.

        Args:
            poses: The poses in the world of all that something may stand in.
            named: Those of the frames of the cell.
        """
        camera = self
        if camera.frame != "world":
            base = poses[camera.frame]
            at, look_at = (point_in_world(base, point) for point in (camera.at, camera.look_at))
            camera = replace(camera, at=at, look_at=look_at, frame="world")
        if camera.detect is None or camera.detect.frame not in named:
            return camera
        return replace(camera, detect=replace(camera.detect, frame_at=Placement.of(named[camera.detect.frame])))


_ROUNDING_M = 1e-6

UnknownSpacePolicy = Literal["refuse", "slow", "look_first", "accept"]


class CoveredRegion(StrictModel, frozen=True, kw_only=True):
    """An axis-aligned box of the world frame that the cameras must see."""

    center_m: PositionXyz
    size_m: tuple[Length, Length, Length]


class OccupancyMap(StrictModel, frozen=True, kw_only=True):
    """The axis-aligned box in the world frame in which unknown objects count as obstacles.

    Camera measurements fill and clear it; without cameras it stays empty. Points nearer than `robot_margin_m`
    to an arm or its held object, or than `known_margin_m` to a fixture or part, are attributed to that and
    ignored.

    Space that no camera has seen through for `seen_within_s` is unknown. `unknown_space` says what becomes of a
    planned motion through unknown space: it is refused, slowed down, delayed until the cameras have seen it, or
    carried out. With `must_cover`, regions by name, only space inside them counts. The default is `refuse` with
    `must_cover`, else `accept`.
    """

    center_m: PositionXyz
    size_m: tuple[Length, Length, Length]
    must_cover: dict[Name, CoveredRegion] = {}
    unknown_space: UnknownSpacePolicy | None = None
    seen_within_s: Annotated[
        float, Meta(ge=0.2, le=25.0, description="Seconds after which space that no camera sees is unknown")
    ] = 5.0
    voxel_m: Annotated[float, Meta(ge=0.005, le=0.1, description="Edge of a voxel in metres")] = 0.02
    robot_margin_m: Offset = 0.04
    known_margin_m: Offset = 0.03

    def __post_init__(self) -> None:
        for name, region in self.must_cover.items():
            edges = zip(region.center_m, self.center_m, region.size_m, self.size_m, strict=True)
            outside_m = max(abs(centre - middle) + (edge - whole) / 2.0 for centre, middle, edge, whole in edges)
            if outside_m > _ROUNDING_M:
                raise ValueError(f"the region {name} extends {outside_m:.3f} m beyond the box of the map")

    @property
    def unknown_space_policy(self) -> UnknownSpacePolicy:
        """The policy as written, else its default."""
        return self.unknown_space or ("refuse" if self.must_cover else "accept")


class SpeedAndSeparationMonitoring(StrictModel, frozen=True, kw_only=True):
    """The speed of all arms follows their distance from unknown bodies in the occupancy map (ISO/TS 15066, 5.5.4).

    `hand_speed_m_s` is how fast people approach. `reaction_s` is at least the reaction time that follows from the
    cameras. `intrusion_distance_m` is how far a person enters before being measured; by default it follows from the
    edge of the voxels (ISO 13855). `position_uncertainty_m` is that of measured people and of the arm together. It is
    no certified safety function.
    """

    hand_speed_m_s: Annotated[float, Meta(ge=0.1, le=5.0, description="Speed of an approaching hand in m/s")] = 1.6
    reaction_s: Annotated[float, Meta(gt=0.0, le=5.0, description="Least reaction time in seconds")] | None = None
    intrusion_distance_m: Offset | None = None
    position_uncertainty_m: Offset = 0.03


def arm_reach_m(upper_arm_m: float, forearm_m: float, radius_m: float) -> tuple[float, float]:
    """Return the minimum and maximum distance of the hand from the shoulder; the hand stays outside the shoulder."""
    return max(abs(upper_arm_m - forearm_m), radius_m), upper_arm_m + forearm_m


class Person(StrictModel, frozen=True, kw_only=True):
    """One arm of a person in a simulated cell: it reaches from `shoulder` and rests at `hand_rests`, both in `frame`.

    The arm consists of two capsules and a ball with the dimensions of an adult; it gives way to what pushes it and
    stops at fixtures. `forearm_m` ends at the centre of the hand, to which `hand_rests` and targets refer.
    """

    shoulder: PositionXyz
    hand_rests: PositionXyz
    frame: FrameName = "world"
    upper_arm_m: Length = 0.32
    forearm_m: Length = 0.36
    radius_m: Length = 0.05
    color: Color = "#d9a066"

    @property
    def reach_m(self) -> tuple[float, float]:
        """Minimum and maximum distance of the hand from the shoulder."""
        return arm_reach_m(self.upper_arm_m, self.forearm_m, self.radius_m)

    def in_world(self, poses: Mapping[str, Pose]) -> Person:
        """Return the same person in the world; `poses` are those in the world of all that something may stand in."""
        if self.frame == "world":
            return self
        base = poses[self.frame]
        shoulder, hand_rests = (point_in_world(base, point) for point in (self.shoulder, self.hand_rests))
        return replace(self, shoulder=shoulder, hand_rests=hand_rests, frame="world")


def require_detection_frames(
    cameras: Mapping[str, DepthCamera], frames: Collection[str], source: DocumentSource
) -> None:
    """Require that no camera gives a pose to a frame of the cell, in which it detects.

    Raises:
        DocumentError: `where` is the position in the document.
    """
    for name, camera in cameras.items():
        detect = camera.detect
        if detect is not None and detect.frame in frames and detect.frame_at != Placement():
            raise DocumentError(
                f"camera `{name}` detects in the frame `{detect.frame}` of the cell, whose pose is known",
                where=source.position(("cameras", name, "detect", "frame_at"), of_key=True),
                hint="remove `frame_at`, or choose another frame name",
            )
