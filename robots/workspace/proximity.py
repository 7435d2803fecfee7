"""What a part is near to, exactly: who may touch it just after it was gripped, and just after it was let go."""

from __future__ import annotations

from collections.abc import Collection

import msgspec
import numpy as np

from robots.planning.scene.planning_scene import PlanningScene

TOUCHING_M = 0.005
"""Physics lets what lies on one another sink in, or float, by less than this."""

SEPARATED_M = 0.01
"""From here on two things that touched have parted."""


def names_near_held_part(
    scene: PlanningScene, part: str, *, within_m: float, among: Collection[str] | None = None
) -> frozenset[str]:
    """Return what a part in a hand is within `within_m` of: obstacles and other arms' links, by name.

    The arm stands where the scene says. With `among`, only these names are looked at.
    """
    held = next(one for one in scene.attached if one.name == part)
    arm = scene.arm(held.arm)
    wanted = set(among) if among is not None else None
    reduced = msgspec.structs.replace(
        scene,
        arms=tuple(one for one in scene.arms if one.name == arm.name or wanted is None or _has(one.name, wanted)),
        obstacles=tuple(o for o in scene.obstacles if wanted is None or o.name in wanted),
        attached=(held,),
        allowed=(),
    )
    return _near(reduced, arm.name, arm.joints_rad, part, within_m)


def links_near_part(scene: PlanningScene, part: str, arm: str, *, within_m: float) -> frozenset[str]:
    """Return which links of an arm, as `arm/link`, are within `within_m` of a part that nobody holds."""
    reduced = msgspec.structs.replace(
        scene,
        arms=(scene.arm(arm),),
        obstacles=tuple(o for o in scene.obstacles if o.name == part),
        attached=(),
        allowed=(),
    )
    return _near(reduced, arm, scene.arm(arm).joints_rad, part, within_m)


def _near(scene: PlanningScene, arm: str, joints_rad: tuple[float, ...], part: str, within_m: float) -> frozenset[str]:
    # Only who grips and lets go needs coal, which takes a quarter of a second to load.
    from robots.planning.scene.exact_checker import ExactChecker

    checker = ExactChecker(scene, arm, margin_m=within_m)
    joints = np.array(joints_rad if joints_rad else checker.model.home_rad)
    pairs = checker.colliding_pairs(joints)
    return frozenset(b if a == part else a for a, b in pairs if part in (a, b))


def _has(arm: str, names: Collection[str]) -> bool:
    return any(name.startswith(f"{arm}/") for name in names)
