"""A block, and an arm that can do everything that picking and placing asks for."""

from __future__ import annotations

from typing import Any

import msgspec

from engine.errors import Cause
from engine.messages import GripperState, HandState, PartPoses, Pose
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.gripper import GraspResult
from engine.skills.hand import HandResult
from engine.skills.motion import (
    CartLinTask,
    CartMotionResult,
    InverseKinematics,
    InverseKinematicsResult,
    InverseKinematicsSolutions,
)
from engine.skills.planning import FreeMotionResult
from engine.skills.planning_scene import CollisionReport, PlanningSceneState, TouchingPair
from robots.magnet.magnet_skills import MagnetResult, MagnetState
from tests.states.fake_context import FakeContext

DOWN = (1.0, 0.0, 0.0, 0.0)
HERE = Pose(xyz=(0.4, 0.0, 0.6), xyzw=DOWN)
SCENE = PlanningSceneState(revision=1, obstacles=(), held=(), allowed=())
WENT = FreeMotionResult(joints=(0.0,), duration_s=1.0, stops=0, replans=0, reused=0, waited_s=0.0)
STOOD = msgspec.structs.replace(WENT, blocked="occupancy")
CLEAR = CollisionReport(touching=(), distance_m=0.1, nearest=("", ""))
AT_PART = CollisionReport(
    touching=(TouchingPair(first="arm/finger", second="block"),), distance_m=0.0, nearest=("", "")
)
AT_CRATE = CollisionReport(
    touching=(TouchingPair(first="arm/finger", second="crate"),), distance_m=0.0, nearest=("", "")
)
IN_THE_WAY = Cause(
    message="the path is not free",
    where="arm/cart_lin_task",
    kind="GoalRejected",
    because=Cause(message="block would touch crate after 60% of the way", where="arm", kind="PathBlocked"),
)
LIMIT = Cause(message="joint 4 would exceed its limit", where="arm/cart_lin_task", kind="GoalRejected")


def touching(first: str, second: str, depth_m: float) -> CollisionReport:
    return CollisionReport(
        touching=(TouchingPair(first=first, second=second, depth_m=depth_m),),
        distance_m=-depth_m,
        nearest=(first, second),
    )


def done(result: object) -> GoalEnd[object]:
    return GoalEnd(GoalStatus.SUCCEEDED, result, None)


def held(found: bool, reason: str = "") -> GoalEnd[object]:
    return done(GraspResult(held=found, width_m=0.05, force_n=20.0, reason=reason))


def near(joint_rad: float) -> InverseKinematicsResult:
    return InverseKinematicsResult(joints=(joint_rad,), dexterity=0.1, manipulability=0.1, singular=False)


def cell(**changed: Any) -> FakeContext:
    """A block on a table and an arm that can do everything; `changed` by the last word of an address."""
    answers: dict[str, Any] = {
        "arm/gripper/gripper_open": done(GraspResult(held=False, width_m=0.08, force_n=0.0)),
        "arm/gripper/gripper_grasp": held(found=True),
        "arm/gripper/read_gripper": GripperState(time_s=0.0, width_m=0.05, force_n=20.0, held=True),
        "arm/magnet/magnet_switch": done(MagnetResult(on=True, held=False, pull_n=0.0)),
        "arm/magnet/read_magnet": MagnetState(time_s=0.0, on=True, pull_n=100.0, held=True),
        "arm/hand/hand_open": done(HandResult(held=False, closed_percent=0.0, force_n=0.0)),
        "arm/hand/hand_close": done(HandResult(held=True, closed_percent=70.0, force_n=10.0)),
        "arm/hand/read_hand": HandState(time_s=0.0, closed_percent=70.0, force_n=10.0, held=True),
        "arm/move_free": done(WENT),
        "arm/all_inverse_kinematics": InverseKinematicsSolutions(solutions=((0.3,),), complete=True, how="by hand"),
        "arm/inverse_kinematics": near(0.4),
        "arm/forward_kinematics": HERE,
        "arm/cart_lin_task": done(CartMotionResult(pose=HERE, duration_s=1.0)),
        "arm/set_load": SCENE,
        "cell/check_collision": CLEAR,
        "cell/attach_part": SCENE,
        "cell/detach_part": SCENE,
    }
    answers = {address: changed.get(address.rpartition("/")[2], answer) for address, answer in answers.items()}
    parts = PartPoses(time_s=0.0, poses={"block": Pose(xyz=(0.5, 0.1, 0.2))})
    return FakeContext(answers, topics={"cell/parts": parts})


def asked(ctx: FakeContext) -> list[str]:
    """What was asked, in order, without the questions of kinematics."""
    return [address for address, _ in ctx.sent if not address.endswith("kinematics")]


def lines(ctx: FakeContext) -> list[tuple[float, ...]]:
    """Where the tool was sent on straight ways, in order."""
    return [rounded(goal.pose) for _, goal in ctx.sent if isinstance(goal, CartLinTask)]


def beside(ctx: FakeContext) -> list[tuple[float, ...]]:
    """Where else than at the pose itself a configuration was asked for: in front, and where it goes on to."""
    return [rounded(goal.pose) for _, goal in ctx.sent if isinstance(goal, InverseKinematics)]


def rounded(pose: Pose) -> tuple[float, ...]:
    """The position, without the noise of the last digits."""
    return tuple(round(value, 9) for value in pose.xyz)
