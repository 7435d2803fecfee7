"""Frames survive any cutting of the byte stream; nonsense is refused."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.errors import RobotError
from robots.io.framing import Frame, FrameReader, frame_payload

FRAMES = st.tuples(st.integers(0, 2**32 - 1), st.binary(max_size=300))


@given(st.lists(FRAMES, max_size=20), st.lists(st.integers(1, 50), min_size=1))
def test_frames_arrive_whole_and_in_order_however_the_stream_is_cut(frames: list[Frame], cuts: list[int]) -> None:
    stream = b"".join(frame_payload(payload, number=number) for number, payload in frames)
    reader, received, at, turn = FrameReader(), list[Frame](), 0, 0
    while at < len(stream):
        size = cuts[turn % len(cuts)]
        received += reader.feed(stream[at : at + size])
        at, turn = at + size, turn + 1
    assert received == frames


def test_an_impossible_length_is_refused() -> None:
    with pytest.raises(RobotError, match="corrupt"):
        FrameReader().feed(b"\xff" * 8)
