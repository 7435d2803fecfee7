"""Topics keep the latest message and never let a subscriber hurt the publisher."""

from __future__ import annotations

import asyncio
import logging

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.errors import BusError
from engine.messages import GripperState, PartPoses


def _state(width_m: float) -> GripperState:
    return GripperState(time_s=0.0, width_m=width_m, force_n=0.0, held=False)


async def test_latest_is_what_was_published_last() -> None:
    """A late reader gets the newest value without waiting."""
    topic = SkillBus(new_clock()).topic("left/gripper/state", GripperState)
    assert topic.latest is None
    topic.publish(_state(0.01))
    topic.publish(_state(0.02))
    assert topic.latest == _state(0.02)


async def test_a_message_of_another_type_is_refused() -> None:
    """The topic's type is its contract."""
    topic = SkillBus(new_clock()).topic("t", GripperState)
    with pytest.raises(BusError, match="PartPoses was published where GripperState is expected"):
        topic.publish(PartPoses(time_s=0.0, poses={}))  # pyright: ignore[reportArgumentType]


async def test_one_name_carries_one_type() -> None:
    """Asking for a topic with another type names both."""
    bus = SkillBus(new_clock())
    bus.topic("t", GripperState)
    with pytest.raises(BusError, match="carries GripperState, not PartPoses"):
        bus.topic("t", PartPoses)


async def test_a_failing_subscriber_is_left_out_and_the_others_go_on(caplog: pytest.LogCaptureFixture) -> None:
    """A robot's publisher survives a viewer's bug."""
    topic = SkillBus(new_clock()).topic("t", GripperState)
    seen: list[float] = []

    def broken(_: GripperState) -> None:
        raise RuntimeError("viewer bug")

    topic.subscribe(broken)
    topic.subscribe(lambda message: seen.append(message.width_m))
    with caplog.at_level(logging.CRITICAL, logger="flexcell.bus"):
        topic.publish(_state(0.01))
        topic.publish(_state(0.02))
    assert (seen, topic.subscriber_count) == ([0.01, 0.02], 1)


async def test_a_stream_drops_the_oldest_when_its_reader_is_slow() -> None:
    """Memory is bounded and the loss is counted."""
    topic = SkillBus(new_clock()).topic("t", GripperState)
    with topic.stream(size=2) as stream:
        for width_m in (0.01, 0.02, 0.03):
            topic.publish(_state(width_m))
        received = [(await stream.next()).width_m, (await stream.next()).width_m]
    assert (received, stream.dropped, topic.subscriber_count) == ([0.02, 0.03], 1, 0)


async def test_a_waiting_reader_wakes_with_the_next_message() -> None:
    """Streams are awaited, not polled."""
    topic = SkillBus(new_clock()).topic("t", GripperState)
    with topic.stream() as stream:
        waiting = asyncio.create_task(stream.next())
        await asyncio.sleep(0)
        topic.publish(_state(0.05))
        assert (await waiting).width_m == 0.05
        again = asyncio.create_task(stream.next())
        await asyncio.sleep(0)
        assert not again.done()
        topic.publish(_state(0.06))
        assert (await again).width_m == 0.06


async def test_a_provider_makes_the_latest_on_demand() -> None:
    """Publishers may skip messages that nobody reads."""
    topic = SkillBus(new_clock()).topic("t", GripperState)
    topic.provide(lambda: _state(0.07))
    assert topic.latest == _state(0.07)


@pytest.mark.virtual
async def test_the_rate_of_a_topic_is_that_of_its_last_messages() -> None:
    """None before the second; messages at one instant have no rate."""
    bus = SkillBus(new_clock())
    topic = bus.topic("t", GripperState)
    assert (topic.count, topic.latest_at_s, topic.rate_hz, topic.is_made_on_demand) == (0, None, 0.0, False)
    topic.publish(_state(0.01))
    topic.publish(_state(0.01))
    assert (topic.count, topic.rate_hz) == (2, 0.0)
    await asyncio.sleep(0.5)
    topic.publish(_state(0.01))
    await asyncio.sleep(0.5)
    topic.publish(_state(0.01))
    assert (topic.count, topic.rate_hz, topic.latest_at_s) == (4, pytest.approx(3.0), bus.clock.now_s())
    for _ in range(100):
        await asyncio.sleep(0.1)
        topic.publish(_state(0.01))
    assert topic.rate_hz == pytest.approx(10.0)


async def test_who_only_looks_on_has_no_messages_built_for_them() -> None:
    """They see what is published; whoever is closed sees nothing more, and a second closing is none."""
    topic, seen, asked = SkillBus(new_clock()).topic("t", GripperState), list[float](), list[float]()
    passive = topic.subscribe_passively(lambda message: seen.append(message.width_m))
    active = topic.subscribe(lambda message: asked.append(message.width_m))
    assert (topic.subscriber_count, topic.takes_commands) == (1, False)
    topic.publish(_state(0.01))
    active.close()
    active.close()
    topic.publish(_state(0.02))
    assert (seen, asked, topic.subscriber_count) == ([0.01, 0.02], [0.01], 0)
    passive.close()
    topic.publish(_state(0.03))
    assert seen == [0.01, 0.02]
