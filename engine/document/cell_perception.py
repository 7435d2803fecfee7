"""What a cell document says of its cameras, of the space that they watch, and of the people who reach into it."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.document.decoding import StrictModel
from engine.document.placement import Angle, Color, Length, Name, Offset, Placement, PositionXyz

Pixels = Annotated[int, Meta(ge=16, le=4096, description="Number of pixels")]
Rate = Annotated[float, Meta(gt=0.0, le=120.0, description="Images in a second")]
FieldOfView = Annotated[float, Meta(gt=0.05, lt=3.0, description="Angle between the upper and lower edge, radians")]


DetectionRate = Annotated[float, Meta(gt=0.0, le=120.0, description="Detections in a second")]
PixelCount = Annotated[int, Meta(ge=1, description="Number of pixels")]
SeenShare = Annotated[float, Meta(ge=0.0, le=1.0, description="Share of a part that is seen, 0 to 1")]
PartLabel = Annotated[str, Meta(min_length=1, max_length=80, description="What the detector calls a part")]


class ObjectDetector(StrictModel, frozen=True, kw_only=True):
    """Finds the parts of the cell in a camera's images; an ideal detector that stands in for a learned one.

    It knows the parts and where they are, and reports those of which the camera sees enough: the score is the
    share of a part's pixels that nothing hides. Parts of which fewer than `min_pixels`, or a smaller share than
    `min_share`, are seen are not found. `labels` say what parts are called, else it is by their names. Boxes are in
    the frame `frame` that stands at `frame_at`. `noise_m` and `noise_rad` are standard deviations of the pose along
    and about each axis. It works at most `rate_hz` times a second, while somebody reads it or with `always`.
    """

    rate_hz: DetectionRate = 4.0
    always: bool = False
    labels: dict[Name, PartLabel] = {}
    min_pixels: PixelCount = 25
    min_share: SeenShare = 0.2
    noise_m: Offset = 0.0
    noise_rad: Angle = 0.0
    frame: Name = "world"
    frame_at: Placement = Placement()

    def __post_init__(self) -> None:
        if self.frame == "world" and self.frame_at != Placement():
            raise ValueError("the frame `world` stands at its own origin; give the frame another name")


class DepthCamera(StrictModel, frozen=True, kw_only=True):
    """A depth camera that stands in the cell, simulated by the world.

    `at` is where it stands and `look_at` the point in the middle of its image; up in the image is up in the
    world. Distances outside `range_m`, along the view, are not measured. `noise_m` is the standard deviation
    at 1 m, it grows with the square of the distance. With `detect`, which may be `{}`, it finds parts.
    `driver` is `sim`.
    """

    at: PositionXyz
    look_at: PositionXyz
    size_px: tuple[Pixels, Pixels] = (640, 480)
    fov_rad: FieldOfView = 1.0
    rate_hz: Rate = 10.0
    range_m: tuple[Length, Length] = (0.2, 5.0)
    noise_m: Offset = 0.0
    detect: ObjectDetector | None = None
    driver: Annotated[str, Meta(pattern="^sim$", description="`sim`")] = "sim"


class OccupancyMap(StrictModel, frozen=True, kw_only=True):
    """The box of space, along the world's axes, in which unknown things count as obstacles.

    It is filled and cleared by what the cameras see; without cameras it stays empty. What is nearer than
    `robot_margin_m` to an arm or to what it holds, or than `known_margin_m` to a fixture or part, is taken for
    that and left out.
    """

    center_m: PositionXyz
    size_m: tuple[Length, Length, Length]
    voxel_m: Annotated[float, Meta(ge=0.005, le=0.1, description="Edge of a voxel in metres")] = 0.02
    robot_margin_m: Offset = 0.04
    known_margin_m: Offset = 0.03


def arm_reach_m(upper_arm_m: float, forearm_m: float, radius_m: float) -> tuple[float, float]:
    """Return the least and the greatest distance of a hand from the shoulder; the hand stays out of the shoulder."""
    return max(abs(upper_arm_m - forearm_m), radius_m), upper_arm_m + forearm_m


class Person(StrictModel, frozen=True, kw_only=True):
    """A person of a simulated cell, of whom one arm is there: it reaches from `shoulder` and rests at `hand_rests`.

    The arm is two capsules and a ball, of the lengths and radii of an adult's; it is moved, nothing stops it.
    `forearm_m` ends in the middle of the hand, which is what `hand_rests` and reaches are about.
    """

    shoulder: PositionXyz
    hand_rests: PositionXyz
    upper_arm_m: Length = 0.32
    forearm_m: Length = 0.36
    radius_m: Length = 0.05
    color: Color = "#d9a066"

    @property
    def reach_m(self) -> tuple[float, float]:
        """Least and greatest distance of the hand from the shoulder."""
        return arm_reach_m(self.upper_arm_m, self.forearm_m, self.radius_m)
