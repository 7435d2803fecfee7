"""Magnet skills over a fake port: what is confirmed, and what is said where nothing is held."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock
from engine.messages import HoldEvidence
from robots.magnet.magnet_server import MagnetServer
from robots.magnet.magnet_skills import MagnetResult, MagnetSwitch, ReadMagnet
from tests.robots.fake_tool_ports import FakeMagnetPort

MAGNET = "arm/magnet"


@asynccontextmanager
async def served(port: FakeMagnetPort) -> AsyncGenerator[SkillBus]:
    """A bus with one magnet on it."""
    async with SkillBus(new_clock()) as bus:
        MagnetServer(name=MAGNET, port=port).register(bus)
        yield bus


async def switched(port: FakeMagnetPort, *, on: bool = True) -> MagnetResult:
    """Switch and return the result."""
    async with served(port) as bus:
        end = await bus.send_goal(MagnetSwitch(on=on), to=MAGNET).result()
    assert end.status is GoalStatus.SUCCEEDED
    assert end.result is not None
    return end.result


@pytest.mark.virtual
@pytest.mark.parametrize(("contact", "by"), [("plate", "contact"), ("?", "current")])
async def test_a_plate_that_is_pulled_is_held(contact: str, by: HoldEvidence) -> None:
    """Also where the magnet cannot tell which, and then it says so."""
    assert await switched(FakeMagnetPort(contact=contact)) == MagnetResult(
        on=True, held=True, pull_n=200.0, part=contact, by=by
    )


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("port", "reason"),
    [
        (FakeMagnetPort(contact=""), "the magnet is on and touches nothing"),
        (FakeMagnetPort(contact="lid", pull_n=0.0), "the magnet touches lid and pulls at it with 0.0 N of 200 N"),
        (FakeMagnetPort(contact="?", pull_n=4.0), "the magnet touches something and pulls at it with 4.0 N of 200 N"),
    ],
)
async def test_what_is_not_held_is_explained(port: FakeMagnetPort, reason: str) -> None:
    result = await switched(port)
    assert (result.on, result.held, result.part, result.reason) == (True, False, "", reason)


@pytest.mark.virtual
async def test_switching_off_releases() -> None:
    result = await switched(FakeMagnetPort(), on=False)
    assert (result.on, result.held, result.reason) == (False, False, "the magnet is switched off")


@pytest.mark.virtual
async def test_a_lost_plate_is_no_longer_held_when_asked() -> None:
    port = FakeMagnetPort()
    async with served(port) as bus:
        await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()
        before = await bus.call(ReadMagnet(), to=MAGNET)
        port.contact = ""
        after = await bus.call(ReadMagnet(), to=MAGNET)
    assert ((before.held, before.part), (after.held, after.part)) == ((True, "plate"), (False, ""))


@pytest.mark.virtual
async def test_an_output_that_does_not_answer_is_the_cause_of_the_failure() -> None:
    async with served(FakeMagnetPort(dead=True)) as bus:
        end = await bus.send_goal(MagnetSwitch(on=True), to=MAGNET).result()
    assert end.cause is not None
    assert (end.status, end.cause.chain()[-1].message) == (GoalStatus.ABORTED, "no answer from the output")
