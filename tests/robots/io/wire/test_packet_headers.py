"""Packets around captured bytes: headers with true ports and checksums, and back."""

from __future__ import annotations

import pytest

from robots.io.wire.packet_headers import PacketEncoder, Transport, decode_packet
from robots.io.wire.pcapng_blocks import CaptureDamaged, CapturedPacket
from robots.io.wire.wire_tap import WireEndpoints, WireEvent
from tests.robots.io.wire.wire_events import TCP4, TCP6, UDP, event


def packets(transport: Transport, *events: WireEvent) -> tuple[list[CapturedPacket], int]:
    encoder = PacketEncoder(transport)
    return [packet for each in events for packet in encoder.packets(each, time_ns=each.time_ns)], encoder.link_type


def decoded(transport: Transport, *events: WireEvent) -> list[WireEvent]:
    written, link_type = packets(transport, *events)
    found = [decode_packet(packet, link_type) for packet in written]
    assert {spoken for spoken, _ in found} == {transport}
    return [each for _, each in found]


@pytest.mark.parametrize(("transport", "ends"), [("tcp", TCP4), ("tcp", TCP6), ("serial", None)])
def test_events_of_a_connection_survive_their_packets(transport: Transport, ends: WireEndpoints | None) -> None:
    events = [
        event("opened", endpoints=ends),
        event("sent", b"\x00\x01", endpoints=ends),
        event("received", b"\x02", endpoints=ends),
        event("closed", endpoints=ends),
    ]
    found = decoded(transport, *events)
    assert [(each.kind, each.data, each.endpoints) for each in found] == [
        (each.kind, each.data, ends) for each in events
    ]


def test_datagrams_have_their_own_ports_each_and_no_opening() -> None:
    other = WireEndpoints(local=("127.0.0.1", 15000), remote=("127.0.0.2", 50000))
    found = decoded(
        "udp",
        event("sent", b"a", endpoints=UDP),
        event("received", b"b", endpoints=other),
        event("closed", endpoints=UDP),
    )
    assert [(each.kind, each.data, each.endpoints) for each in found] == [
        ("sent", b"a", UDP),
        ("received", b"b", other),
    ]


def test_a_tcp_segment_has_the_bytes_of_the_standards() -> None:
    """IPv4 of 42 bytes, not fragmented, 64 hops, TCP; then ports, sequence numbers behind the SYN, PSH and ACK."""
    (opened, sent, received), _ = packets(
        "tcp", event("opened"), event("sent", b"\xab\xcd"), event("received", b"\x01")
    )
    assert opened.data[33] == 0x02
    assert sent.data == bytes.fromhex(
        "45 00 00 2A 00 00 40 00 40 06 B7 70 C0 A8 01 02 C0 A8 01 0B9C 41 01 F6 00 00 00 01 00 00 00 00 50 18 FF FF"
    ) + sent.data[36:38] + bytes.fromhex("00 00 AB CD")
    assert received.data[20:32] == bytes.fromhex("01 F6 9C 41 00 00 00 00 00 00 00 03")


@pytest.mark.parametrize(("transport", "ends", "protocol"), [("tcp", TCP4, 6), ("tcp", TCP6, 6), ("udp", UDP, 17)])
def test_the_checksums_are_right(transport: Transport, ends: WireEndpoints, protocol: int) -> None:
    """The sum over all that a checksum covers, and itself, is all ones."""
    (packet,), _ = packets(transport, event("sent", b"\x01\x02\x03", endpoints=ends))
    is_v4 = packet.data[0] >> 4 == 4
    head = 20 if is_v4 else 40
    if is_v4:
        assert _ones(packet.data[:20]) == 0xFFFF
    body = packet.data[head:]
    addresses = packet.data[12:20] if is_v4 else packet.data[8:40]
    assert _ones(addresses + protocol.to_bytes(2) + len(body).to_bytes(2) + body) == 0xFFFF


def test_a_serial_line_has_the_header_of_an_rtac() -> None:
    """Seconds and microseconds, 1 for sent and 2 for received bytes, lines, two bytes of nothing."""
    sent, received = (event(kind, b"\x09\x03", endpoints=None, time_ns=5_000_007_000) for kind in ("sent", "received"))
    written, link_type = packets("serial", sent, received)
    assert link_type == 250
    assert [packet.data for packet in written] == [
        bytes.fromhex("00000005 00000007 01 10 0000 0903"),
        bytes.fromhex("00000005 00000007 02 10 0000 0903"),
    ]


def test_a_long_message_is_several_packets() -> None:
    script = bytes(range(256)) * 300
    found = decoded("tcp", event("opened"), event("sent", script))
    assert len(found) == 4
    assert b"".join(each.data for each in found) == script


@pytest.mark.parametrize(("data", "link_type"), [(b"", 101), (b"\x45" * 12, 101), (b"\x01", 250), (b"abc", 1)])
def test_packets_of_others_are_an_error_by_name(data: bytes, link_type: int) -> None:
    with pytest.raises(CaptureDamaged, match="offset 8: "):
        decode_packet(CapturedPacket(time_ns=0, data=data, outbound=True, offset=8), link_type)


def _ones(data: bytes) -> int:
    total = sum(int.from_bytes((data + b"\0")[at : at + 2]) for at in range(0, len(data), 2))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return total
