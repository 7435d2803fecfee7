"""Hand skills over a fake port: percent and time, honest results, stopping."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock
from engine.skills.hand import HandClose, HandOpen, HandResult, ReadHand
from robots.gripper import HandServer
from tests.robots.fake_tool_ports import FakeHandPort

HAND = "left/hand"
CLOSE = HandClose(percent=70.0, time_s=1.5)


@asynccontextmanager
async def served(port: FakeHandPort) -> AsyncGenerator[SkillBus]:
    """A bus with one hand on it."""
    async with SkillBus(new_clock()) as bus:
        HandServer(name=HAND, port=port).register(bus)
        yield bus


async def closed(port: FakeHandPort, goal: HandClose = CLOSE) -> HandResult:
    """Close and return the result; `held` says the opposite of a reason."""
    async with served(port) as bus:
        end = await bus.send_goal(goal, to=HAND).result()
    assert end.status is GoalStatus.SUCCEEDED
    assert end.result is not None
    assert end.result.held is not bool(end.result.reason)
    return end.result


@pytest.mark.virtual
async def test_percent_and_time_reach_the_motor() -> None:
    port = FakeHandPort()
    result = await closed(port)
    assert port.asked == [(0.7, 1.5)]
    assert result == HandResult(held=True, closed_percent=70.0, force_n=60.0, part="part", by="contact")


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("port", "reason"),
    [
        (FakeHandPort(holds_from=0.9), "the hand closed to 70 % and touches nothing"),
        (FakeHandPort(force_n=1.0), "the hand touches part at 70 % and presses with 1.0 N only"),
        (FakeHandPort(contacts=("part", "", "", "", "", "")), "only the thumb touches part, at 70 %"),
        (FakeHandPort(contacts=("", "", "", "", "", "part")), "only the palm touches part, at 70 %"),
        (
            FakeHandPort(contacts=("", "part", "part", "", "", "")),
            "the fingers touch part at 70 %, but neither thumb nor palm opposes them",
        ),
        (
            FakeHandPort(contacts=("lid", "part", "part", "", "", "")),
            "the fingers touch lid and part at 70 %, but neither thumb nor palm opposes them",
        ),
    ],
)
async def test_a_part_that_is_not_held_is_explained(port: FakeHandPort, reason: str) -> None:
    assert (await closed(port)).reason == reason


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("contacts", "part"),
    [
        (("", "part", "", "", "", "part"), "part"),
        (("?", "?", "?", "", "", ""), "?"),
        (("lid", "lid", "part", "", "", "part"), "lid"),
    ],
)
async def test_thumb_or_palm_against_a_finger_holds(contacts: tuple[str, ...], part: str) -> None:
    """Also when the hand cannot tell what."""
    assert (await closed(FakeHandPort(contacts=contacts))).part == part


@pytest.mark.virtual
async def test_an_open_hand_holds_nothing() -> None:
    port = FakeHandPort()
    async with served(port) as bus:
        await bus.send_goal(CLOSE, to=HAND).result()
        end = await bus.send_goal(HandOpen(time_s=0.5), to=HAND).result()
    assert port.asked[-1] == (0.0, 0.5)
    assert end.result is not None
    assert (end.result.held, end.result.reason) == (False, "the hand is open")


@pytest.mark.virtual
async def test_a_lost_part_is_no_longer_held_when_asked() -> None:
    port = FakeHandPort()
    async with served(port) as bus:
        await bus.send_goal(CLOSE, to=HAND).result()
        before = await bus.call(ReadHand(), to=HAND)
        port.lose_the_part()
        after = await bus.call(ReadHand(), to=HAND)
    assert ((before.held, before.part), (after.held, after.part)) == ((True, "part"), (False, ""))


@pytest.mark.virtual
async def test_a_cancelled_closing_ends_at_rest_and_the_next_goal_is_taken() -> None:
    port = FakeHandPort()
    async with served(port) as bus:
        handle = bus.send_goal(CLOSE, to=HAND)
        await bus.clock.sleep(0.6)
        handle.cancel()
        canceled = await handle.result()
        following = await bus.send_goal(HandOpen(), to=HAND).result()
    assert canceled.result is not None
    assert 20.0 < canceled.result.closed_percent < 40.0
    assert (canceled.status, following.status) == (GoalStatus.CANCELED, GoalStatus.SUCCEEDED)


@pytest.mark.virtual
async def test_a_device_fault_is_the_cause_of_the_failure() -> None:
    port = FakeHandPort()
    async with served(port) as bus:
        handle = bus.send_goal(CLOSE, to=HAND)
        await bus.clock.sleep(0.2)
        assert port.motion is not None
        port.motion.fail("motor overheated")
        end = await handle.result()
    assert end.cause is not None
    assert (end.status, end.cause.chain()[-1].message) == (GoalStatus.ABORTED, "motor overheated")


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("contacts", "by"),
    [(("part", "part", "", "", "", "part"), "contact"), (("?", "?", "", "", "", ""), "current"), ((), "not measured")],
)
async def test_a_hand_says_what_tells_it_that_it_holds(contacts: tuple[str, ...], by: str) -> None:
    """One without a place that feels a contact claims nothing."""
    result = await closed(FakeHandPort(contacts=contacts))
    assert (result.by, result.held) == (by, by != "not measured")
