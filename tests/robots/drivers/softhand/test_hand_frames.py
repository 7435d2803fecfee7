"""Frames of a SoftHand: written out by hand, any that were encoded, and any bytes."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.drivers.softhand.emulation.emulated_hand import EmulatedHand
from robots.drivers.softhand.emulation.hand_session import HandSession, HandWire
from robots.drivers.softhand.emulation.kinematic_tendon import KinematicTendon
from robots.drivers.softhand.hand_frames import (
    MOTORS_ON,
    ChecksumError,
    HandCommandCode,
    HandFrame,
    decode_words,
    encode_frame,
    encode_words,
    take_frame,
)
from robots.io.wire.link_error import LinkError
from tests.tiers import examples

MANY = settings(max_examples=examples(200, nightly=25_000))
BYTE = st.integers(0, 255)
FRAMES = st.builds(HandFrame, unit=BYTE, command=BYTE, data=st.binary(max_size=60))
# `::`, address, bytes after this one, command, data, exclusive or of command and data.
GOLDEN = [
    (HandFrame(unit=1, command=HandCommandCode.PING), "3A 3A 01 02 00 00"),
    (HandFrame(unit=1, command=HandCommandCode.GET_CURRENTS_AND_MEASUREMENTS), "3A 3A 01 02 86 86"),
    (HandFrame(unit=1, command=HandCommandCode.ACTIVATE, data=MOTORS_ON), "3A 3A 01 03 80 03 83"),
    (
        HandFrame(unit=1, command=HandCommandCode.SET_INPUTS, data=encode_words(19000, 0)),
        "3A 3A 01 06 82 4A 38 00 00 F0",
    ),
    (
        HandFrame(unit=7, command=HandCommandCode.GET_INPUTS, data=encode_words(-2, 258)),
        "3A 3A 07 06 83 FF FE 01 02 81",
    ),
]


def session(*, active: bool = True) -> tuple[HandSession, EmulatedHand]:
    hand = EmulatedHand(lambda: 0.0, KinematicTendon(lambda: 0.0), active=active)
    return HandSession(HandWire(hand, unit=1)), hand


@pytest.mark.parametrize(("frame", "text"), GOLDEN)
def test_a_frame_has_these_bytes(frame: HandFrame, text: str) -> None:
    assert encode_frame(frame) == bytes.fromhex(text)
    buffer = bytearray.fromhex(text)
    assert (take_frame(buffer), buffer) == (frame, bytearray())


def test_the_emulator_answers_with_currents_before_positions() -> None:
    """Two currents, then three positions, big-endian."""
    served, hand = session()
    hand.follow(0)
    reply = served.feed(bytes.fromhex("3A 3A 01 02 86 86"))
    assert reply == bytes.fromhex("3A 3A 01 0C 86 00 3C 00 00 00 00 00 00 00 00 BA")


def test_a_wrong_checksum_and_another_address_are_not_obeyed() -> None:
    served, hand = session()
    good = bytes.fromhex("3A 3A 01 06 82 4A 38 00 00 F0")
    assert served.feed(good[:-1] + b"\xf1") == b""
    assert served.feed(good[:2] + b"\x02" + good[3:]) == b""
    assert hand.commands == 0
    served.feed(good)
    assert (hand.commands, hand.reference_ticks) == (1, 19000)


@MANY
@given(FRAMES)
def test_a_frame_survives_its_bytes(frame: HandFrame) -> None:
    buffer = bytearray(encode_frame(frame))
    assert (take_frame(buffer), buffer) == (frame, bytearray())


@MANY
@given(st.lists(FRAMES, max_size=4), st.integers(1, 9))
def test_frames_may_arrive_in_pieces(frames: list[HandFrame], size: int) -> None:
    sent = b"".join(encode_frame(frame) for frame in frames)
    buffer, received = bytearray(), list[HandFrame]()
    for start in range(0, len(sent), size):
        buffer.extend(sent[start : start + size])
        while (frame := take_frame(buffer)) is not None:
            received.append(frame)
    assert received == frames


@MANY
@given(st.binary(max_size=20).filter(lambda garbage: b":" not in garbage), FRAMES)
def test_garbage_before_a_frame_is_skipped(garbage: bytes, frame: HandFrame) -> None:
    assert take_frame(bytearray(garbage + encode_frame(frame))) == frame


@MANY
@given(FRAMES, st.integers(4, 63), st.integers(1, 255))
def test_a_flipped_byte_of_a_body_is_an_error_by_name(frame: HandFrame, place: int, flip: int) -> None:
    spoiled = bytearray(encode_frame(frame))
    place = 4 + (place - 4) % (len(spoiled) - 4)
    spoiled[place] ^= flip
    with pytest.raises(ChecksumError, match="the checksum of a frame is"):
        take_frame(spoiled)


@MANY
@given(st.lists(st.binary(max_size=40), max_size=8))
def test_no_bytes_crash_the_emulator_or_move_a_hand_that_is_off(chunks: list[bytes]) -> None:
    now_s = 0.0
    tendon = KinematicTendon(lambda: now_s)
    hand = EmulatedHand(lambda: now_s, tendon, active=False)
    served = HandSession(HandWire(hand, unit=1))
    for chunk in chunks:
        served.feed(chunk)
        now_s += 60.0
    tendon.measured()
    assert tendon.travel == 0.0 or hand.commands > 0


@MANY
@given(st.binary(max_size=60))
def test_any_bytes_are_frames_or_an_error_by_name(received: bytes) -> None:
    buffer = bytearray(received)
    for _ in range(len(received) + 1):
        try:
            if take_frame(buffer) is None:
                break
        except LinkError:
            continue
    assert len(buffer) <= len(received)


@MANY
@given(st.lists(st.integers(-32768, 32767), max_size=6))
def test_words_survive_their_bytes(words: list[int]) -> None:
    data = encode_words(*words)
    assert decode_words(data, len(words)) == tuple(words)
    with pytest.raises(LinkError, match="are not the"):
        decode_words(data, len(words) + 1)
