"""The states of a gripper are undone: what was grasped is let go of, what was let go of is grasped again."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from engine.errors import StateError
from engine.skill import Action
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.gripper import GraspResult, GripperGrasp, GripperMove, GripperOpen, GripperSetting
from engine.state import ActivationRecord, RequestRecord, State
from states.gripper.grasp import Grasp
from states.gripper.move import Move
from states.gripper.open import Open
from tests.states.fake_context import FakeContext

WIDE = GripperSetting(width_m=0.08, held=False)
HOLDING = GripperSetting(width_m=0.03, held=True, force_n=25.0)
MOVED = GoalEnd(GoalStatus.SUCCEEDED, GraspResult(held=False, width_m=0.08, force_n=0.0), None)
HELD = GoalEnd(GoalStatus.SUCCEEDED, GraspResult(held=True, width_m=0.03, force_n=25.0), None)
GRASP = Grasp(gripper="left", width_m=0.03, speed_m_s=0.02)


def done(goal: type[Action[Any, Any]], start: GripperSetting | None) -> ActivationRecord:
    """Return an activation that has sent one goal to a gripper that was so before."""
    known = start if start is not None else msgspec.UNSET
    result = msgspec.to_builtins(GraspResult(held=False, width_m=0.05, force_n=0.0, start=known))
    sent = RequestRecord(address=f"left/gripper/{goal.skill_name()}", request={}, status="succeeded", result=result)
    return ActivationRecord(inputs={}, outcome="held", outputs={}, requests=(sent,))


@pytest.mark.parametrize(
    ("state", "goal"),
    [
        (GRASP, GripperGrasp),
        (Move(gripper="left", width_m=0.05, speed_m_s=0.02), GripperMove),
        (Open(gripper="left", speed_m_s=0.02), GripperOpen),
    ],
    ids=["grasp", "move", "open"],
)
async def test_the_fingers_go_back_to_how_they_were(state: State, goal: type[Action[Any, Any]]) -> None:
    ctx = FakeContext({"left/gripper/gripper_move": MOVED, "left/gripper/gripper_grasp": HELD})
    assert state.cannot_undo(done(goal, WIDE)) == ""
    await state.undo(ctx, done(goal, WIDE))
    await state.undo(ctx, done(goal, HOLDING))
    assert ctx.sent == [
        ("left/gripper/gripper_move", GripperMove(width_m=0.08, speed_m_s=0.02)),
        ("left/gripper/gripper_grasp", GripperGrasp(width_m=0.03, force_n=25.0, speed_m_s=0.02)),
    ]


async def test_what_cannot_be_grasped_again_is_an_error() -> None:
    missed = GoalEnd(
        GoalStatus.SUCCEEDED, GraspResult(held=False, width_m=0.0, force_n=0.0, reason="nothing there"), None
    )
    ctx = FakeContext({"left/gripper/gripper_grasp": missed})
    with pytest.raises(StateError, match="did not grasp again the part that it held: nothing there"):
        await Open(gripper="left").undo(ctx, done(GripperOpen, HOLDING))


def test_a_gripper_of_which_nobody_knows_how_it_was_is_not_moved() -> None:
    assert (
        GRASP.cannot_undo(done(GripperGrasp, None)) == "the state of the gripper before the activation was not recorded"
    )
