"""Blocks of a capture: written out by hand from the specification, cut off, and any bytes."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.io.wire.pcapng_blocks import (
    CaptureBlock,
    CaptureDamaged,
    CapturedPacket,
    CaptureInterface,
    CaptureSection,
    CaptureStatistics,
    decode_blocks,
    encode_block,
)
from robots.io.wire.read_capture import decode_capture
from tests.tiers import examples

MANY = settings(max_examples=examples(200, nightly=10_000))
BLOCKS: list[CaptureBlock] = [
    CaptureSection(comment="times", application="flexcell"),
    CaptureInterface(link_type=101, device="left/gripper", protocol="modbus_tcp"),
    CapturedPacket(time_ns=1_790_000_000_123_456_789, data=b"abcde", outbound=True),
    CapturedPacket(time_ns=1_790_000_001_000_000_000, data=b"", outbound=False),
    CaptureStatistics(time_ns=1_790_000_002_000_000_000, received=2, dropped=7),
]
# Section: type, length, byte-order magic, version 1.0, section length unknown, comment, application, end, length.
GOLDEN = [
    (
        CaptureSection(comment="ab", application="flexcell"),
        "0A0D0D0A 34000000 4D3C2B1A 0100 0000 FFFFFFFFFFFFFFFF 0100 0200 61620000 0400 0800 666C657863656C6C"
        " 0000 0000 34000000",
    ),
    # Interface: type, length, link type, reserved, snap length, name, description, resolution of 10⁻⁹, end, length.
    (
        CaptureInterface(link_type=250, device="arm", protocol="rtu"),
        "01000000 30000000 FA00 0000 00000000 0200 0300 61726D00 0300 0300 72747500"
        " 0900 0100 09000000 0000 0000 30000000",
    ),
    # Packet: type, length, interface, time high and low, lengths, data, epb_flags outbound, end, length.
    (
        CapturedPacket(time_ns=(2 << 32) + 3, data=b"\x01\x02\x03\x04\x05", outbound=True),
        "06000000 34000000 00000000 02000000 03000000 05000000 05000000 0102030405000000 0200 0400 02000000"
        " 0000 0000 34000000",
    ),
    # Statistics: type, length, interface, time, isb_ifrecv, isb_ifdrop, end, length.
    (
        CaptureStatistics(time_ns=5, received=9, dropped=1),
        "05000000 34000000 00000000 00000000 05000000 0400 0800 0900000000000000 0500 0800 0100000000000000"
        " 0000 0000 34000000",
    ),
]


@pytest.mark.parametrize(("block", "text"), GOLDEN)
def test_a_block_has_the_bytes_of_the_specification(block: CaptureBlock, text: str) -> None:
    assert encode_block(block) == bytes.fromhex(text)


def test_blocks_survive_their_bytes() -> None:
    data = b"".join(encode_block(each) for each in BLOCKS)
    assert list(decode_blocks(data)) == BLOCKS


def test_blocks_of_other_programs_are_skipped() -> None:
    name_resolution = bytes.fromhex("04000000 10000000 00000000 10000000")
    head, *rest = (encode_block(each) for each in BLOCKS)
    assert list(decode_blocks(head + name_resolution + b"".join(rest))) == BLOCKS


def test_a_file_that_is_cut_off_ends_with_its_last_whole_block() -> None:
    data = b"".join(encode_block(each) for each in BLOCKS)
    ends = [len(data) - len(encode_block(BLOCKS[-1])), len(data)]
    assert list(decode_blocks(data[: ends[0] + 3])) == BLOCKS[:-1]
    assert list(decode_blocks(data[: ends[1] - 1])) == BLOCKS[:-1]


@pytest.mark.parametrize(
    ("at", "to", "message"),
    [
        (0, b"\x00", "offset 0: no section header"),
        (8, b"\x1a\x2b\x3c\x4d", "offset 8: not little-endian"),
        (4, b"\x03", "offset 0: a block of 3 bytes"),
        (-4, b"\x00", "offset 216: the lengths of a block at its ends differ"),
    ],
)
def test_damage_is_named_with_its_offset(at: int, to: bytes, message: str) -> None:
    data = bytearray(b"".join(encode_block(each) for each in BLOCKS))
    at %= len(data)
    data[at : at + len(to)] = to
    with pytest.raises(CaptureDamaged, match=message):
        list(decode_blocks(bytes(data)))


@MANY
@given(st.binary(max_size=200))
def test_any_bytes_are_a_capture_or_an_error_by_name(data: bytes) -> None:
    with pytest.raises(CaptureDamaged):
        decode_capture(data)


@MANY
@given(st.lists(st.tuples(st.integers(0, 400), st.integers(0, 255)), min_size=1, max_size=5))
def test_a_spoiled_capture_is_read_or_an_error_by_name(changes: list[tuple[int, int]]) -> None:
    data = bytearray(b"".join(encode_block(each) for each in BLOCKS))
    for at, value in changes:
        data[at % len(data)] = value
    message = "offset "
    try:
        list(decode_blocks(bytes(data)))
    except CaptureDamaged as error:
        message = str(error)
    assert message.startswith("offset ")
