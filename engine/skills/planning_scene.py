"""The planning scene of a cell, answered under `cell`: what arms must not touch, what they hold, what may touch.

Fixtures and parts of the cell document are in it by themselves; parts where they were last seen.
Names are those of obstacles and parts, and `<arm>/<link>`; an arm's name stands for all its links.
"""

from __future__ import annotations

from engine.messages import Message, Pose
from engine.messages.shapes import AT_ORIGIN, Obstacle, Solid
from engine.skill import Service

FARTHEST_M = 1000.0
"""The distance of what is not there: infinity could not be written down."""

CONTACT_M = 0.005
"""How deep a part may come to be in what it is put down on, and over how much of the end of its way.

Measured poses, slip in a hand and parts that lie on one another are exact to about this.
"""


class HeldPart(Message, frozen=True, kw_only=True):
    """A part that moves along with a link of an arm, at `pose` in the frame of that link."""

    name: str
    robot: str
    link: str
    solids: tuple[Solid, ...]
    pose: Pose = AT_ORIGIN


class PlanningSceneState(Message, frozen=True, kw_only=True):
    """The planning scene now, also the latest value of `cell/planning_scene`; `revision` rises with every change.

    `allowed` are the pairs of names that may touch.
    """

    revision: int
    obstacles: tuple[Obstacle, ...]
    held: tuple[HeldPart, ...]
    allowed: tuple[tuple[str, str], ...]


class ReadPlanningScene(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Return the planning scene."""


class PutObstacle(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Put an obstacle into the scene, or another one in the place of that of the same name."""

    obstacle: Obstacle


class RemoveObstacle(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Take an obstacle out of the scene; one that is not there is no error, a name that never was one is."""

    name: str


class AllowContact(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Say whether two things, by name, may touch."""

    first: str
    second: str
    allowed: bool = True


class AttachPart(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Let a part of the scene move with an arm from now on, from where it is relative to the tool.

    It may touch the tool that holds it, and what it touches at that moment, as the table that a part is lifted
    from, until they have parted by 1 cm. One that another arm held goes over.
    """

    part: str
    robot: str
    link: str = ""
    """The tool link where it is empty."""


class DetachPart(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Let go of a part: it stays in the scene where it is. One that nobody holds is no error.

    The links that are beside it then, as the fingers, may touch it until they have parted by 1 cm.
    """

    part: str


class ForgetOccupancy(Service[PlanningSceneState], frozen=True, kw_only=True):
    """Forget what the cameras have seen; what is still there is seen again."""


class TouchingPair(Message, frozen=True, kw_only=True):
    """Two things that touch, by name, and how deep they are in one another: the shortest way apart, in metres."""

    first: str
    second: str
    depth_m: float = 0.0


class CollisionReport(Message, frozen=True, kw_only=True):
    """What an arm touches in a configuration, and the smallest distance of what it must not touch.

    `nearest` are the two things at that distance, `FARTHEST_M` at most; both empty in an empty scene.
    """

    touching: tuple[TouchingPair, ...]
    distance_m: float
    nearest: tuple[str, str]


class CheckCollision(Service[CollisionReport], frozen=True, kw_only=True):
    """Return what an arm would touch at `joints` (radians), the measured ones where empty."""

    robot: str
    joints: tuple[float, ...] = ()
