"""The states of the hand: what they ask for, and what is held."""

from __future__ import annotations

import pytest

from engine.errors import Cause
from engine.messages import HandState
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.hand import HandClose, HandOpen, HandResult
from engine.state import Outcome, State
from states.hand.check_held import CheckHeld
from states.hand.close import Close
from states.hand.open import Open
from tests.states.fake_context import FakeContext, broken_off

JAM = Cause(message="the motor stalled", where="left/hand")


async def test_closing_asks_for_percent_and_time_and_tells_how_far_it_came() -> None:
    result = HandResult(held=True, closed_percent=70.0, force_n=50.0, part="hca_north")
    ctx = FakeContext({"left/hand/hand_close": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    outcome = await Close(hand="left", percent=70.0, time_s=1.5).run(ctx)
    assert outcome == Outcome("held", {"held": True, "closed_percent": 70.0})
    assert ctx.sent == [("left/hand/hand_close", HandClose(percent=70.0, time_s=1.5))]


async def test_a_missed_part_is_named_with_the_reason_of_the_hand() -> None:
    result = HandResult(held=False, closed_percent=70.0, force_n=0.1, reason="the hand touches nothing")
    ctx = FakeContext({"left/hand/hand_close": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    outcome = await Close(hand="left", percent=70.0, part="hca_north").run(ctx)
    assert (outcome.name, outcome.outputs) == ("missed", {"held": False, "closed_percent": 70.0})
    assert outcome.cause is not None
    assert [(link.where, link.message) for link in outcome.cause.chain()] == [
        ("root/step", "the hand of left does not hold part hca_north"),
        ("left/hand/hand_close", "the hand touches nothing"),
    ]


async def test_opening_sends_its_goal() -> None:
    result = HandResult(held=False, closed_percent=0.0, force_n=0.0, reason="the hand is open")
    ctx = FakeContext({"left/hand/hand_open": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    assert await Open(hand="left", time_s=0.5).run(ctx) == Outcome("opened")
    assert ctx.sent == [("left/hand/hand_open", HandOpen(time_s=0.5))]


@pytest.mark.parametrize(
    ("state", "skill", "message"),
    [
        (
            Open(hand="left", part="hca_north"),
            "hand_open",
            "the hand of left did not open to release part hca_north: hand_open was aborted",
        ),
        (
            Close(hand="left", percent=70.0, part="hca_north"),
            "hand_close",
            "the hand of left does not hold part hca_north: hand_close was aborted",
        ),
    ],
)
async def test_a_goal_that_breaks_off_fails_with_the_devices_reason(state: State, skill: str, message: str) -> None:
    outcome = await state.run(FakeContext({f"left/hand/{skill}": broken_off(GoalStatus.ABORTED, JAM)}))
    assert outcome.name == "failed"
    assert outcome.cause == Cause(message=message, where="root/step", kind=state.state_name, because=JAM)


async def test_what_is_still_held_is_held_and_what_is_lost_is_named() -> None:
    held = HandState(time_s=1.0, closed_percent=70.0, force_n=50.0, held=True, part="hca_north")
    lost = HandState(time_s=1.0, closed_percent=70.0, force_n=0.2, held=False)
    state = CheckHeld(hand="left", part="hca_north")
    assert await state.run(FakeContext({"left/hand/read_hand": held})) == Outcome("held")
    outcome = await state.run(FakeContext({"left/hand/read_hand": lost}))
    assert outcome.name == "lost"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "the hand of left lost part hca_north",
        "the hand is closed to 70 % and presses with 0.2 N",
    ]


def test_hand_states_command_the_hand_and_questions_command_nothing() -> None:
    states = (Open(hand="left"), Close(hand="left", percent=50.0), CheckHeld(hand="left"))
    assert [state.resources() for state in states] == [("left/hand",)] * 2 + [()]


async def test_another_part_in_the_hand_is_missed_and_later_lost() -> None:
    """The contacts of thumb and fingers name it."""
    result = HandResult(held=True, closed_percent=70.0, force_n=50.0, part="decoy", by="contact")
    closed = FakeContext({"left/hand/hand_close": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    missed = await Close(hand="left", percent=70, part="hca_north").run(closed)
    assert (missed.name, missed.outputs["held"]) == ("missed", False)
    state = HandState(time_s=1.0, closed_percent=70.0, force_n=50.0, held=True, part="decoy")
    lost = await CheckHeld(hand="left", part="hca_north").run(FakeContext({"left/hand/read_hand": state}))
    assert lost.name == "lost"
    for outcome in (missed, lost):
        assert outcome.cause is not None
        assert outcome.cause.chain()[-1].message == "it holds decoy, by contact, and not hca_north"
