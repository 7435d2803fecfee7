"""Linear units of a cell on the bus, each under the name of its device: where its carriage is, and how its robot pulls.

The robot on the carriage holds an anchor and pulls its own base along while the brakes are released; the brakes are
positions of the device.
"""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.messages import Message, Pose, Vector3
from engine.skill import Service

UnitPlace = Annotated[str, Meta(description="Name of one of its places; empty for a place in metres")]
PlaceMetres = Annotated[
    float, Meta(description="Place along the rail, without a name", extra_json_schema={"unit": "m"})
]


class LinearUnitReading(Message, frozen=True, kw_only=True):
    """Where the carriage is shown, what its scale says, None without one, and where the asked place is, in metres.

    `base` is where the base of its robot is known to stand in the world. A simulation shows where the carriage is.
    """

    place_m: float
    scale_m: float | None = None
    target_m: float
    base: Pose


class ReadLinearUnit(Service[LinearUnitReading], frozen=True, kw_only=True):
    """Return where the carriage is, beside a place; fails for a name that it does not have."""

    place: UnitPlace = ""
    place_m: PlaceMetres = 0.0


class BasePull(Message, frozen=True, kw_only=True):
    """How a robot that holds an anchor pulls its base to a place.

    `refused` says why not, and by how much; empty if it may. `start` and `goal` are the poses of its tool centre point
    before and after, in the frame of its base, which their `frame` names; `along` is the direction of the rail in it.
    `released` and `locked` are the positions of the device for its brakes.
    """

    refused: str = ""
    robot: str
    anchor: str = ""
    start_m: float
    goal_m: float
    start: Pose
    goal: Pose
    along: Vector3
    carried_kg: float
    has_scale: bool
    released: str
    locked: str


class PlanBasePull(Service[BasePull], frozen=True, kw_only=True):
    """Return how the robot, whose tool centre point in the world is given, pulls its base to a place.

    It is refused where the place is beyond the travel, or the tool centre point is at no anchor.
    Fails for a name that the unit does not have.
    """

    place: UnitPlace = ""
    place_m: PlaceMetres = 0.0
    tool: Pose
