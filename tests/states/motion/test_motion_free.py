"""The states of collision-free motion: what they ask for, and which end is which outcome."""

from __future__ import annotations

import msgspec
import pytest

from engine.errors import Cause
from engine.messages import Pose
from engine.skills import planning
from engine.skills.entries import EntryRecord
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.planning import (
    Adaptation,
    FreeMotionResult,
    KeepOrientation,
    MotionTarget,
    PlannedMotion,
    PlanOptions,
)
from engine.state import Outcome, State
from states.motion.execute_plan import ExecutePlan
from states.motion.motion_target import EntryTarget, PoseTarget
from states.motion.move_free import MoveFree
from states.motion.plan_motion import PlanMotion
from tests.states.fake_context import FakeContext, broken_off

WAY = PlannedMotion(
    robot="arm",
    waypoints=((0.0, 0.0), (0.5, 1.0)),
    speed=0.4,
    duration_s=2.5,
    tool_path=((0.1, 0.2, 0.3), (0.4, 0.2, 0.3)),
    found_by="fast",
    planning_s=0.002,
)
WENT = FreeMotionResult(joints=(0.5, 1.0), duration_s=2.5, stops=0, replans=0, reused=0, waited_s=0.0)
STOOD = msgspec.structs.replace(WENT, stops=1, waited_s=30.0, blocked="arm/link_4 with occupancy")
TOUCHES = Cause(message="at the goal arm/tool touches crate", where="arm", kind="GoalRejected")
IN_THE_WAY = Cause(message="the way stayed blocked for 30.0 s", where="arm", kind="SkillFailed")
DEAD = Cause(message="the planner has died", where="arm", kind="RobotError")


async def test_moving_free_asks_for_what_the_behavior_says() -> None:
    ctx = FakeContext({"arm/move_free": GoalEnd(GoalStatus.SUCCEEDED, WENT, None)})
    upright = KeepOrientation(tolerance_rad=0.2)
    state = MoveFree(
        robot="arm",
        joints=(0.5, 1.0),
        speed=0.4,
        patience_s=30.0,
        planner="RRTConnect",
        time_s=2.0,
        margin_m=0.03,
        keep_orientation=upright,
        seed=7,
    )
    assert await state.run(ctx) == Outcome("reached")
    options = PlanOptions(planner="RRTConnect", time_s=2.0, seed=7, margin_m=0.03, keep_orientation=upright, speed=0.4)
    goal = planning.MoveFree(
        target=MotionTarget(joints=(0.5, 1.0)), options=options, adaptation=Adaptation(patience_s=30.0)
    )
    assert ctx.sent == [("arm/move_free", goal)]


@pytest.mark.parametrize("state", [MoveFree, PlanMotion])
async def test_entries_are_read_when_the_state_runs(state: type[MoveFree | PlanMotion]) -> None:
    """A pose with what of it counts and how far off, or a joint configuration."""
    records = [
        EntryRecord(kind="pose", name="pick", value={"xyz": [0.1, 0.2, 0.3]}, revision=1),
        EntryRecord(kind="joints", name="home", value={"joints": [0.0, 1.0], "names": []}, revision=1),
    ]
    address = "arm/move_free" if state is MoveFree else "arm/plan_motion"
    ctx = FakeContext({"store/read_entry": records, address: broken_off(GoalStatus.CANCELED, None)})
    over = state(robot="arm", pose=PoseTarget(entry="pick"), offset_m=(0.0, 0.0, 0.5), match="axis")
    await over.run(ctx)
    await state(robot="arm", joints=EntryTarget(entry="home")).run(ctx)
    goals = [goal for sent, goal in ctx.sent if sent == address]
    assert [goal.target for goal in goals if isinstance(goal, planning.MoveFree | planning.PlanMotion)] == [
        MotionTarget(pose=Pose(xyz=(0.1, 0.2, 0.8)), match="axis"),
        MotionTarget(joints=(0.0, 1.0)),
    ]


@pytest.mark.parametrize(
    ("end", "outcome", "reason"),
    [
        (broken_off(GoalStatus.REJECTED, TOUCHES), "no_way", "at the goal arm/tool touches crate"),
        (GoalEnd(GoalStatus.ABORTED, STOOD, IN_THE_WAY), "blocked", "the way stayed blocked for 30.0 s"),
        (GoalEnd(GoalStatus.ABORTED, WENT, DEAD), "failed", "the planner has died"),
        (broken_off(GoalStatus.ABORTED, DEAD), "failed", "the planner has died"),
        (broken_off(GoalStatus.CANCELED, None), "failed", "the goal was cancelled by somebody other than this state"),
    ],
)
async def test_each_end_of_a_free_motion_is_an_outcome_with_its_reason(
    end: GoalEnd[object], outcome: str, reason: str
) -> None:
    result = await MoveFree(robot="arm", joints=(0.5, 1.0)).run(FakeContext({"arm/move_free": end}))
    assert (result.name, result.outputs) == (outcome, {"reason": reason})
    assert result.cause is not None
    assert result.cause.message == f"arm did not reach joints (0.5, 1): move_free was {end.status}"
    assert result.cause.kind == "motion.MoveFree"


async def test_a_planned_way_is_what_comes_out() -> None:
    ctx = FakeContext({"arm/plan_motion": GoalEnd(GoalStatus.SUCCEEDED, WAY, None)})
    assert await PlanMotion(robot="arm", joints=(0.5, 1.0), speed=0.4).run(ctx) == Outcome("planned", {"plan": WAY})
    goal = planning.PlanMotion(target=MotionTarget(joints=(0.5, 1.0)), options=PlanOptions(speed=0.4))
    assert ctx.sent == [("arm/plan_motion", goal)]


@pytest.mark.parametrize(
    ("end", "outcome"),
    [
        (broken_off(GoalStatus.REJECTED, TOUCHES), "no_way"),
        (broken_off(GoalStatus.ABORTED, IN_THE_WAY), "no_way"),
        (broken_off(GoalStatus.ABORTED, DEAD), "failed"),
        (broken_off(GoalStatus.CANCELED, None), "failed"),
    ],
)
async def test_a_planner_that_finds_nothing_is_no_planner_that_is_gone(end: GoalEnd[object], outcome: str) -> None:
    result = await PlanMotion(robot="arm", pose=PoseTarget(entry="", xyz=(1, 0, 0))).run(
        FakeContext({"arm/plan_motion": end})
    )
    assert result.name == outcome
    assert list(result.outputs) == ["reason"]
    assert result.cause is not None
    assert result.cause.message.startswith(
        "no path of arm to pose (1.000, 0.000, 0.000) m was planned: plan_motion was"
    )


async def test_a_plan_is_executed_as_it_is_and_with_its_speed() -> None:
    ctx = FakeContext({"arm/execute_plan": GoalEnd(GoalStatus.SUCCEEDED, WENT, None)})
    state = ExecutePlan(robot="arm", patience_s=5.0, watch=False, margin_m=0.02)
    assert await state.run(ctx, plan=WAY) == Outcome("reached")
    goal = planning.ExecutePlan(
        plan=WAY,
        adaptation=Adaptation(watch=False, patience_s=5.0),
        options=PlanOptions(margin_m=0.02, speed=0.4),
    )
    assert ctx.sent == [("arm/execute_plan", goal)]


@pytest.mark.parametrize(
    ("end", "outcome"),
    [
        (GoalEnd(GoalStatus.ABORTED, STOOD, IN_THE_WAY), "blocked"),
        (broken_off(GoalStatus.REJECTED, TOUCHES), "failed"),
        (broken_off(GoalStatus.ABORTED, DEAD), "failed"),
    ],
)
async def test_a_plan_that_is_not_gone_to_its_end_says_why(end: GoalEnd[object], outcome: str) -> None:
    result = await ExecutePlan(robot="arm").run(FakeContext({"arm/execute_plan": end}), plan=WAY)
    assert (result.name, list(result.outputs)) == (outcome, ["reason"])


@pytest.mark.parametrize(
    ("state", "given", "message"),
    [
        (MoveFree, {"robot": "arm"}, "give either `joints` or `pose`"),
        (MoveFree, {"robot": "arm", "joints": [0.1], "pose": {"entry": "a"}}, "give either `joints` or `pose`"),
        (PlanMotion, {"robot": "arm"}, "give either `joints` or `pose`"),
        (MoveFree, {"robot": "arm", "joints": [0.1], "patience_s": -1}, "patience_s"),
        (MoveFree, {"robot": "arm", "joints": [0.1], "margin_m": 1}, "margin_m"),
        (PlanMotion, {"robot": "arm", "joints": [0.1], "time_s": 0}, "time_s"),
    ],
)
def test_parameters_that_contradict_or_are_out_of_range_are_refused(
    state: type[State], given: dict[str, object], message: str
) -> None:
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert(given, state)


def test_planning_commands_nothing_and_moving_commands_the_arm() -> None:
    states = (PlanMotion(robot="arm", joints=(0.0,)), MoveFree(robot="arm", joints=(0.0,)), ExecutePlan(robot="arm"))
    assert [state.resources() for state in states] == [(), ("arm",), ("arm",)]
