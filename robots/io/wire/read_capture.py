"""Reads a captured connection back."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from engine.errors import FlexcellError
from robots.io.wire.packet_headers import Transport, decode_packet
from robots.io.wire.pcapng_blocks import (
    CaptureDamaged,
    CapturedPacket,
    CaptureInterface,
    CaptureStatistics,
    decode_blocks,
)
from robots.io.wire.wire_tap import WireEndpoints, WireEventKind


@dataclass(frozen=True, kw_only=True)
class CapturedEvent:
    """One event; `time_s` is since the first of its file, `offset` is where it is in the file."""

    time_s: float
    kind: WireEventKind
    data: bytes
    endpoints: WireEndpoints | None
    offset: int


@dataclass(frozen=True, kw_only=True)
class CapturedConnection:
    """All that a file says of one connection; `start_s` is when its first event was, as the other files count."""

    device: str
    protocol: str
    transport: Transport
    events: tuple[CapturedEvent, ...]
    dropped: int
    start_s: float = 0.0


def read_capture(path: Path) -> CapturedConnection:
    """Read a capture.

    Raises:
        FlexcellError: it cannot be read, is not a capture of this program, or is empty.
    """
    try:
        return decode_capture(path.read_bytes())
    except OSError as error:
        raise FlexcellError(f"cannot be read: {error.strerror or error}", where=str(path)) from error
    except CaptureDamaged as error:
        hint = "a file that `--capture` has written is needed"
        raise FlexcellError(f"no capture of this program: {error}", where=str(path), hint=hint) from error


def decode_capture(data: bytes) -> CapturedConnection:
    """Return the connection in the bytes of a file; raises CaptureDamaged."""
    interface: CaptureInterface | None = None
    transport: Transport | None = None
    events: list[CapturedEvent] = []
    dropped = first_ns = 0
    for block in decode_blocks(data):
        match block:
            case CaptureInterface():
                interface = interface or block
            case CapturedPacket():
                if interface is None:
                    raise CaptureDamaged(f"offset {block.offset}: a packet before its interface")
                spoken, event = decode_packet(block, interface.link_type)
                transport = transport or spoken
                first_ns = first_ns or block.time_ns
                events.append(
                    CapturedEvent(
                        time_s=(block.time_ns - first_ns) / 1e9,
                        kind=event.kind,
                        data=event.data,
                        endpoints=event.endpoints,
                        offset=block.offset,
                    )
                )
            case CaptureStatistics():
                dropped = block.dropped
            case _:
                pass
    if interface is None or transport is None:
        raise CaptureDamaged("no packet in it")
    return CapturedConnection(
        device=interface.device,
        protocol=interface.protocol,
        transport=transport,
        events=tuple(events),
        dropped=dropped,
        start_s=first_ns / 1e9,
    )
