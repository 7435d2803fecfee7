"""Passive linear units: a carriage on a rail, held by brakes, that carries an arm; the arm itself pulls it along.

Nothing drives the carriage. Lengths are in metres, forces in newton, masses in kilograms.
"""

from __future__ import annotations

import math
from typing import Annotated

from msgspec import Meta

from engine.document.placement import Name
from engine.document.text.decoding import StrictModel
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import rotate_vector

Place = Annotated[
    float,
    Meta(
        description="Place of the carriage on its rail; 0 is where the document has it", extra_json_schema={"unit": "m"}
    ),
]


class LinearScale(StrictModel, frozen=True, kw_only=True):
    """A scale along the rail that tells the place of the carriage, with normal noise."""

    noise_m: Annotated[float, Meta(ge=0.0, le=0.01, description="Standard deviation of a reading in metres")] = 5e-5


class LinearUnitSpec(StrictModel, frozen=True, kw_only=True):
    """A carriage on a rail without a motor, on which a robot stands. Brakes hold it; the robot pulls itself along.

    `carriage` is a fixture, in whose frame the robot has its `base`; `carries` are the fixtures that are fixed on it.
    It slides `along` an axis of its own frame, level, from its place in the document, 0, within `travel_m`. With the
    output `brakes` on, it is released: then it resists with `friction_n` and with `damping_ns_m`. Braked it is elastic
    and slips at `holding_n`. `anchors` are frames that stand still, at which the robot holds on with its tool centre
    point. `places` have names. Without a `scale` only the robot that holds an anchor measures where it is.
    """

    robot: Annotated[Name, Meta(description="The robot of the cell that stands on the carriage")]
    carriage: Annotated[str, Meta(min_length=1, description="The fixture that slides, a box or a cylinder")]
    carries: Annotated[tuple[str, ...], Meta(description="All fixtures that stand on the carriage")] = ()
    along: Annotated[Vector3, Meta(description="Direction of the rail in the frame of the carriage")] = (1.0, 0.0, 0.0)
    travel_m: Annotated[tuple[Place, Place], Meta(description="The lowest and the highest place")]
    mass_kg: Annotated[float, Meta(gt=0.0, description="Mass of the carriage with what is fixed on it")] = 20.0
    friction_n: Annotated[float, Meta(gt=0.0, le=1e4, description="Friction of the released carriage")] = 25.0
    damping_ns_m: Annotated[float, Meta(ge=0.0, le=1e4, description="Damping of the released carriage")] = 40.0
    holding_n: Annotated[float, Meta(gt=0.0, le=1e5, description="Force at which the braked carriage slips")] = 1500.0
    brakes: Annotated[Name, Meta(description="The output that releases the brakes")]
    released: Annotated[Name, Meta(description="The position of the device with released brakes")] = "released"
    locked: Annotated[Name, Meta(description="The position with locked brakes")] = "locked"
    anchors: Annotated[dict[Name, str], Meta(min_length=1, description="Frames at which the robot holds on")]
    carried_kg: Annotated[float, Meta(ge=0.0, description="Maximum load of the robot while it pulls")] = 5.0
    places: dict[Name, Place] = {}
    scale: LinearScale | None = None

    @property
    def bodies(self) -> tuple[str, ...]:
        """The fixtures that move with the carriage: itself, then what it carries."""
        return (self.carriage, *self.carries)

    def beyond_travel(self, place_m: float) -> str:
        """Return by how much a place is beyond the travel, empty if it is within."""
        lowest, highest = self.travel_m
        if lowest <= place_m <= highest:
            return ""
        over_m = lowest - place_m if place_m < lowest else place_m - highest
        travel = f"{1e3 * lowest:.1f} … {1e3 * highest:.1f} mm"
        return f"the carriage would be {1e3 * over_m:.1f} mm beyond its travel of {travel}"

    def direction(self, carriage: Pose) -> Vector3:
        """Return the direction of the rail in the world as a unit vector, for the pose of its carriage."""
        length = math.hypot(*self.along)
        x, y, z = rotate_vector(carriage.xyzw, self.along)
        return x / length, y / length, z / length
