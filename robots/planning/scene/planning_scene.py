"""The planning scene as plain data: arms with their joints, obstacles, attached parts, allowed collisions.

A scene is immutable: `with_…` and `without_…` return a new one. It can cross a process boundary by
msgspec. Objects are named `obstacle`, `part` or `arm/link`, the occupancy of the cameras `occupancy`. Poses of
obstacles are in the world frame.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from engine.errors import CellError
from engine.messages import Pose
from engine.messages.shapes import AT_ORIGIN, Obstacle, Solid
from engine.wording import did_you_mean
from robots.scene.sim_scene import ArmPlacement

NamePair = tuple[str, str]

OCCUPANCY = "occupancy"
"""Name of the occupancy map, the unknown objects seen by cameras, in pairs of names."""


class AttachedPart(msgspec.Struct, frozen=True, kw_only=True):
    """A part that moves with a link of an arm, at `pose` in the frame of that link.

    An empty `link` means the tool link. Links that move with that link, such as the tool, may
    touch the part; other links and obstacles only if the scene allows it.
    """

    name: str
    arm: str
    solids: tuple[Solid, ...]
    pose: Pose = AT_ORIGIN
    link: str = ""


class SceneArm(msgspec.Struct, frozen=True, kw_only=True):
    """An arm in the scene: its model and base pose, its joints and its tool's joints.

    `joints_rad` is used when another arm is planned for; empty means home. Tool joints that are
    not named are at 0.
    """

    placement: ArmPlacement
    joints_rad: tuple[float, ...] = ()
    tool_joints: tuple[tuple[str, float], ...] = ()

    @property
    def name(self) -> str:
        """The arm's name in the cell."""
        return self.placement.name


class PlanningScene(msgspec.Struct, frozen=True, kw_only=True):
    """The objects that a motion must not touch, and `allowed`, the pairs of names that may touch."""

    arms: tuple[SceneArm, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()
    attached: tuple[AttachedPart, ...] = ()
    allowed: tuple[NamePair, ...] = ()

    def arm(self, name: str) -> SceneArm:
        """Return an arm by name; raises CellError for an unknown name."""
        for arm in self.arms:
            if arm.name == name:
                return arm
        raise _unknown("arm", name, [arm.name for arm in self.arms])

    def with_obstacles(self, *obstacles: Obstacle) -> PlanningScene:
        """Return the scene with these obstacles; each replaces one with the same name.

        Raises:
            CellError: the name is that of an arm, of an attached part or of the occupancy.
        """
        for obstacle in obstacles:
            if obstacle.name in {part.name for part in self.attached} | {arm.name for arm in self.arms} | {OCCUPANCY}:
                raise CellError(f"{obstacle.name} is already in the scene", hint="give the obstacle another name")
        new = {obstacle.name: obstacle for obstacle in (*self.obstacles, *obstacles)}
        return msgspec.structs.replace(self, obstacles=tuple(new.values()))

    def with_joints(
        self, arm: str, joints_rad: Sequence[float], *, tool_joints: dict[str, float] | None = None
    ) -> PlanningScene:
        """Return the scene with an arm at these joints; its tool's joints stay unless given.

        Raises:
            CellError: there is no such arm.
        """
        old = self.arm(arm)
        tool = old.tool_joints if tool_joints is None else tuple(sorted(tool_joints.items()))
        new = msgspec.structs.replace(old, joints_rad=tuple(float(q) for q in joints_rad), tool_joints=tool)
        return msgspec.structs.replace(self, arms=tuple(new if a.name == arm else a for a in self.arms))

    def with_attached(self, part: AttachedPart) -> PlanningScene:
        """Return the scene with an attached part, in place of an obstacle with that name.

        Raises:
            CellError: there is no such arm, or the name is already in use.
        """
        self.arm(part.arm)
        if part.name in {held.name for held in self.attached} | {arm.name for arm in self.arms}:
            raise CellError(f"{part.name} is already in the scene", hint="detach it first")
        kept = tuple(obstacle for obstacle in self.obstacles if obstacle.name != part.name)
        return msgspec.structs.replace(self, obstacles=kept, attached=(*self.attached, part))

    def with_allowed(self, first: str, second: str) -> PlanningScene:
        """Return the scene in which two objects, by name, may touch."""
        if _same(first, second) in {_same(*pair) for pair in self.allowed}:
            return self
        return msgspec.structs.replace(self, allowed=(*self.allowed, (first, second)))

    def may_touch(self, first: str, second: str) -> bool:
        """Return whether a pair of names may touch; an arm's name stands for all its links."""
        for a, b in self.allowed:
            if (_matches(a, first) and _matches(b, second)) or (_matches(a, second) and _matches(b, first)):
                return True
        return False


def _matches(rule: str, name: str) -> bool:
    return name == rule or name.startswith(rule + "/")


def _same(first: str, second: str) -> frozenset[str]:
    return frozenset((first, second))


def _unknown(what: str, name: str, known: list[str]) -> CellError:
    return CellError(f"no {what} in the planning scene is called {name}", where=name, hint=did_you_mean(name, known))
