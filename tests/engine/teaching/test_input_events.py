"""The buttons of an input device: bytes however they are cut, and a device that goes away while one is held."""

from __future__ import annotations

import asyncio
import os
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import RobotError
from engine.teaching.button_device import button_events
from engine.teaching.input_events import ButtonEvent, EventReader

KEY, SYNC = 1, 0
PLAY, NEXT = 164, 163


def event(kind: int, code: int, value: int) -> bytes:
    return struct.pack("llHHi", 1_700_000_000, 250_000, kind, code, value)


@given(
    events=st.lists(
        st.tuples(st.sampled_from((KEY, SYNC, 4)), st.sampled_from((PLAY, NEXT, 30)), st.integers(0, 2)), max_size=30
    ),
    cuts=st.lists(st.integers(1, 60), max_size=30),
)
def test_how_the_bytes_are_cut_makes_no_difference(events: list[tuple[int, int, int]], cuts: list[int]) -> None:
    data = b"".join(event(*one) for one in events)
    whole = list(EventReader().feed(data))
    reader, pieces = EventReader(), list[ButtonEvent]()
    for cut in cuts:
        pieces += reader.feed(data[:cut])
        data = data[cut:]
    pieces += reader.feed(data)
    assert pieces == whole
    # A button goes down and up in turn.
    for button in {one.button for one in whole}:
        states = [one.pressed for one in whole if one.button == button]
        assert states == [i % 2 == 0 for i in range(len(states))]


async def test_a_device_tells_its_buttons_and_lets_go_of_them_when_it_goes_away(tmp_path: Path) -> None:
    fifo = tmp_path / "event0"
    os.mkfifo(fifo)
    told: list[ButtonEvent] = []
    second, third = asyncio.Event(), asyncio.Event()

    async def follow() -> None:
        async for one in button_events(fifo):
            told.append(one)
            if len(told) == 2:
                second.set()
            if len(told) == 3:
                third.set()

    keeper = os.open(fifo, os.O_RDWR | os.O_NONBLOCK)
    try:
        following = asyncio.create_task(follow())
        await asyncio.sleep(0)
        os.write(keeper, event(KEY, PLAY, 1) + event(SYNC, 0, 0) + event(KEY, PLAY, 2) + event(KEY, PLAY, 0))
        os.write(keeper, event(KEY, NEXT, 1)[:10])
        await second.wait()
        os.write(keeper, event(KEY, NEXT, 1)[10:])
        await third.wait()
    finally:
        os.close(keeper)
    await following
    assert told == [
        ButtonEvent(button="play_pause", pressed=True),
        ButtonEvent(button="play_pause", pressed=False),
        ButtonEvent(button="next", pressed=True),
        ButtonEvent(button="next", pressed=False),
    ]


async def test_a_device_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RobotError, match="cannot be opened") as refused:
        await anext(button_events(tmp_path / "event9"))
    assert refused.value.hint is not None
