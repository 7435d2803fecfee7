"""Exact proximity of a part: the objects that may touch it just after it was grasped, and just after its release."""

from __future__ import annotations

from collections.abc import Collection

import msgspec
import numpy as np

from robots.planning.scene.planning_scene import PlanningScene

TOUCHING_M = 0.005
"""Objects that rest on one another penetrate, or float, by less than this in the physics simulation."""

SEPARATED_M = 0.01
"""From this distance on, two objects that touched count as separated."""


def names_near_held_part(
    scene: PlanningScene, part: str, *, within_m: float, among: Collection[str] | None = None
) -> frozenset[str]:
    """Return the names of obstacles and other arms' links within `within_m` of a held part.

    The arm has the joints of the scene. With `among`, only these names are checked.
    """
    held = next(one for one in scene.attached if one.name == part)
    arm = scene.arm(held.arm)
    names = set(among) if among is not None else None
    reduced = msgspec.structs.replace(
        scene,
        arms=tuple(one for one in scene.arms if one.name == arm.name or names is None or _has_link_of(one.name, names)),
        obstacles=tuple(o for o in scene.obstacles if names is None or o.name in names),
        attached=(held,),
        allowed=(),
    )
    return _names_within(reduced, arm.name, arm.joints_rad, part, within_m)


def links_near_part(scene: PlanningScene, part: str, arm: str, *, within_m: float) -> frozenset[str]:
    """Return the links of an arm, as `arm/link`, within `within_m` of a part that is not held."""
    reduced = msgspec.structs.replace(
        scene,
        arms=(scene.arm(arm),),
        obstacles=tuple(o for o in scene.obstacles if o.name == part),
        attached=(),
        allowed=(),
    )
    return _names_within(reduced, arm, scene.arm(arm).joints_rad, part, within_m)


def _names_within(
    scene: PlanningScene, arm: str, joints_rad: tuple[float, ...], part: str, within_m: float
) -> frozenset[str]:
    # Only grasp and release need Coal, which takes a quarter of a second to load.
    from robots.planning.scene.exact_checker import ExactChecker

    checker = ExactChecker(scene, arm, margin_m=within_m)
    joints = np.array(joints_rad or checker.model.home_rad)
    pairs = checker.colliding_pairs(joints)
    return frozenset(b if a == part else a for a, b in pairs if part in (a, b))


def _has_link_of(arm: str, names: Collection[str]) -> bool:
    return any(name.startswith(f"{arm}/") for name in names)
