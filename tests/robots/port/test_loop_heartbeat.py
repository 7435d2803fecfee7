"""The engine's side of a heartbeat, in virtual time."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Iterator

import pytest

from robots.port.heartbeat import CONTROL_SILENCE_S, PULSE_S, Heartbeat, new_heartbeat_file
from robots.port.loop_heartbeat import LoopHeartbeat


@pytest.fixture
def shared() -> Iterator[Heartbeat]:
    """The memory of a connection whose control process has begun."""
    descriptor = new_heartbeat_file()
    heartbeat = Heartbeat(descriptor)
    os.close(descriptor)
    heartbeat.beat_control()
    yield heartbeat
    heartbeat.close()


@pytest.mark.virtual
async def test_the_loop_pulses_as_long_as_it_turns_and_the_control_process_is_heard(shared: Heartbeat) -> None:
    silences: list[float] = []
    heartbeat = LoopHeartbeat(shared, on_silence=silences.append)
    heartbeat.begin()
    for _ in range(100):
        await asyncio.sleep(0.2)
        shared.beat_control()
    heartbeat.end()
    pulses = shared.engine_count
    await asyncio.sleep(1.0)
    assert silences == []
    assert pulses == shared.engine_count == pytest.approx(20.0 / PULSE_S, abs=2)


@pytest.mark.virtual
async def test_a_control_process_that_stands_still_is_reported_once_within_three_tenths_of_a_second(
    shared: Heartbeat,
) -> None:
    loop, silences = asyncio.get_running_loop(), list[float]()
    told = asyncio.Event()

    def silent(silent_s: float) -> None:
        silences.append(silent_s)
        told.set()

    LoopHeartbeat(shared, on_silence=silent).begin()
    began_s = loop.time()
    await told.wait()
    assert loop.time() - began_s <= 0.3
    assert CONTROL_SILENCE_S <= silences[0] <= 0.3
    await asyncio.sleep(1.0)
    assert len(silences) == 1


@pytest.mark.virtual
async def test_a_command_pulses_at_once_and_not_after_the_end(shared: Heartbeat) -> None:
    heartbeat = LoopHeartbeat(shared, on_silence=lambda _: None)
    heartbeat.begin()
    heartbeat.pulse()
    assert shared.engine_count == 2
    heartbeat.end()
    heartbeat.pulse()
    assert shared.engine_count == 2
