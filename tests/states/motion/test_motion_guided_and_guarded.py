"""The states that end by what the surroundings do: contact, and a hand that leads."""

from __future__ import annotations

import msgspec
import pytest

from engine.errors import Cause
from engine.messages import Pose, Wrench
from engine.skills import contact
from engine.skills.contact import ContactResult
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.guiding import GuideArm, GuideResult
from engine.state import Outcome
from states.motion.guide import Guide
from states.motion.move_until_contact import MoveUntilContact
from tests.states.fake_context import FakeContext, broken_off

HERE = Pose(xyz=(0.1, 0.2, 0.3))
LOST = Cause(message="the world is gone", where="left", kind="RobotError")
SEARCH = MoveUntilContact(robot="left", direction=(0.0, 0.0, -1.0), distance_m=0.05, force_n=8.0)


def ended(*, met: bool, force_n: float) -> GoalEnd[ContactResult]:
    """The end of a guarded move after 3 cm."""
    wrench = Wrench(force_n=(0.0, 0.0, force_n), torque_nm=(0.0, 0.0, 0.0), frame="world")
    result = ContactResult(
        contact=met, pose=HERE, travelled_m=0.03, force_n=force_n, wrench=wrench, duration_s=1.0, peak_n=9.1
    )
    return GoalEnd(GoalStatus.SUCCEEDED, result, None)


async def test_a_contact_is_an_outcome_with_the_way_and_the_force() -> None:
    """The goal is what the state says."""
    ctx = FakeContext({"left/move_until_contact": ended(met=True, force_n=8.4)})
    assert await SEARCH.run(ctx) == Outcome("contact", {"travelled_m": 0.03, "force_n": 8.4, "peak_n": 9.1})
    goal = contact.MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.05, force_n=8.0)
    assert ctx.sent == [("left/move_until_contact", goal)]


async def test_a_peak_is_passed_on_with_the_distance_that_is_clear() -> None:
    """And the stiffness of what is touched."""
    ctx = FakeContext({"left/move_until_contact": ended(met=True, force_n=8.4)})
    state = msgspec.structs.replace(SEARCH, peak_n=20.0, clear_m=0.04, surface_n_m=5000.0)
    await state.run(ctx)
    goal = contact.MoveUntilContact(
        direction=(0.0, 0.0, -1.0), distance_m=0.05, force_n=8.0, peak_n=20.0, clear_m=0.04, surface_n_m=5000.0
    )
    assert ctx.sent == [("left/move_until_contact", goal)]


async def test_no_contact_is_another_and_says_how_little_was_felt() -> None:
    """A behavior may search elsewhere."""
    outcome = await SEARCH.run(FakeContext({"left/move_until_contact": ended(met=False, force_n=0.2)}))
    assert (outcome.name, outcome.outputs) == ("no_contact", {"travelled_m": 0.03, "force_n": 0.2, "peak_n": 9.1})
    assert outcome.cause is not None
    assert outcome.cause.message == "left detected no contact within 0.050 m"
    assert outcome.cause.chain()[-1].message == "the contact force at the end was 0.2 N, threshold 8.0 N"


async def test_a_guarded_move_that_fails_gives_the_reason_and_no_outputs() -> None:
    """Nothing was measured."""
    outcome = await SEARCH.run(FakeContext({"left/move_until_contact": broken_off(GoalStatus.ABORTED, LOST)}))
    assert (outcome.name, outcome.outputs) == ("failed", {})
    assert outcome.cause is not None
    assert outcome.cause.chain()[-1] == LOST


async def test_guiding_asks_for_a_record_and_says_how_long_it_became() -> None:
    """In samples."""
    result = GuideResult(joints=(0.0,), pose=HERE, samples=120, duration_s=1.2, entry="demo")
    ctx = FakeContext({"left/guide_arm": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    state = Guide(robot="left", record="demo", duration_s=5.0, damping=0.3)
    assert await state.run(ctx) == Outcome("finished", {"samples": 120})
    assert ctx.sent == [("left/guide_arm", GuideArm(record="demo", duration_s=5.0, damping=0.3))]


async def test_guiding_that_is_rejected_gives_the_reason() -> None:
    """Such as direct control that is on."""
    why = Cause(message="the arm is in direct joint control", where="left/guide_arm", kind="GoalRejected")
    outcome = await Guide(robot="left").run(FakeContext({"left/guide_arm": broken_off(GoalStatus.REJECTED, why)}))
    assert (outcome.name, outcome.outputs) == ("failed", {})
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "left did not finish guiding: guide_arm was rejected",
        "the arm is in direct joint control",
    ]


@pytest.mark.parametrize("state", [SEARCH, Guide(robot="left")])
def test_they_command_the_arm(state: MoveUntilContact | Guide) -> None:
    """And lease it."""
    assert state.resources() == ("left",)
