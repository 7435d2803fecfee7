"""The states of the gripper: what they ask for, and what is held."""

from __future__ import annotations

import pytest

from engine.errors import Cause
from engine.messages import GripperState, HoldEvidence
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.gripper import GraspResult, GripperGrasp, GripperMove, GripperOpen
from engine.state import Outcome, State
from states.gripper.check_held import CheckHeld
from states.gripper.grasp import Grasp
from states.gripper.move import Move
from states.gripper.open import Open
from tests.states.fake_context import FakeContext, broken_off

AJAR = GoalEnd(GoalStatus.SUCCEEDED, GraspResult(held=False, width_m=0.08, force_n=0.0), None)
JAM = Cause(message="the fingers jammed", where="left/gripper")


@pytest.mark.parametrize(
    ("state", "goal", "outcome"),
    [
        (Open(gripper="left"), GripperOpen(speed_m_s=0.1), "opened"),
        (Move(gripper="left", width_m=0.05, speed_m_s=0.02), GripperMove(width_m=0.05, speed_m_s=0.02), "reached"),
    ],
)
async def test_opening_and_moving_send_their_goal(state: State, goal: GripperOpen | GripperMove, outcome: str) -> None:
    """The goal goes to the gripper of the named arm."""
    address = f"left/gripper/{goal.skill_name()}"
    ctx = FakeContext({address: AJAR})
    assert await state.run(ctx) == Outcome(outcome)
    assert ctx.sent == [(address, goal)]


@pytest.mark.parametrize(
    ("state", "skill", "message"),
    [
        (
            Open(gripper="left", part="hca_north"),
            "gripper_open",
            "the gripper of left did not open to release part hca_north: gripper_open was aborted",
        ),
        (
            Move(gripper="left", width_m=0.05),
            "gripper_move",
            "the gripper of left did not reach an opening of 50.0 mm: gripper_move was aborted",
        ),
        (
            Grasp(gripper="left", width_m=0.03, part="hca_north"),
            "gripper_grasp",
            "left did not grasp part hca_north: gripper_grasp was aborted",
        ),
    ],
)
async def test_a_goal_that_breaks_off_fails_with_the_devices_reason(state: State, skill: str, message: str) -> None:
    """The chain names arm, part and skill above the device's own words."""
    outcome = await state.run(FakeContext({f"left/gripper/{skill}": broken_off(GoalStatus.ABORTED, JAM)}))
    assert outcome.name == "failed"
    assert outcome.cause == Cause(message=message, where="root/step", kind=state.state_name, because=JAM)


async def test_a_grasp_that_holds_tells_the_opening() -> None:
    """Held, with the measured width, and the goal as the parameters say."""
    end = GoalEnd(GoalStatus.SUCCEEDED, GraspResult(held=True, width_m=0.0301, force_n=19.5), None)
    ctx = FakeContext({"left/gripper/gripper_grasp": end})
    state = Grasp(gripper="left", width_m=0.03, force_n=25.0, speed_m_s=0.04, tolerance_outer_m=0.02)
    assert await state.run(ctx) == Outcome("held", {"held": True, "width_m": 0.0301})
    goal = GripperGrasp(width_m=0.03, force_n=25.0, speed_m_s=0.04, tolerance_inner_m=0.01, tolerance_outer_m=0.02)
    assert ctx.sent == [("left/gripper/gripper_grasp", goal)]


async def test_a_missed_part_is_named_with_what_the_fingers_measured() -> None:
    """Nothing between the fingers is an outcome with a chain of reasons."""
    result = GraspResult(held=False, width_m=0.0012, force_n=20.0, reason="the pads touch one another")
    ctx = FakeContext({"left/gripper/gripper_grasp": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    outcome = await Grasp(gripper="left", width_m=0.03, part="hca_north").run(ctx)
    assert (outcome.name, outcome.outputs) == ("missed", {"held": False, "width_m": 0.0012})
    assert outcome.cause is not None
    assert [(link.where, link.message) for link in outcome.cause.chain()] == [
        ("root/step", "left did not grasp part hca_north"),
        (
            "left/gripper/gripper_grasp",
            "the fingers ended 1.2 mm apart, 30.0 mm expected, pressing with 20.0 N",
        ),
        ("left/gripper/gripper_grasp", "the pads touch one another"),
    ]
    (compared,) = outcome.cause.chain()[1].compared
    assert (compared.quantity, compared.unit) == ("opening", "mm")
    assert (compared.measured, compared.least, compared.most) == pytest.approx((1.2, 20.0, 40.0))


async def test_a_part_still_held_is_held() -> None:
    """The gripper's own judgement counts."""
    measured = GripperState(time_s=1.0, width_m=0.03, force_n=20.0, held=True)
    assert await CheckHeld(gripper="left").run(FakeContext({"left/gripper/read_gripper": measured})) == Outcome("held")


async def test_a_lost_part_is_named() -> None:
    """A part that slipped out gives `lost` with the measurement below."""
    measured = GripperState(time_s=1.0, width_m=0.0, force_n=3.0, held=False)
    ctx = FakeContext({"left/gripper/read_gripper": measured})
    assert await CheckHeld(gripper="left", part="hca_north").run(ctx) == Outcome(
        "lost",
        cause=Cause(
            message="left lost part hca_north",
            where="root/step",
            kind="gripper.CheckHeld",
            because=Cause(
                message="the fingers are 0.0 mm apart and press with 3.0 N", where="left/gripper/read_gripper"
            ),
        ),
    )


def test_gripper_states_command_the_gripper_and_questions_command_nothing() -> None:
    """An arm may move while its gripper is asked."""
    states = (
        Open(gripper="left"),
        Move(gripper="left", width_m=0.0),
        Grasp(gripper="left", width_m=0.0),
        CheckHeld(gripper="left"),
    )
    assert [state.resources() for state in states] == [("left/gripper",)] * 3 + [()]


DECOY_CHAIN = "it holds decoy, by contact, and not hca_north"


@pytest.mark.parametrize(
    ("touched", "by", "outcome"),
    [
        ("decoy", "contact", "missed"),
        ("hca_north", "contact", "held"),
        ("?", "width", "held"),
        ("", "not measured", "held"),
    ],
)
async def test_a_grasp_of_another_part_of_the_same_width_is_missed_where_contact_is_measured(
    touched: str, by: HoldEvidence, outcome: str
) -> None:
    """A gripper that cannot name what it touches is not asked for more than it measures."""
    result = GraspResult(held=True, width_m=0.03, force_n=20.0, part=touched, by=by)
    ctx = FakeContext({"left/gripper/gripper_grasp": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    end = await Grasp(gripper="left", width_m=0.03, part="hca_north").run(ctx)
    assert (end.name, end.outputs) == (outcome, {"held": outcome == "held", "width_m": 0.03})
    if outcome == "missed":
        assert end.cause is not None
        assert [link.message for link in end.cause.chain()] == ["left did not grasp part hca_north", DECOY_CHAIN]


async def test_without_a_part_any_body_is_held() -> None:
    """Nothing is expected, so nothing is another one."""
    result = GraspResult(held=True, width_m=0.03, force_n=20.0, part="decoy", by="contact")
    ctx = FakeContext({"left/gripper/gripper_grasp": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    assert (await Grasp(gripper="left", width_m=0.03).run(ctx)).name == "held"


@pytest.mark.parametrize(("touched", "outcome"), [("decoy", "lost"), ("hca_north", "held"), ("?", "held")])
async def test_a_part_that_was_exchanged_is_lost(touched: str, outcome: str) -> None:
    measured = GripperState(time_s=1.0, width_m=0.03, force_n=20.0, held=True, part=touched)
    ctx = FakeContext({"left/gripper/read_gripper": measured})
    end = await CheckHeld(gripper="left", part="hca_north").run(ctx)
    assert end.name == outcome
    if outcome == "lost":
        assert end.cause is not None
        assert [link.message for link in end.cause.chain()] == ["left lost part hca_north", DECOY_CHAIN]
