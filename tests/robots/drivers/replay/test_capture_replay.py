"""A replay: commands as they were recorded, polls and set points as often as the driver likes, and what differs."""

from __future__ import annotations

import pytest

from robots.drivers.replay.capture_replay import CaptureReplay, ReplayMismatch
from robots.drivers.replay.request_rules import REQUEST_RULES, STRICT, RequestKind
from robots.io.wire.packet_headers import Transport
from robots.io.wire.read_capture import CapturedConnection, CapturedEvent
from robots.io.wire.wire_tap import WireEventKind


def captured(*events: tuple[WireEventKind, bytes], transport: Transport = "tcp") -> CapturedConnection:
    """Return a capture with an event every 0.1 s, each at an offset of 100 more."""
    return CapturedConnection(
        device="device",
        protocol="urcap",
        transport=transport,
        events=tuple(
            CapturedEvent(time_s=0.1 * number, kind=kind, data=data, endpoints=None, offset=100 * number)
            for number, (kind, data) in enumerate(events)
        ),
        dropped=0,
    )


def replies(replay: CaptureReplay, *requests: bytes) -> list[bytes]:
    return [b"".join(each.data for each in replay.feed(request)) for request in requests]


MOVE = captured(
    ("opened", b""),
    ("sent", b"GET POS\n"),
    ("received", b"POS 3\n"),
    ("sent", b"GET POS\n"),
    ("received", b"POS 4\n"),
    ("sent", b"SET POS 255\n"),
    ("received", b"ack"),
    ("sent", b"GET POS\n"),
    ("received", b"POS 90\n"),
    ("sent", b"GET POS\n"),
    ("received", b"POS 230\n"),
)


def test_what_was_recorded_is_answered_in_order() -> None:
    replay = CaptureReplay(MOVE, REQUEST_RULES["urcap"])
    assert replay.open() == []
    poll, move = b"GET POS\n", b"SET POS 255\n"
    assert replies(replay, poll, poll, move, poll, poll) == [b"POS 3\n", b"POS 4\n", b"ack", b"POS 90\n", b"POS 230\n"]
    assert (replay.answered, replay.repeated, replay.remaining_commands) == (5, 0, 0)


def test_a_poll_is_answered_as_before_until_the_driver_sends_the_next_command() -> None:
    replay = CaptureReplay(MOVE, REQUEST_RULES["urcap"])
    replay.open()
    poll, move = b"GET POS\n", b"SET POS 255\n"
    assert replies(replay, poll, poll, poll, poll) == [b"POS 3\n", b"POS 4\n", b"POS 4\n", b"POS 4\n"]
    assert replay.remaining_commands == 1
    assert replies(replay, move, poll) == [b"ack", b"POS 90\n"]
    assert replay.repeated == 2


def test_a_command_may_come_before_polls_that_were_recorded() -> None:
    replay = CaptureReplay(MOVE, REQUEST_RULES["urcap"])
    replay.open()
    assert replies(replay, b"SET POS 255\n", b"GET POS\n") == [b"ack", b"POS 90\n"]


def test_another_command_is_named_with_offset_and_bytes() -> None:
    replay = CaptureReplay(MOVE, REQUEST_RULES["urcap"])
    replay.open()
    with pytest.raises(ReplayMismatch) as caught:
        replay.feed(b"SET POS 0\n")
    assert str(caught.value) == (
        "offset 500 of the capture, 0.500 s: recorded 53 45 54 20 50 4f 53 20 32 35 35 0a,"
        " received the command 53 45 54 20 50 4f 53 20 30 0a"
    )


def test_a_command_too_many_and_a_poll_that_was_never_answered_are_named() -> None:
    replay = CaptureReplay(MOVE, REQUEST_RULES["urcap"])
    replay.open()
    with pytest.raises(ReplayMismatch, match=r"received the poll 47 45 54 20 46 4c 54 0a"):
        replay.feed(b"GET FLT\n")
    replay.feed(b"SET POS 255\n")
    with pytest.raises(ReplayMismatch, match="is sent behind the last request of the capture, at offset 900"):
        replay.feed(b"SET POS 255\n")


def test_requests_may_arrive_in_pieces_and_together() -> None:
    replay = CaptureReplay(MOVE, REQUEST_RULES["urcap"])
    replay.open()
    assert replies(replay, b"GET P", b"OS\nGET POS\nSET", b" POS 255\n") == [b"", b"POS 3\nPOS 4\n", b"ack"]


def test_what_comes_unasked_keeps_its_delay_and_a_closed_connection_closes() -> None:
    replay = CaptureReplay(captured(("opened", b""), ("received", b"a"), ("received", b"b"), ("ended", b"")), STRICT)
    assert [(round(each.delay_s, 3), each.data, each.ends) for each in replay.open()] == [
        (0.1, b"a", False),
        (0.2, b"b", False),
        (0.3, b"", True),
    ]


def test_each_connection_is_the_next_recorded_one_and_then_the_first_again() -> None:
    replay = CaptureReplay(captured(("opened", b""), ("received", b"a"), ("opened", b""), ("received", b"b")), STRICT)
    assert [[each.data for each in replay.open()] for _ in range(3)] == [[b"a"], [b"b"], [b"a"]]


def test_set_points_may_have_any_values() -> None:
    board = captured(
        ("sent", b"GO\n"),
        ("received", b"OK 90.0 90.0 place\n"),
        ("sent", b"91.0 90.0\n"),
        ("received", b"OK 91.0 90.0 place\n"),
        ("sent", b"92.0 90.0\n"),
        ("received", b"HALT watchdog 91.0 90.0 place\n"),
        transport="serial",
    )
    replay = CaptureReplay(board, REQUEST_RULES["servo_lines"])
    found = replies(replay, b"GO\n", b"90.7 90.0\n", b"91.4 90.0\n", b"91.8 90.0\n")
    assert found[1:] == [b"OK 91.0 90.0 place\n", *[b"HALT watchdog 91.0 90.0 place\n"] * 2]


def test_an_answer_that_repeats_a_set_point_repeats_that_of_the_driver_and_another_ones_does_not() -> None:
    """The reference of a SoftHand: 100 is what was sent; 700 is that of another client."""
    ask, ours, foreign = (
        bytes.fromhex(text) for text in ("3A3A01028383", "3A3A01068300640000E7", "3A3A01068302BC00003D")
    )
    hand = captured(
        ("sent", bytes.fromhex("3A3A01068200640000E6")), ("sent", ask), ("received", ours), ("sent", ask),
        ("received", foreign), transport="serial",
    )  # fmt: skip
    replay = CaptureReplay(hand, REQUEST_RULES["softhand"])
    found = replies(replay, bytes.fromhex("3A3A01068200650000E7"), ask, ask)
    assert found == [b"", bytes.fromhex("3A3A01068300650000E6"), foreign]


def test_an_answer_of_modbus_tcp_repeats_the_number_of_the_request() -> None:
    read, status = (
        bytes.fromhex("0001 0000 0006 09 04 0000 0003"),
        bytes.fromhex("0001 0000 0009 09 04 06 310003030000"),
    )
    replay = CaptureReplay(captured(("opened", b""), ("sent", read), ("received", status)), REQUEST_RULES["modbus_tcp"])
    replay.open()
    assert replies(replay, b"\x00\x2a" + read[2:]) == [b"\x00\x2a" + status[2:]]


@pytest.mark.parametrize(
    ("protocol", "request_hex", "kind"),
    [
        ("modbus_rtu", "09 03 07 D0 00 03 04 0E", RequestKind.POLL),
        ("modbus_rtu", "09 10 03 E8 00 03 06 09 00 00 FF FF FF 42 29", RequestKind.COMMAND),
        ("modbus_rtu", "09 17 07 D0 00 03 03 E8 00 01 02 09 00 00 00", RequestKind.COMMAND),
        ("modbus_tcp", "00 01 00 00 00 06 09 04 00 00 00 03", RequestKind.POLL),
        ("softhand", "3A 3A 01 02 86 86", RequestKind.POLL),
        ("softhand", "3A 3A 01 03 80 03 83", RequestKind.COMMAND),
        ("softhand", "3A 3A 01 06 82 4A 38 00 00 F0", RequestKind.SET_POINT),
        ("servo_lines", b"?\n".hex(), RequestKind.POLL),
        ("servo_lines", b"pick\n".hex(), RequestKind.COMMAND),
        ("simple_message_motion", "40 00 00 00" + "00" * 64, RequestKind.COMMAND),
        ("simple_message_motion", "00 00 00 40" + "00" * 64, RequestKind.COMMAND),
        ("ur_outputs", "00 05 56 00 02", RequestKind.COMMAND),
        ("ur_inputs", "00 07 49 61 62 63 64", RequestKind.COMMAND),
        ("ur_inputs", "00 08 55 01 00 00 00 07", RequestKind.SET_POINT),
        ("ur_script", b"def one():\n  session = 7\n  if True:\n    sync()\n  end\nend\n".hex(), RequestKind.COMMAND),
        ("ur_secondary", b"sec one():\n  sync()\nend\n".hex(), RequestKind.COMMAND),
        ("hand_commands", "00 00 00 00 00 00 0E 00 00 00 03 00 39 30", RequestKind.COMMAND),
    ],
)
def test_a_request_ends_where_its_protocol_says(protocol: str, request_hex: str, kind: RequestKind) -> None:
    rule, request = REQUEST_RULES[protocol], bytes.fromhex(request_hex)
    assert rule.length(request + b"\xff") == len(request)
    assert {rule.length(request[:size]) for size in range(len(request))} == {0}
    assert rule.kind(request) is kind
    assert rule.split(request * 2) == [request, request]


@pytest.mark.parametrize(
    ("protocol", "recorded", "sent", "is_same"),
    [
        ("ur_script", b"def a():\n  session = 7\nend\n", b"def a():\n  session = 812\nend\n", True),
        ("ur_script", b"def a():\n  session = 7\nend\n", b"def b():\n  session = 7\nend\n", False),
        (
            "hand_commands",
            bytes.fromhex("0000 00000000 0E000000 0300 3930"),
            bytes.fromhex("0000 00000000 0E000000 0300 1027"),
            True,
        ),
        (
            "hand_commands",
            bytes.fromhex("0000 00000000 0E000000 0300 3930"),
            bytes.fromhex("0000 00000000 0E000000 0400 3930"),
            False,
        ),
    ],
)
def test_what_differs_from_session_to_session_is_not_compared(
    protocol: str, recorded: bytes, sent: bytes, *, is_same: bool
) -> None:
    rule = REQUEST_RULES[protocol]
    assert (rule.key(recorded) == rule.key(sent)) is is_same
