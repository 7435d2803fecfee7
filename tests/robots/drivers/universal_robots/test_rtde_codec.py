"""Packets of RTDE: bytes worked out by hand from the tables of the protocol, and any values there and back."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.drivers.universal_robots.rtde_codec import (
    RecipeCodec,
    RtdeMessageLevel,
    RtdePacket,
    RtdePacketError,
    RtdePacketType,
    RtdeValue,
    read_frequency,
    read_names,
    recipe_reply,
    split_packets,
    text_message,
)

GOLDEN = [
    ("version request", RtdePacket(RtdePacketType.PROTOCOL_VERSION, b"\x00\x02"), "0005 56 0002"),
    ("version reply", RtdePacket(RtdePacketType.PROTOCOL_VERSION, b"\x01"), "0004 56 01"),
    ("controller version request", RtdePacket(RtdePacketType.CONTROLLER_VERSION), "0003 76"),
    (
        "controller version 3.15.8.106339",
        RtdePacket(RtdePacketType.CONTROLLER_VERSION, bytes.fromhex("00000003 0000000f 00000008 00019f63")),
        "0013 76 00000003 0000000f 00000008 00019f63",
    ),
    (
        "outputs at 125 Hz",
        RtdePacket(RtdePacketType.SETUP_OUTPUTS, bytes.fromhex("405f400000000000") + b"timestamp,"),
        "0015 4f 405f400000000000 74696d657374616d70 2c",
    ),
    ("outputs reply", RtdePacket(RtdePacketType.SETUP_OUTPUTS, recipe_reply(1, ["DOUBLE"])), "000a 4f 01 444f55424c45"),
    (
        "inputs",
        RtdePacket(RtdePacketType.SETUP_INPUTS, b"input_int_register_0"),
        "0017 49 696e7075745f696e745f72656769737465725f30",
    ),
    (
        "inputs in use",
        RtdePacket(RtdePacketType.SETUP_INPUTS, recipe_reply(0, ["IN_USE"])),
        "000a 49 00 494e5f555345",
    ),
    ("start", RtdePacket(RtdePacketType.START), "0003 53"),
    ("started", RtdePacket(RtdePacketType.START, b"\x01"), "0004 53 01"),
    ("pause", RtdePacket(RtdePacketType.PAUSE), "0003 50"),
    ("data", RecipeCodec(2, ["INT32", "DOUBLE"]).pack([-2, 1.5]), "0010 55 02 fffffffe 3ff8000000000000"),
    (
        "data of a mask",
        RecipeCodec(5, ["INT32", "UINT8", "UINT8"]).pack([0, 0xFF, 0x08]),
        "000a 55 05 00000000 ff 08",
    ),
    (
        "message",
        text_message("no", "RTDE", RtdeMessageLevel.ERROR),
        "000c 4d 02 6e6f 04 52544445 01",
    ),
]


@pytest.mark.parametrize(("packet", "frame"), [row[1:] for row in GOLDEN], ids=[row[0] for row in GOLDEN])
def test_a_packet_has_the_bytes_of_the_tables(packet: RtdePacket, frame: str) -> None:
    """And these bytes are the packet again."""
    assert packet.encode().hex() == frame.replace(" ", "")
    assert split_packets(bytearray.fromhex(frame)) == [packet]


VALUES: dict[str, st.SearchStrategy[RtdeValue]] = {
    "BOOL": st.booleans(),
    "UINT8": st.integers(0, 2**8 - 1),
    "UINT32": st.integers(0, 2**32 - 1),
    "UINT64": st.integers(0, 2**64 - 1),
    "INT32": st.integers(-(2**31), 2**31 - 1),
    "DOUBLE": st.floats(allow_nan=False),
    "VECTOR3D": st.tuples(*[st.floats(allow_nan=False)] * 3),
    "VECTOR6D": st.tuples(*[st.floats(allow_nan=False)] * 6),
    "VECTOR6INT32": st.tuples(*[st.integers(-(2**31), 2**31 - 1)] * 6),
    "VECTOR6UINT32": st.tuples(*[st.integers(0, 2**32 - 1)] * 6),
}
ROWS = st.lists(
    st.sampled_from(sorted(VALUES)).flatmap(lambda kind: st.tuples(st.just(kind), VALUES[kind])), max_size=9
)


@given(ROWS, st.integers(1, 255))
def test_values_come_back_as_they_were_packed(rows: list[tuple[str, RtdeValue]], recipe: int) -> None:
    """Of every type, in any order."""
    codec = RecipeCodec(recipe, [kind for kind, _ in rows])
    values = [value for _, value in rows]
    assert codec.unpack(codec.pack(values).payload) == values


@given(st.lists(st.builds(RtdePacket, st.integers(0, 255), st.binary(max_size=60)), max_size=6), st.integers(1, 30))
def test_packets_are_the_same_however_they_are_cut(packets: list[RtdePacket], piece: int) -> None:
    """A stream has no borders."""
    stream = b"".join(packet.encode() for packet in packets)
    received = bytearray()
    split: list[RtdePacket] = []
    for start in range(0, len(stream), piece):
        received += stream[start : start + piece]
        split += split_packets(received)
    assert split == packets
    assert not received


@given(st.binary(max_size=300))
def test_any_bytes_are_packets_or_an_error_by_name(stream: bytes) -> None:
    """What is left over is less than a packet."""
    received = bytearray(stream)
    try:
        packets = split_packets(received)
    except RtdePacketError:
        assert int.from_bytes(received[:2], "big") < 3
        return
    assert b"".join(packet.encode() for packet in packets) + bytes(received) == stream


@given(st.binary(max_size=40))
def test_any_payload_of_a_set_up_is_read_or_refused_by_name(payload: bytes) -> None:
    """Names are ASCII, and a frequency has eight bytes."""
    try:
        frequency, rest = read_frequency(payload)
        names = read_names(rest)
    except RtdePacketError:
        return
    assert isinstance(frequency, float)
    assert all(name.isascii() for name in names)


@pytest.mark.parametrize(
    ("payload", "message"),
    [
        (b"\x02\x00\x00\x00", "have 4 bytes; the recipe has 5"),
        (b"\x03\x00\x00\x00\x01", "data of recipe 3 where recipe 2 is expected"),
    ],
)
def test_data_of_another_recipe_are_refused(payload: bytes, message: str) -> None:
    """By what differs."""
    with pytest.raises(RtdePacketError, match=message):
        RecipeCodec(2, ["INT32"]).unpack(payload)


@pytest.mark.parametrize("value", [2**31, math.nan, "1"])
def test_a_value_that_does_not_fit_is_refused(value: RtdeValue) -> None:
    """Before it is sent."""
    with pytest.raises(RtdePacketError, match="do not fit recipe 1"):
        RecipeCodec(1, ["INT32"]).pack([value])
