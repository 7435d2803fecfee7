"""People asked over the bus, the same over both hosts: they reach, are drawn, are refused what they cannot do."""

from __future__ import annotations

import asyncio
import math
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import numpy as np
import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.errors import NoSuchSkill, SkillFailed
from engine.messages import FramePoses, SceneDescription, Vector3
from engine.skills.people import CountContacts, Reach, Withdraw
from robots.scene.sim_scene import SimScene
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.people.person import ANNA, AT_LEFT_HAND, OVER_TABLE, with_anna
from tests.robots.sim.sim_cell import TABLE, both_hosts_nightly, one_arm, opened, until


@asynccontextmanager
async def with_bus(scene: SimScene) -> AsyncGenerator[tuple[SimWorld, SkillBus]]:
    """Open a world that answers on a bus."""
    async with opened(scene) as world:
        bus = SkillBus(new_clock())
        world.register(bus)
        yield world, bus


async def passed(world: SimWorld, seconds: float) -> None:
    """Return once so much time has passed in the world, which may be slower than real time."""
    start_s = world.measured().time_s
    await until(lambda: world.measured().time_s > start_s + seconds, within_s=30.0)


def hand_xyz(bus: SkillBus) -> Vector3:
    """Return where the frames have the hand."""
    frames = bus.topic("cell/frames", FramePoses).latest
    assert frames is not None
    return frames.xyz[frames.names.index("anna/hand")]


@both_hosts_nightly
async def test_a_hand_is_there_at_the_time_that_was_promised_and_returns_when_requested(host: str) -> None:
    async with with_bus(with_anna(SimScene(fixtures=(TABLE,)))) as (world, bus):
        asked_s = world.measured().time_s
        reaching = await bus.call(Reach(person="anna", hand_m=OVER_TABLE, speed_m_s=1.5), to="cell")
        assert reaching.arrives_in_s == pytest.approx(1.875 * math.dist(ANNA.hand_rests, OVER_TABLE) / 1.5)
        # Every look counts that is early enough; one in real time may come late.
        while world.measured().time_s < asked_s + reaching.arrives_in_s / 2.0:
            hand = hand_xyz(bus)
            early = world.measured().time_s < asked_s + 0.9 * reaching.arrives_in_s
            assert not early or math.dist(hand, OVER_TABLE) > 0.01
            await asyncio.sleep(0.01)
        await passed(world, reaching.arrives_in_s)
        assert hand_xyz(bus) == pytest.approx(OVER_TABLE, abs=1e-6)
        back = await bus.call(Withdraw(person="anna", speed_m_s=1.5), to="cell")
        assert back.hand_m == ANNA.hand_rests
        await passed(world, back.arrives_in_s + 0.1)
        assert hand_xyz(bus) == pytest.approx(ANNA.hand_rests, abs=1e-6)
        assert (await bus.call(CountContacts(person="anna"), to="cell")).contacts == 0


@both_hosts_nightly
async def test_contacts_are_reported_by_the_names_of_the_bodies(host: str) -> None:
    async with with_bus(with_anna(one_arm())) as (world, bus):
        await bus.call(Reach(person="anna", hand_m=AT_LEFT_HAND, speed_m_s=1.0), to="cell")
        await passed(world, 1.6)
        count = await bus.call(CountContacts(person="anna"), to="cell")
        assert count.contacts > 0
        assert all(own.startswith("anna/") and other.startswith("left/") for own, other in count.pairs)


@pytest.mark.virtual
async def test_people_are_drawn_fixed_to_frames_that_move() -> None:
    async with with_bus(with_anna(SimScene())) as (_, bus):
        scene = bus.topic("cell/scene", SceneDescription).latest
        frames = bus.topic("cell/frames", FramePoses).latest
        assert scene is not None
        assert frames is not None
        drawn = [geometry for geometry in scene.geometries if geometry.frame.startswith("anna/")]
        assert {geometry.frame for geometry in drawn} == {"anna/upper_arm", "anna/forearm", "anna/hand"}
        assert {geometry.frame for geometry in drawn} <= set(frames.names)
        (shoulder,) = (geometry for geometry in drawn if geometry.name == "anna/shoulder")
        upper = frames.names.index("anna/upper_arm")
        assert math.dist(frames.xyz[upper], ANNA.shoulder) == pytest.approx(np.linalg.norm(shoulder.xyz))


@pytest.mark.virtual
async def test_what_an_arm_cannot_do_is_refused_with_the_reason_and_nothing_moves() -> None:
    async with with_bus(with_anna(SimScene())) as (_, bus):
        with pytest.raises(SkillFailed, match=r"anna cannot reach \(0.000, 0.500, 0.100\): it is 1.202 m from") as far:
            await bus.call(Reach(person="anna", hand_m=(0.0, 0.5, 0.1)), to="cell")
        assert "the shoulder is at (0.000, -0.650, 0.450)" in str(far.value)
        with pytest.raises(SkillFailed, match="passes through the shoulder"):
            await bus.call(Reach(person="anna", hand_m=(0.0, -0.7, 0.75)), to="cell")
        with pytest.raises(SkillFailed, match="there is no person hanna") as unknown:
            await bus.call(Reach(person="hanna", hand_m=OVER_TABLE), to="cell")
        assert "did you mean anna?" in str(unknown.value)
        await asyncio.sleep(1.0)
        assert hand_xyz(bus) == pytest.approx(ANNA.hand_rests, abs=1e-12)


@pytest.mark.virtual
async def test_a_place_from_where_the_way_back_leads_through_the_shoulder_is_refused_for_a_visit_only() -> None:
    """Round the shoulder in two reaches: there she can stay, she does not come back by herself."""
    behind = (0.0, -0.7, 0.75)
    async with with_bus(with_anna(SimScene())) as (_, bus):
        aside = await bus.call(Reach(person="anna", hand_m=(0.3, -0.65, 0.45)), to="cell")
        await asyncio.sleep(aside.arrives_in_s)
        with pytest.raises(SkillFailed, match="through the shoulder"):
            await bus.call(Reach(person="anna", hand_m=behind, stay_s=1.0), to="cell")
        await bus.call(Reach(person="anna", hand_m=behind), to="cell")


@pytest.mark.virtual
async def test_a_cell_without_people_does_not_answer_for_them() -> None:
    async with with_bus(SimScene()) as (_, bus):
        with pytest.raises(NoSuchSkill):
            await bus.call(CountContacts(person="anna"), to="cell")


def test_a_run_that_is_resumed_finds_the_hand_on_its_way_and_it_goes_on() -> None:
    scene = with_anna(one_arm())

    async def lost() -> bytes:
        async with with_bus(scene) as (world, bus):
            await bus.call(Reach(person="anna", hand_m=OVER_TABLE, stay_s=0.5), to="cell")
            await asyncio.sleep(0.4)
            return world.snapshot()

    async def resumed(snapshot: bytes) -> tuple[Vector3, Vector3, Vector3]:
        async with with_bus(scene) as (world, bus):
            await world.restore(snapshot)
            there = hand_xyz(bus)
            arrives_in_s = world.measured().person("anna").arrives_in_s
            await asyncio.sleep(arrives_in_s + 0.1)
            reached = hand_xyz(bus)
            await asyncio.sleep(2.0)
            return there, reached, hand_xyz(bus)

    snapshot = run_virtual(lost())
    there, reached, last = run_virtual(resumed(snapshot))
    assert 0.05 < math.dist(there, ANNA.hand_rests) < math.dist(OVER_TABLE, ANNA.hand_rests) - 0.05
    assert reached == pytest.approx(OVER_TABLE, abs=1e-6)
    assert last == pytest.approx(ANNA.hand_rests, abs=1e-6)
    assert run_virtual(resumed(snapshot)) == (there, reached, last)
