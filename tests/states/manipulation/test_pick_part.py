"""Picking a part: the order of the steps, the poses of the tool, and each failure outcome."""

from __future__ import annotations

import math

import msgspec
import pytest

from engine.errors import SkillFailed
from engine.messages import GripperState, PartPoses, Pose
from engine.skills.arm_control import SetLoad
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.gripper import GripperGrasp
from engine.skills.motion import AllInverseKinematics, InverseKinematics, InverseKinematicsSolutions
from engine.skills.planning import MotionTarget, MoveFree
from engine.skills.planning_scene import AttachPart
from engine.state import Outcome
from robots.magnet.magnet_skills import MagnetResult
from states.manipulation.pick_part import GraspTarget, PickPart
from tests.states.fake_context import FakeContext, broken_off
from tests.states.manipulation.picking_cell import (
    AT_CRATE,
    AT_PART,
    CLEAR,
    DOWN,
    HERE,
    IN_THE_WAY,
    LIMIT,
    STOOD,
    WENT,
    asked,
    beside,
    cell,
    done,
    held,
    lines,
    near,
)

PICK = PickPart(robot="arm", part="block", width_m=0.05)


async def test_the_part_is_approached_gripped_attached_and_lifted_in_this_order() -> None:
    ctx = cell(check_collision=AT_PART)
    assert await PICK.run(ctx) == Outcome("picked")
    assert asked(ctx) == [
        "arm/gripper/gripper_open",
        "cell/check_collision",
        "arm/move_free",
        "arm/cart_lin_task",
        "arm/gripper/gripper_grasp",
        "cell/attach_part",
        "arm/cart_lin_task",
        "arm/gripper/read_gripper",
    ]
    assert beside(ctx) == [(0.5, 0.1, 0.3)]
    assert lines(ctx) == [(0.5, 0.1, 0.2), (0.5, 0.1, 0.3)]
    assert [goal.target for _, goal in ctx.sent if isinstance(goal, MoveFree)] == [MotionTarget(joints=(0.4,))]
    assert ("cell/attach_part", AttachPart(part="block", robot="arm")) in ctx.sent
    assert ("arm/gripper/gripper_grasp", GripperGrasp(width_m=0.05, force_n=20.0)) in ctx.sent


async def test_the_tool_comes_from_where_the_behavior_says_in_the_frame_of_the_part() -> None:
    """The block is turned by a quarter about z: its x axis is the world's y."""
    quarter = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    ctx = cell()
    ctx = FakeContext(
        ctx.answers,
        topics={"cell/parts": PartPoses(time_s=0.0, poses={"block": Pose(xyz=(0.5, 0.1, 0.2), xyzw=quarter)})},
    )
    grasp = GraspTarget(xyz=(0.02, 0.0, 0.0), xyzw=DOWN, frame="part")
    state = PickPart(
        robot="arm", part="block", width_m=0.05, grasp=grasp, approach=(2.0, 0.0, 0.0), approach_m=0.2, lift_m=0.05
    )
    assert (await state.run(ctx)).name == "picked"
    assert beside(ctx) == [(0.5, 0.32, 0.2), (0.5, 0.12, 0.25)]
    assert lines(ctx) == [(0.5, 0.12, 0.2), (0.5, 0.12, 0.25)]


async def test_a_grasp_given_in_the_world_asks_for_no_part() -> None:
    """As the entries of a taught cell; the tool comes against its own z."""
    ctx = FakeContext(cell().answers)
    level = (0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5))
    state = PickPart(robot="arm", part="block", width_m=0.05, grasp=GraspTarget(xyz=(0.5, 0.0, 0.4), xyzw=level))
    assert (await state.run(ctx)).name == "picked"
    assert (beside(ctx)[0], lines(ctx)[0]) == ((0.4, 0.0, 0.4), (0.5, 0.0, 0.4))


async def test_the_nearest_of_equally_good_turns_is_tried_first_and_another_where_there_is_no_way() -> None:
    """The tool stands as the part does, turned by a half: of four turns that one is the nearest."""
    half = (0.0, 1.0, 0.0, 0.0)
    ends = [broken_off(GoalStatus.REJECTED, LIMIT), done(WENT)]
    ctx = cell(move_free=ends, forward_kinematics=Pose(xyz=HERE.xyz, xyzw=half))
    state = PickPart(robot="arm", part="block", width_m=0.05, turns=4)
    assert (await state.run(ctx)).name == "picked"
    tried = [goal.pose.xyzw for _, goal in ctx.sent if isinstance(goal, AllInverseKinematics)]
    assert tried[0] == pytest.approx((0.0, -1.0, 0.0, 0.0), abs=1e-9)
    assert abs(tried[1][0]) == pytest.approx(math.sqrt(0.5))


async def test_of_several_configurations_one_is_taken_in_which_the_straight_ways_need_no_other() -> None:
    """Of the three that reach the part the first one touches a crate and the second one would turn over on the way."""
    three = InverseKinematicsSolutions(solutions=((0.1,), (0.2,), (0.3,)), complete=True, how="by hand")
    asked_for = [near(2.9), near(2.9), near(0.4), near(0.2)]
    ctx = cell(all_inverse_kinematics=three, check_collision=[AT_CRATE, CLEAR, CLEAR], inverse_kinematics=asked_for)
    assert await PickPart(robot="arm", part="block", width_m=0.05, lift_m=0.2).run(ctx) == Outcome("picked")
    assert [goal.target for _, goal in ctx.sent if isinstance(goal, MoveFree)] == [MotionTarget(joints=(0.4,))]
    seeds = [goal.seed for _, goal in ctx.sent if isinstance(goal, InverseKinematics)]
    assert seeds == [(0.2,), (0.2,), (0.3,), (0.3,)]


async def test_a_configuration_from_which_the_line_is_refused_is_followed_by_the_next_one() -> None:
    two = InverseKinematicsSolutions(solutions=((0.1,), (0.3,)), complete=True, how="by hand")
    ends = [broken_off(GoalStatus.REJECTED, LIMIT), done(WENT), done(WENT)]
    assert await PICK.run(cell(all_inverse_kinematics=two, cart_lin_task=ends)) == Outcome("picked")


@pytest.mark.parametrize(("tool", "closes"), [("magnet", "arm/magnet/magnet_switch"), ("hand", "arm/hand/hand_close")])
async def test_every_kind_of_tool_takes_a_part(tool: str, closes: str) -> None:
    switched = [
        done(MagnetResult(on=False, held=False, pull_n=0.0)),
        done(MagnetResult(on=True, held=True, pull_n=100.0)),
    ]
    ctx = cell(magnet_switch=switched)
    state = msgspec.convert({"robot": "arm", "part": "block", "tool": tool}, PickPart)
    assert await state.run(ctx) == Outcome("picked")
    assert closes in asked(ctx)
    assert state.resources() == ("arm", f"arm/{tool}")


async def test_the_arm_gets_its_load_where_the_behavior_knows_it() -> None:
    ctx = cell()
    assert (await PickPart(robot="arm", part="block", width_m=0.05, mass_kg=1.5).run(ctx)).name == "picked"
    assert ("arm/set_load", SetLoad(mass_kg=1.5)) in ctx.sent


@pytest.mark.parametrize(
    ("changed", "outcome", "reason"),
    [
        ({"move_free": broken_off(GoalStatus.REJECTED, LIMIT)}, "unreachable", "joint 4 would exceed its limit"),
        ({"all_inverse_kinematics": SkillFailed("it is 0.3 m too far")}, "unreachable", "it is 0.3 m too far"),
        ({"inverse_kinematics": SkillFailed("over it it is too far")}, "unreachable", "over it it is too far"),
        ({"inverse_kinematics": near(2.9)}, "unreachable", "the straight line would turn a joint by 2.60 rad"),
        ({"cart_lin_task": broken_off(GoalStatus.REJECTED, LIMIT)}, "unreachable", "joint 4 would exceed its limit"),
        ({"move_free": GoalEnd(GoalStatus.ABORTED, STOOD, LIMIT)}, "blocked", "joint 4 would exceed its limit"),
        ({"check_collision": AT_CRATE}, "blocked", "at the target, arm/finger with crate would touch"),
        ({"gripper_open": broken_off(GoalStatus.ABORTED, LIMIT)}, "failed", "the gripper of arm did not open"),
        (
            {"cart_lin_task": broken_off(GoalStatus.ABORTED, LIMIT)},
            "failed",
            "arm did not move on a straight line to pose",
        ),
        ({"attach_part": SkillFailed("no such part")}, "failed", "part block was not attached to arm"),
    ],
    ids=str,
)
async def test_every_way_of_not_getting_there_has_its_outcome_and_reason(
    changed: dict[str, object], outcome: str, reason: str
) -> None:
    result = await PICK.run(cell(**changed))
    assert result.name == outcome
    assert reason in str(result.outputs["reason"])
    assert result.cause is not None
    assert result.cause.message == "arm did not pick part block"
    assert result.cause.kind == "manipulation.PickPart"


async def test_a_missed_part_leaves_the_tool_open_and_the_arm_in_front() -> None:
    ctx = cell(gripper_grasp=held(found=False, reason="the fingers closed to 0.0 mm"))
    result = await PICK.run(ctx)
    assert result.name == "missed"
    assert "the fingers closed to 0.0 mm" in str(result.outputs["reason"])
    assert asked(ctx)[-3:] == ["arm/gripper/gripper_open", "cell/detach_part", "arm/cart_lin_task"]
    assert lines(ctx)[-1] == (0.5, 0.1, 0.3)


async def test_a_part_that_cannot_be_lifted_is_let_go_of_where_it_stands() -> None:
    ctx = cell(cart_lin_task=[done(WENT), broken_off(GoalStatus.REJECTED, IN_THE_WAY), done(WENT)])
    result = await PICK.run(ctx)
    assert (result.name, "block would touch crate" in str(result.outputs["reason"])) == ("blocked", True)
    assert asked(ctx)[-3:] == ["arm/gripper/gripper_open", "cell/detach_part", "arm/cart_lin_task"]


async def test_a_part_that_is_not_there_is_missed_before_anything_moves() -> None:
    ctx = cell()
    result = await PickPart(robot="arm", part="blok", width_m=0.05).run(ctx)
    assert (result.name, result.outputs) == ("missed", {"reason": "no such part is in the cell; did you mean block?"})
    assert asked(ctx) == []


async def test_a_part_lost_while_it_is_lifted_is_missed_and_no_longer_planned_with() -> None:
    ctx = cell(read_gripper=GripperState(time_s=0.0, width_m=0.0, force_n=0.0, held=False))
    result = await PickPart(robot="arm", part="block", width_m=0.05, mass_kg=1.0).run(ctx)
    assert result.name == "missed"
    assert "arm lost part block" in str(result.outputs["reason"])
    assert ("arm/set_load", SetLoad(mass_kg=0.0)) in ctx.sent
    assert "cell/detach_part" in asked(ctx)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "a gripper needs `width_m`"),
        ({"tool": "suction"}, "suction"),
        ({"tool": "magnet", "approach": [0, 0, 0]}, "`approach` must not be a zero vector"),
        ({"tool": "magnet", "turns": 0}, "turns"),
    ],
)
def test_a_pick_that_cannot_be_meant_is_refused_with_the_document(given: dict[str, object], message: str) -> None:
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert({"robot": "arm", "part": "block", **given}, PickPart)
