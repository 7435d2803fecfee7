"""The states of the magnet: what they ask for, and what is held."""

from __future__ import annotations

import pytest

from engine.errors import Cause
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.state import Outcome, State
from robots.magnet.check_magnet import CheckHeld
from robots.magnet.magnet_skills import MagnetResult, MagnetState, MagnetSwitch
from robots.magnet.switch_off import Off
from robots.magnet.switch_on import On
from tests.states.fake_context import FakeContext, broken_off

SWITCH = "arm/magnet/magnet_switch"
FAULT = Cause(message="no answer from the output", where="arm/magnet")


def ended(result: MagnetResult) -> FakeContext:
    """A magnet that ends so."""
    return FakeContext({SWITCH: GoalEnd(GoalStatus.SUCCEEDED, result, None)})


async def test_switching_on_confirms_the_plate() -> None:
    ctx = ended(MagnetResult(on=True, held=True, pull_n=210.0, part="plate"))
    assert await On(magnet="arm").run(ctx) == Outcome("held", {"held": True, "pull_n": 210.0})
    assert ctx.sent == [(SWITCH, MagnetSwitch(on=True))]


async def test_a_missed_plate_is_named_with_the_reason_of_the_magnet() -> None:
    ctx = ended(MagnetResult(on=True, held=False, pull_n=0.0, reason="the magnet is on and touches nothing"))
    outcome = await On(magnet="arm", part="plate").run(ctx)
    assert (outcome.name, outcome.outputs) == ("missed", {"held": False, "pull_n": 0.0})
    assert outcome.cause is not None
    assert [(link.where, link.message) for link in outcome.cause.chain()] == [
        ("root/step", "the magnet of arm does not hold part plate"),
        (SWITCH, "the magnet is on and touches nothing"),
    ]


async def test_switching_off_releases() -> None:
    ctx = ended(MagnetResult(on=False, held=False, pull_n=0.0, reason="the magnet is switched off"))
    assert await Off(magnet="arm").run(ctx) == Outcome("released")
    assert ctx.sent == [(SWITCH, MagnetSwitch(on=False))]


async def test_a_magnet_that_holds_on_though_switched_off_has_not_released() -> None:
    outcome = await Off(magnet="arm", part="plate").run(ended(MagnetResult(on=True, held=True, pull_n=90.0)))
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "the magnet of arm did not release part plate",
        "it still pulls with 90.0 N",
    ]


@pytest.mark.parametrize(
    ("state", "message"),
    [
        (On(magnet="arm", part="plate"), "the magnet of arm does not hold part plate: magnet_switch was aborted"),
        (Off(magnet="arm"), "the magnet of arm did not release its part: magnet_switch was aborted"),
    ],
)
async def test_a_goal_that_breaks_off_fails_with_the_devices_reason(state: State, message: str) -> None:
    outcome = await state.run(FakeContext({SWITCH: broken_off(GoalStatus.ABORTED, FAULT)}))
    assert outcome.name == "failed"
    assert outcome.cause == Cause(message=message, where="root/step", kind=state.state_name, because=FAULT)


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        (MagnetState(time_s=1.0, on=True, pull_n=0.0, held=False), "the magnet pulls with 0.0 N"),
        (MagnetState(time_s=1.0, on=False, pull_n=0.0, held=False), "the magnet is switched off"),
    ],
)
async def test_a_lost_plate_is_named(measured: MagnetState, words: str) -> None:
    outcome = await CheckHeld(magnet="arm", part="plate").run(FakeContext({"arm/magnet/read_magnet": measured}))
    assert outcome.name == "lost"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == ["the magnet of arm lost part plate", words]


async def test_a_plate_still_held_is_held() -> None:
    measured = MagnetState(time_s=1.0, on=True, pull_n=210.0, held=True, part="plate")
    assert await CheckHeld(magnet="arm").run(FakeContext({"arm/magnet/read_magnet": measured})) == Outcome("held")


def test_magnet_states_command_the_magnet_and_questions_command_nothing() -> None:
    states = (On(magnet="arm"), Off(magnet="arm"), CheckHeld(magnet="arm"))
    assert [state.resources() for state in states] == [("arm/magnet",)] * 2 + [()]


async def test_another_plate_at_the_magnet_is_missed_and_later_lost() -> None:
    """The contact of the face names it."""
    missed = await On(magnet="arm", part="plate").run(
        ended(MagnetResult(on=True, held=True, pull_n=210.0, part="decoy", by="contact"))
    )
    assert (missed.name, missed.outputs) == ("missed", {"held": False, "pull_n": 210.0})
    state = MagnetState(time_s=1.0, on=True, pull_n=210.0, held=True, part="decoy")
    lost = await CheckHeld(magnet="arm", part="plate").run(FakeContext({"arm/magnet/read_magnet": state}))
    assert lost.name == "lost"
    for outcome in (missed, lost):
        assert outcome.cause is not None
        assert outcome.cause.chain()[-1].message == "it holds decoy, by contact, and not plate"


async def test_a_magnet_that_cannot_name_what_it_pulls_at_holds() -> None:
    ctx = ended(MagnetResult(on=True, held=True, pull_n=210.0, part="?", by="current"))
    assert (await On(magnet="arm", part="plate").run(ctx)).name == "held"


async def test_a_plate_that_sticks_is_named() -> None:
    end = await Off(magnet="arm").run(ended(MagnetResult(on=True, held=True, pull_n=90.0, part="plate", by="contact")))
    assert end.cause is not None
    assert end.cause.chain()[-1].message == "it still pulls at plate with 90.0 N"
