"""Packets around captured bytes, so that Wireshark dissects them: IP with TCP or UDP, or a serial line.

The headers of IP, TCP and UDP are ours: they have the true addresses, ports and bytes, and the numbers and checksums
that belong to them. Those on the network had others. A serial line has the header of an SEL RTAC (link type 250).
"""

from __future__ import annotations

import struct
from dataclasses import replace
from ipaddress import ip_address
from typing import Literal

from robots.io.wire.pcapng_blocks import CaptureDamaged, CapturedPacket
from robots.io.wire.wire_tap import Address, WireEndpoints, WireEvent, WireEventKind

LINK_IP, LINK_SERIAL = 101, 250
Transport = Literal["tcp", "udp", "serial"]

_TCP, _UDP = 6, 17
_FIN, _SYN, _ACK, _PUSH = 1, 2, 16, 8
_STATUS_CHANGE, _DATA_SENT, _DATA_RECEIVED = 0, 1, 2
_READY = 0x10
_LINE_HEADER = 12
_LARGEST = 32_768
_FLAGS: dict[WireEventKind, int] = {
    "opened": _SYN,
    "sent": _PUSH | _ACK,
    "received": _PUSH | _ACK,
    "ended": _FIN | _ACK,
    "closed": _FIN | _ACK,
}


class PacketEncoder:
    """Makes the packets of one connection, in the order of its events."""

    def __init__(self, transport: Transport) -> None:
        self.transport: Transport = transport
        self._sent = self._received = 0

    @property
    def link_type(self) -> int:
        """The type of all packets of the connection."""
        return LINK_SERIAL if self.transport == "serial" else LINK_IP

    def packets(self, event: WireEvent, *, time_ns: int) -> list[CapturedPacket]:
        """Return the packets of an event at a time since 1970."""
        parts = [event.data[start : start + _LARGEST] for start in range(0, len(event.data), _LARGEST)] or [b""]
        if self.transport == "udp" and event.kind in ("opened", "ended", "closed"):
            return []
        outbound = event.kind in ("opened", "sent", "closed")
        return [
            CapturedPacket(time_ns=time_ns, data=self._packet(replace(event, data=part)), outbound=outbound)
            for part in parts
        ]

    def _packet(self, event: WireEvent) -> bytes:
        if self.transport == "serial" or event.endpoints is None:
            return _line_packet(event)
        local, remote = event.endpoints.local, event.endpoints.remote
        outbound = event.kind in ("opened", "sent", "closed")
        source, target = (local, remote) if outbound else (remote, local)
        if self.transport == "udp":
            body = struct.pack("!HHHH", source[1], target[1], 8 + len(event.data), 0) + event.data
            return _ip_packet(source, target, _UDP, body, checksum_at=6)
        if event.kind == "opened":
            self._sent = self._received = 0
        own, other = (self._sent, self._received) if outbound else (self._received, self._sent)
        flags = _FLAGS[event.kind]
        head = struct.pack("!HHIIBBHHH", source[1], target[1], own, other, 5 << 4, flags, 0xFFFF, 0, 0)
        used = (len(event.data) + (1 if flags & (_SYN | _FIN) else 0)) % (1 << 32)
        if outbound:
            self._sent = (self._sent + used) % (1 << 32)
        else:
            self._received = (self._received + used) % (1 << 32)
        return _ip_packet(source, target, _TCP, head + event.data, checksum_at=16)


def decode_packet(packet: CapturedPacket, link_type: int) -> tuple[Transport, WireEvent]:
    """Return what a packet of ours says, with its time since 1970; raises CaptureDamaged."""
    try:
        if link_type == LINK_SERIAL:
            return _decode_line(packet)
        if link_type == LINK_IP:
            return _decode_ip(packet)
    except (struct.error, IndexError, ValueError) as error:
        raise CaptureDamaged(f"offset {packet.offset}: {error}") from error
    raise CaptureDamaged(f"offset {packet.offset}: link type {link_type} is not one of captures of this program")


def _line_packet(event: WireEvent) -> bytes:
    kind = {"sent": _DATA_SENT, "received": _DATA_RECEIVED}.get(event.kind, _STATUS_CHANGE)
    seconds, rest_ns = divmod(event.time_ns, 1_000_000_000)
    lines = _READY if event.kind != "closed" else 0
    return struct.pack("!IIBBH", seconds % (1 << 32), rest_ns // 1000, kind, lines, 0) + event.data


def _decode_line(packet: CapturedPacket) -> tuple[Transport, WireEvent]:
    _, _, event, lines, _ = struct.unpack_from("!IIBBH", packet.data)
    kinds: dict[int, WireEventKind] = {_DATA_SENT: "sent", _DATA_RECEIVED: "received"}
    kind = kinds.get(event, "opened" if lines else "closed")
    return "serial", WireEvent(time_ns=packet.time_ns, kind=kind, data=packet.data[_LINE_HEADER:])


def _ip_packet(source: Address, target: Address, protocol: int, body: bytes, *, checksum_at: int) -> bytes:
    source_ip, target_ip = ip_address(source[0]).packed, ip_address(target[0]).packed
    if len(source_ip) == 4:
        pseudo = source_ip + target_ip + struct.pack("!BBH", 0, protocol, len(body))
        head = struct.pack("!BBHHHBBH", 0x45, 0, 20 + len(body), 0, 0x4000, 64, protocol, 0) + source_ip + target_ip
        head = _with_checksum(head, 10, _sum(head))
    else:
        pseudo = source_ip + target_ip + struct.pack("!II", len(body), protocol)
        head = struct.pack("!IHBB", 6 << 28, len(body), protocol, 64) + source_ip + target_ip
    checksum = _sum(pseudo + body) or 0xFFFF
    return head + _with_checksum(body, checksum_at, checksum)


def _decode_ip(packet: CapturedPacket) -> tuple[Transport, WireEvent]:
    data = packet.data
    if data[0] >> 4 == 4:
        head, protocol = (data[0] & 15) * 4, data[9]
        source_ip, target_ip = data[12:16], data[16:20]
    else:
        head, protocol = 40, data[6]
        source_ip, target_ip = data[8:24], data[24:40]
    source_port, target_port = struct.unpack_from("!HH", data, head)
    source = (str(ip_address(source_ip)), source_port)
    target = (str(ip_address(target_ip)), target_port)
    ends = WireEndpoints(local=source, remote=target) if packet.outbound else WireEndpoints(local=target, remote=source)
    kind: WireEventKind = "sent" if packet.outbound else "received"
    if protocol == _UDP:
        return "udp", WireEvent(time_ns=packet.time_ns, kind=kind, data=data[head + 8 :], endpoints=ends)
    if protocol != _TCP:
        raise ValueError(f"protocol {protocol} is neither TCP nor UDP")
    flags = data[head + 13]
    if flags & _SYN:
        kind = "opened"
    elif flags & _FIN:
        kind = "closed" if packet.outbound else "ended"
    body = data[head + (data[head + 12] >> 4) * 4 :]
    return "tcp", WireEvent(time_ns=packet.time_ns, kind=kind, data=body, endpoints=ends)


def _sum(data: bytes) -> int:
    """Return the checksum of RFC 1071."""
    words = data + bytes(len(data) % 2)
    total = sum(struct.unpack(f"!{len(words) // 2}H", words))
    while total >> 16:
        total = (total & 0xFFFF) + (total >> 16)
    return ~total & 0xFFFF


def _with_checksum(data: bytes, at: int, checksum: int) -> bytes:
    return data[:at] + checksum.to_bytes(2) + data[at + 2 :]
