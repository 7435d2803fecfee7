"""What is known to be in the cell: the arms where they are, obstacles, parts lying and held, as balls and solids."""

from __future__ import annotations

import msgspec

from engine.messages import Pose
from engine.messages.shapes import Obstacle
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene


class KnownGeometry(msgspec.Struct, frozen=True, kw_only=True):
    """The obstacles of a planning scene, and what arms hold in it."""

    obstacles: tuple[Obstacle, ...] = ()
    held: tuple[AttachedPart, ...] = ()

    @classmethod
    def of(cls, scene: PlanningScene) -> KnownGeometry:
        """Return what of a planning scene the map leaves out, besides the arms."""
        return cls(obstacles=scene.obstacles, held=scene.attached)


class ArmConfiguration(msgspec.Struct, frozen=True, kw_only=True):
    """Where the joints of an arm and of its tool were at an instant, radians or metres."""

    joints: tuple[float, ...]
    tool_joints: dict[str, float] = {}


class MeasuredState(msgspec.Struct, frozen=True, kw_only=True):
    """What was where when images were taken: arms by name, and the parts whose poses in the world were measured."""

    time_s: float
    arms: dict[str, ArmConfiguration] = {}
    parts: dict[str, Pose] = {}
