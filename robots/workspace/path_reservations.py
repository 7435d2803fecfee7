"""Reserved paths of moving arms, which motions planned later avoid."""

from __future__ import annotations

import re

import msgspec

from robots.planning.scene.planning_scene import OCCUPANCY, AttachedPart, NamePair, PlanningScene, SceneArm

_AHEAD = re.compile(r"~\d+")
_OCCUPANCY = re.compile(rf"\b{OCCUPANCY}\b")

Row = tuple[float, ...]


def with_reservations(scene: PlanningScene, claims: dict[str, tuple[Row, ...]]) -> PlanningScene:
    """Return the scene with arms also at their reserved configurations: `claims` are those (radians, n) by arm.

    The arm at the k-th of them is named `<arm>~k`; the parts that it holds get the same suffix.
    """
    arms: list[SceneArm] = list(scene.arms)
    attached: list[AttachedPart] = list(scene.attached)
    allowed: list[NamePair] = list(scene.allowed)
    for name, rows in claims.items():
        arm = scene.arm(name)
        held = [part for part in scene.attached if part.arm == name]
        rules = [pair for pair in scene.allowed if _is_of(pair[0], name) or _is_of(pair[1], name)]
        for k, row in enumerate(rows):
            later = f"{name}~{k}"
            placement = msgspec.structs.replace(arm.placement, name=later)
            arms.append(SceneArm(placement=placement, joints_rad=row, tool_joints=arm.tool_joints))
            attached += [msgspec.structs.replace(part, name=f"{part.name}~{k}", arm=later) for part in held]
            allowed += [(_rename(a, name, later), _rename(b, name, later)) for a, b in rules]
    return msgspec.structs.replace(scene, arms=tuple(arms), attached=tuple(attached), allowed=tuple(allowed))


def describe_names(text: str) -> str:
    """Return a text with readable names: `<arm> on its planned path` for a reservation, and a text for occupancy."""
    described = _OCCUPANCY.sub("an obstacle seen by the cameras", text)
    return described if _AHEAD.search(described) is None else f"{_AHEAD.sub('', described)} on its planned path"


def is_reserved(name: str) -> bool:
    """Return whether a name in such a scene is that of an arm, or of a part that it holds, on its reserved path."""
    return _AHEAD.search(name) is not None


def _is_of(rule: str, arm: str) -> bool:
    return rule == arm or rule.startswith(arm + "/")


def _rename(rule: str, arm: str, later: str) -> str:
    return later + rule[len(arm) :] if _is_of(rule, arm) else rule
