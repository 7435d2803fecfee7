"""The planning scene of a cell, served under `cell`: obstacles, held parts and allowed contacts.

It includes fixtures and parts of the cell document; parts at their last measured pose.
Names are those of obstacles and parts, and `<arm>/<link>`; an arm's name stands for all its links.
"""

from __future__ import annotations

from engine.messages import Message, Pose
from engine.messages.shapes import AT_ORIGIN, Obstacle, Solid
from engine.skill import Service

FARTHEST_M = 1000.0
"""The distance when there is no obstacle: JSON has no infinity."""

CONTACT_M = 0.005
"""Allowed penetration of a part into the surface it is put down on, and the length at the end of the path.

Measured poses, slip in a hand and stacked parts are accurate to about this distance.
"""


class HeldPart(Message, frozen=True, kw_only=True):
    """A part attached to a link of an arm, at `pose` in the frame of that link."""

    name: str
    robot: str
    link: str
    solids: tuple[Solid, ...]
    pose: Pose = AT_ORIGIN


class PlanningSceneState(Message, frozen=True, kw_only=True):
    """The planning scene, also the latest value of `cell/planning_scene`; `revision` increases with every change.

    `allowed` are the pairs of names that may touch.
    """

    revision: int
    obstacles: tuple[Obstacle, ...]
    held: tuple[HeldPart, ...]
    allowed: tuple[tuple[str, str], ...]


class ReadPlanningScene(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Return the planning scene."""


class PutObstacle(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Add an obstacle to the scene, or replace the one of the same name."""

    obstacle: Obstacle


class RemoveObstacle(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Remove an obstacle; removing it again is not an error, a name that never was an obstacle is."""

    name: str


class AllowContact(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Allow or forbid the contact of two objects, by name."""

    first: str
    second: str
    allowed: bool = True


class AttachPart(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Attach a part of the scene to an arm at its present pose relative to the tool.

    It may touch the tool that holds it, and the objects that it touches at that moment, such as the table that
    it is lifted from, until they are 1 cm apart. A part held by another arm is handed over.
    """

    part: str
    robot: str
    link: str = ""
    """Empty for the tool link."""


class DetachPart(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Detach a part: it stays in the scene at its present pose. A part that is not held is not an error.

    The adjacent links, such as the fingers, may touch it until they are 1 cm apart.
    """

    part: str


class ForgetOccupancy(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Clear the occupancy from the cameras; objects that are still present are measured again."""


class TouchingPair(Message, frozen=True, kw_only=True):
    """Two touching objects, by name, and their penetration depth in metres."""

    first: str
    second: str
    depth_m: float = 0.0


class CollisionReport(Message, frozen=True, kw_only=True):
    """The contacts of an arm in a configuration, and its smallest distance from objects that it must not touch.

    `nearest` are the two objects at that distance, `FARTHEST_M` at most; both empty in an empty scene.
    """

    touching: tuple[TouchingPair, ...]
    distance_m: float
    nearest: tuple[str, str]


class CheckCollision(Service[CollisionReport], frozen=True, kw_only=True):
    """Return the contacts of an arm at `joints` (radians), the measured configuration when empty.

    With `openings_m` the fingers of its gripper are at each of these openings in turn, instead of where they are: it
    reports all contacts, each at its deepest. Openings that are not possible count as the nearest possible one.
    """

    robot: str
    joints: tuple[float, ...] = ()
    openings_m: tuple[float, ...] = ()
