"""Infers the roles of taught steps from their order, names and poses."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from engine.errors import SkillFailed
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import rotate_vector
from engine.skills.proposing import Role, TaughtStep

PLACES = ("joints", "pose")
MOTIONS = ("trajectory", "dmp", "cart_dmp")
_GRASPS = {"pick", "grasp", "grip", "take", "fetch", "get"}
_RELEASES = {"place", "release", "drop", "put", "lay"}
_IN_FRONT = {"above", "over", "before", "approach", "pre", "near", "front", "prepick", "preplace"}
_NEAR_M = 0.4
"""Maximum distance of an approach pose from its grasp."""
_BESIDE_M = 0.05
"""Maximum distance of an approach pose from the axis of the tool."""
PART_NEAR_M = 0.15
_FITTING: Mapping[str, tuple[Role, ...]] = {
    **dict.fromkeys(PLACES, ("via", "approach", "grasp", "release", "depart")),
    **dict.fromkeys(MOTIONS, ("follow",)),
    "gripper": ("open", "close"),
    "action": ("open", "close"),
}


@dataclass(frozen=True)
class ObservedStep:
    """A step with its data: the pose of the tool in the world, and the state of the gripper.

    `frame` is the one that a pose is given in.
    """

    step: TaughtStep
    tool: Pose | None = None
    frame: str = "world"
    held: bool = False
    width_m: float = 0.0
    force_n: float = 0.0

    @property
    def role(self) -> Role:
        """The role of the step, once it is inferred."""
        assert self.step.role is not None
        return self.step.role

    def with_role(self, role: Role) -> ObservedStep:
        """Return the step with a role."""
        return replace(self, step=TaughtStep(kind=self.step.kind, name=self.step.name, role=role, part=self.step.part))


def assign_step_roles(steps: Sequence[ObservedStep]) -> tuple[ObservedStep, ...]:
    """Return the steps with a role each; those that have one keep it.

    Raises:
        SkillFailed: a role does not fit its entry.
    """
    found = [_alone(taught) for taught in steps]
    for index, taught in enumerate(found):
        if taught.step.role not in (None, *_FITTING[taught.step.kind]):
            raise SkillFailed(
                f"{taught.step.kind} {taught.step.name} cannot be `{taught.step.role}`",
                where=f"step {index + 1}",
                hint=f"it can be {', '.join(_FITTING[taught.step.kind])}",
            )
    _by_the_tool(found)
    if not any(taught.step.kind in ("gripper", "action") for taught in found):
        found = [_by_name(taught) for taught in found]
    _around(found)
    return tuple(taught if taught.step.role else taught.with_role("via") for taught in found)


def guess_part(taught: ObservedStep, parts: Mapping[str, Vector3 | None]) -> str:
    """Return the part that is grasped at a pose: the nearest, or the only one; empty if unknown."""
    tool = taught.tool
    if tool is not None:
        placed = {name: math.dist(xyz, tool.xyz) for name, xyz in parts.items() if xyz is not None}
        nearest = min(placed, key=lambda name: placed[name], default="")
        if nearest and placed[nearest] <= PART_NEAR_M:
            return nearest
    return next(iter(parts)) if len(parts) == 1 else ""


def _alone(taught: ObservedStep) -> ObservedStep:
    """Assign roles that do not depend on neighbouring steps."""
    step = taught.step
    if step.role is not None:
        return taught
    if step.kind in MOTIONS:
        return taught.with_role("follow")
    if step.kind == "gripper":
        return taught.with_role("close" if taught.held else "open")
    if step.kind == "action":
        if step.name not in ("open", "close"):
            raise SkillFailed(f"there is no action {step.name!r}", where="teach", hint="`open` or `close`")
        return taught.with_role("open" if step.name == "open" else "close")
    return taught


def _by_the_tool(found: list[ObservedStep]) -> None:
    """Assign grasp to poses at which the tool closes, release to poses at which it opens with a part."""
    holds = False
    for index, taught in enumerate(found):
        after = found[index + 1].step if index + 1 < len(found) else None
        if taught.step.role is None and after is not None:
            if after.role == "close":
                found[index] = taught.with_role("grasp")
            elif after.role == "open" and holds:
                found[index] = taught.with_role("release")
        role = found[index].step.role
        holds = role in ("grasp", "close") or (holds and role not in ("release", "open"))


def _by_name(taught: ObservedStep) -> ObservedStep:
    words = _words(taught.step.name)
    if taught.step.role is not None or words & _IN_FRONT:
        return taught
    if words & _GRASPS:
        return taught.with_role("grasp")
    return taught.with_role("release") if words & _RELEASES else taught


def _around(found: list[ObservedStep]) -> None:
    """Assign approach to a pose in front of the next grasp or release, and depart to one after it."""
    for index, taught in enumerate(found):
        if taught.step.role not in ("grasp", "release"):
            continue
        if index > 0 and found[index - 1].step.role is None and _is_in_front(found[index - 1], taught):
            found[index - 1] = found[index - 1].with_role("approach")
        after = index + 1
        while after < len(found) and found[after].step.role in ("open", "close"):
            after += 1
        if after < len(found) and found[after].step.role is None and _is_in_front(found[after], taught):
            # It may be the approach of the next one instead, which is then nearer.
            following = found[after + 1] if after + 1 < len(found) else None
            if following is None or following.step.role not in ("grasp", "release"):
                found[after] = found[after].with_role("depart")


def _is_in_front(place: ObservedStep, of: ObservedStep) -> bool:
    if place.step.kind not in PLACES or place.step.name == of.step.name:
        return False
    if place.tool is None or of.tool is None:
        return bool(_words(place.step.name) & _IN_FRONT)
    x, y, z = (a - b for a, b in zip(place.tool.xyz, of.tool.xyz, strict=True))
    out = rotate_vector(of.tool.xyzw, (0.0, 0.0, -1.0))
    ahead = x * out[0] + y * out[1] + z * out[2]
    beside = math.sqrt(max(0.0, x * x + y * y + z * z - ahead * ahead))
    return 0.0 < ahead <= _NEAR_M and beside <= _BESIDE_M


def _words(name: str) -> set[str]:
    return set(re.split(r"[_/.\-0-9]+", name))
