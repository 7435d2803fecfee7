"""Simulated people: the requests to the cell, the wait for the hand, and the cause of a refusal."""

from __future__ import annotations

import pytest

from engine.errors import Cause, NoSuchSkill, SkillFailed
from engine.skills import people
from engine.skills.people import ReachResult
from engine.state import Outcome
from states.cell.reach import Reach
from states.cell.withdraw import Withdraw
from tests.states.fake_context import FakeContext

HAND = (0.4, 0.0, 0.5)
REACHING = ReachResult(person="anna", hand_m=HAND, arrives_in_s=1.5)
ANSWERS = {"cell/reach": REACHING, "cell/withdraw": REACHING}


@pytest.mark.virtual
async def test_a_hand_is_sent_and_the_behavior_goes_on_at_once() -> None:
    ctx = FakeContext(ANSWERS)
    state = Reach(person="anna", hand_m=HAND, speed_m_s=1.2, stay_s=2.0)
    assert await state.run(ctx) == Outcome("done")
    assert ctx.sent == [("cell/reach", people.Reach(person="anna", hand_m=HAND, speed_m_s=1.2, stay_s=2.0))]
    assert ctx.clock.now_s() == 0.0


@pytest.mark.virtual
@pytest.mark.parametrize("state", [Reach(person="anna", hand_m=HAND, wait=True), Withdraw(person="anna", wait=True)])
async def test_with_wait_it_goes_on_when_the_hand_is_there(state: Reach | Withdraw) -> None:
    ctx = FakeContext(ANSWERS)
    assert await state.run(ctx) == Outcome("done")
    assert ctx.clock.now_s() == pytest.approx(1.5)


@pytest.mark.virtual
async def test_a_hand_is_taken_back() -> None:
    ctx = FakeContext(ANSWERS)
    assert await Withdraw(person="anna", speed_m_s=0.4).run(ctx) == Outcome("done")
    assert ctx.sent == [("cell/withdraw", people.Withdraw(person="anna", speed_m_s=0.4))]


async def test_a_place_out_of_reach_is_an_outcome_with_the_reason() -> None:
    refusal = SkillFailed("anna cannot reach (9, 0, 0)", where="cell")
    outcome = await Reach(person="anna", hand_m=HAND).run(FakeContext({"cell/reach": refusal}))
    because = Cause(message="anna cannot reach (9, 0, 0)", where="cell", kind="SkillFailed")
    assert outcome == Outcome(
        "failed",
        cause=Cause(message="anna does not reach into the cell", where="root/step", kind="cell.Reach", because=because),
    )


async def test_a_cell_without_people_is_a_mistake_of_the_behavior() -> None:
    with pytest.raises(NoSuchSkill):
        await Withdraw(person="anna").run(FakeContext())
