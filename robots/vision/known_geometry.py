"""The known geometry of a cell: arms, obstacles, free and held parts, as balls and solids."""

from __future__ import annotations

import msgspec

from engine.messages import Pose
from engine.messages.shapes import Obstacle
from robots.planning.scene.planning_scene import AttachedPart, PlanningScene


class KnownGeometry(msgspec.Struct, frozen=True, kw_only=True, tag="known"):
    """The obstacles and held parts of a planning scene."""

    obstacles: tuple[Obstacle, ...] = ()
    held: tuple[AttachedPart, ...] = ()

    @classmethod
    def of(cls, scene: PlanningScene) -> KnownGeometry:
        """Return the geometry of a planning scene that the map excludes, besides the arms."""
        return cls(obstacles=scene.obstacles, held=scene.attached)


class ArmConfiguration(msgspec.Struct, frozen=True, kw_only=True):
    """Joint positions of an arm and its tool at an instant, radians or metres."""

    joints: tuple[float, ...]
    tool_joints: dict[str, float] = {}


class MeasuredState(msgspec.Struct, frozen=True, kw_only=True):
    """The state of a cell when images were taken: arms by name, and the measured poses of parts in the world."""

    time_s: float
    arms: dict[str, ArmConfiguration] = {}
    parts: dict[str, Pose] = {}
