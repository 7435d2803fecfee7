"""The messages of the Franka Hand: byte for byte those of libfranka, and never more than an error for other bytes."""

from __future__ import annotations

import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.drivers.franka_hand.hand_protocol import (
    HandReply,
    HandRequest,
    decode_state,
    encode_connect,
    encode_grasp,
    encode_homing,
    encode_move,
    encode_stop,
    take_message,
)
from robots.io.wire.link_error import LinkError

# What pylibfranka 0.21.3 sent: Gripper(host), homing(), move(0.03, 0.05), grasp(0.02, 0.1, 40, 0.005, 0.01), stop().
SENT_BY_LIBFRANKA = {
    "connect": "0000000000000e0000000300d7ae",
    "homing": "0100010000000a000000",
    "move": "0300020000001a000000b81e85eb51b89e3f9a9999999999a93f",
    "grasp": ("020003000000320000007b14ae47e17a943f7b14ae47e17a743f7b14ae47e17a843f9a9999999999b93f0000000000004440"),
    "stop": "0400040000000a000000",
}


def test_requests_are_those_of_libfranka() -> None:
    ours = {
        "connect": encode_connect(0, udp_port=0xAED7),
        "homing": encode_homing(1),
        "move": encode_move(2, width_m=0.03, speed_m_s=0.05),
        "grasp": encode_grasp(3, width_m=0.02, inner_m=0.005, outer_m=0.01, speed_m_s=0.1, force_n=40.0),
        "stop": encode_stop(4),
    }
    assert {name: message.hex() for name, message in ours.items()} == SENT_BY_LIBFRANKA


def test_a_reply_in_pieces_is_taken_when_it_is_whole() -> None:
    reply = bytes.fromhex("03000700000000000000")[:6] + (12).to_bytes(4, "little") + b"\x02\x00"
    buffer = bytearray(reply[:7])
    assert take_message(buffer) is None
    buffer.extend(reply[7:] + b"\x04")
    message = take_message(buffer)
    assert message is not None
    assert (message.request, message.number, message.status) == (HandRequest.MOVE, 7, HandReply.UNSUCCESSFUL)
    assert buffer == b"\x04"


def test_a_state_is_read_by_its_fields() -> None:
    # 4 bytes number, two doubles, a bool, a 16-bit temperature.
    datagram = bytes.fromhex("05000000" + "7b14ae47e17aa43f" + "7b14ae47e17ab43f" + "01" + "1e00")
    state = decode_state(datagram)
    assert state is not None
    assert (state.number, state.width_m, state.stroke_m) == (5, 0.04, 0.08)
    assert (state.is_grasping, state.temperature_c) == (True, 30)
    assert decode_state(datagram[:-1]) is None


@pytest.mark.parametrize("width_m", [math.nan, math.inf])
def test_a_state_whose_widths_are_no_numbers_is_none(width_m: float) -> None:
    assert decode_state(struct.pack("<IddBH", 5, width_m, 0.08, 1, 30)) is None
    assert decode_state(struct.pack("<IddBH", 5, 0.04, width_m, 1, 30)) is None


@given(st.binary(max_size=200))
def test_any_bytes_are_messages_or_an_error(received: bytes) -> None:
    buffer = bytearray(received)
    try:
        while (message := take_message(buffer)) is not None:
            assert message.request in HandRequest
    except LinkError:
        pass
    assert len(buffer) <= len(received)
    decode_state(received)


def test_a_hand_of_another_version_is_named() -> None:
    buffer = bytearray(bytes.fromhex("00000000000012000000" + "0100" + "0200" + "00000000"))
    message = take_message(buffer)
    assert message is not None
    with pytest.raises(LinkError, match="wrong version: the hand speaks version 2"):
        message.require_connection()
