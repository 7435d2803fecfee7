"""The question which unknown space an arm passes through, and its answer, as data that can cross a process boundary."""

from __future__ import annotations

import msgspec

from engine.messages import Vector3
from engine.messages.sensing import ObservedSpace
from robots.planning.scene.planning_scene import PlanningScene
from robots.port import JointTrajectory


class CoverRegion(msgspec.Struct, frozen=True, kw_only=True):
    """An axis-aligned box in the world that the cameras must see."""

    name: str
    center_m: Vector3
    size_m: Vector3


class SweptSpaceRequest(msgspec.Struct, frozen=True, kw_only=True, tag="ask_swept_space"):
    """Asks which unknown space an arm with its attached parts passes through along `trajectory`.

    With `regions` only space inside one of them counts. Space within `near_m` of the arm at the start is known: the
    arm is there.
    """

    scene: PlanningScene
    arm: str
    trajectory: JointTrajectory
    observed: ObservedSpace
    regions: tuple[CoverRegion, ...] = ()
    near_m: float = 0.04


class SweptSpace(msgspec.Struct, frozen=True, kw_only=True, tag="swept_space"):
    """The unknown space that an arm passes through; all else is meaningless where `unknown_m3` is 0.

    `first_m` is the centre of the first unknown voxel, reached after `at_s` of the trajectory's own time, the last
    one after `last_s`; `age_s` is the time since it was last seen, None for never. `low_m` and `high_m` bound all
    unknown voxels of the motion.
    """

    unknown_m3: float
    first_m: Vector3 = (0.0, 0.0, 0.0)
    at_s: float = 0.0
    last_s: float = 0.0
    age_s: float | None = None
    low_m: Vector3 = (0.0, 0.0, 0.0)
    high_m: Vector3 = (0.0, 0.0, 0.0)
    regions: tuple[str, ...] = ()
