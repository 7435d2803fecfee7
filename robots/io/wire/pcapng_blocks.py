"""The blocks of a pcapng file that a capture consists of; little-endian, one interface a section.

The format is draft-ietf-opsawg-pcapng; blocks and options that are not ours are skipped.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

_SECTION, _INTERFACE, _STATISTICS, _PACKET = 0x0A0D0D0A, 1, 5, 6
_BYTE_ORDER = 0x1A2B3C4D
_ANY_LENGTH = 0xFFFF_FFFF_FFFF_FFFF
_COMMENT, _APPLICATION = 1, 4
_NAME, _DESCRIPTION, _RESOLUTION = 2, 3, 9
_FLAGS = 2
_RECEIVED, _DROPPED = 4, 5
_NANOSECONDS = 9
_INBOUND, _OUTBOUND = 1, 2
_LONGEST_BLOCK = 1 << 20


class CaptureDamaged(ValueError):
    """The bytes are no pcapng file, or not one of ours; says at which offset."""


@dataclass(frozen=True, kw_only=True)
class CaptureSection:
    """The head of a section: what was captured, by which program."""

    comment: str = ""
    application: str = ""


@dataclass(frozen=True, kw_only=True)
class CaptureInterface:
    """What was captured: the device, the protocol of its connection, and the type of the packets."""

    link_type: int
    device: str
    protocol: str


@dataclass(frozen=True, kw_only=True)
class CapturedPacket:
    """One packet; `time_ns` is since 1970, `offset` is where its block begins in the file."""

    time_ns: int
    data: bytes
    outbound: bool
    offset: int = field(default=0, compare=False)


@dataclass(frozen=True, kw_only=True)
class CaptureStatistics:
    """How many packets were noted, and how many of them were dropped."""

    time_ns: int
    received: int
    dropped: int


CaptureBlock = CaptureSection | CaptureInterface | CapturedPacket | CaptureStatistics


def encode_block(block: CaptureBlock) -> bytes:
    """Return the bytes of a block."""
    match block:
        case CaptureSection():
            head = struct.pack("<IHHQ", _BYTE_ORDER, 1, 0, _ANY_LENGTH)
            options = _options({_COMMENT: block.comment.encode(), _APPLICATION: block.application.encode()})
            return _block(_SECTION, head + options)
        case CaptureInterface():
            names = {_NAME: block.device.encode(), _DESCRIPTION: block.protocol.encode()}
            options = _options(names | {_RESOLUTION: bytes((_NANOSECONDS,))})
            return _block(_INTERFACE, struct.pack("<HHI", block.link_type, 0, 0) + options)
        case CapturedPacket():
            size = len(block.data)
            high, low = divmod(block.time_ns, 1 << 32)
            flags = struct.pack("<I", _OUTBOUND if block.outbound else _INBOUND)
            return _block(
                _PACKET, struct.pack("<5I", 0, high, low, size, size) + _padded(block.data) + _options({_FLAGS: flags})
            )
        case CaptureStatistics():
            high, low = divmod(block.time_ns, 1 << 32)
            counts = {_RECEIVED: struct.pack("<Q", block.received), _DROPPED: struct.pack("<Q", block.dropped)}
            return _block(_STATISTICS, struct.pack("<III", 0, high, low) + _options(counts))


def decode_blocks(data: bytes) -> Iterator[CaptureBlock]:
    """Yield the blocks of a file; one that is cut off at its end, as by a crash, ends it.

    Raises:
        CaptureDamaged: the bytes are no such file; says at which offset.
    """
    if len(data) < 12 or struct.unpack_from("<I", data)[0] != _SECTION:
        raise CaptureDamaged("offset 0: no section header of pcapng")
    if struct.unpack_from("<I", data, 8)[0] != _BYTE_ORDER:
        raise CaptureDamaged("offset 8: not little-endian, as captures of this program are")
    offset = 0
    while len(data) - offset >= 12:
        kind, length = struct.unpack_from("<II", data, offset)
        if length < 12 or length % 4 or length > _LONGEST_BLOCK:
            raise CaptureDamaged(f"offset {offset}: a block of {length} bytes")
        if offset + length > len(data):
            return
        if struct.unpack_from("<I", data, offset + length - 4)[0] != length:
            raise CaptureDamaged(f"offset {offset}: the lengths of a block at its ends differ")
        try:
            block = _decode(kind, data[offset + 8 : offset + length - 4], offset)
        except struct.error as error:
            raise CaptureDamaged(f"offset {offset}: a block of kind {kind} is too short") from error
        if block is not None:
            yield block
        offset += length


def _decode(kind: int, body: bytes, offset: int) -> CaptureBlock | None:
    match kind:
        case 0x0A0D0D0A:
            options = _decode_options(body, 16, offset)
            return CaptureSection(
                comment=_text(options.get(_COMMENT, b"")), application=_text(options.get(_APPLICATION, b""))
            )
        case 1:
            (link_type,) = struct.unpack_from("<H", body)
            options = _decode_options(body, 8, offset)
            if options.get(_RESOLUTION) != bytes((_NANOSECONDS,)):
                raise CaptureDamaged(f"offset {offset}: times are not nanoseconds, as in captures of this program")
            return CaptureInterface(
                link_type=link_type,
                device=_text(options.get(_NAME, b"")),
                protocol=_text(options.get(_DESCRIPTION, b"")),
            )
        case 6:
            _, high, low, size, _ = struct.unpack_from("<5I", body)
            if size > len(body) - 20:
                raise CaptureDamaged(f"offset {offset}: a packet of {size} bytes in a block of {len(body)}")
            options = _decode_options(body, 20 + size + -size % 4, offset)
            flags = options.get(_FLAGS, b"")
            outbound = len(flags) == 4 and int.from_bytes(flags, "little") & 3 == _OUTBOUND
            return CapturedPacket(
                time_ns=(high << 32) + low, data=body[20 : 20 + size], outbound=outbound, offset=offset
            )
        case 5:
            _, high, low = struct.unpack_from("<III", body)
            options = _decode_options(body, 12, offset)
            received, dropped = (int.from_bytes(options.get(each, b""), "little") for each in (_RECEIVED, _DROPPED))
            return CaptureStatistics(time_ns=(high << 32) + low, received=received, dropped=dropped)
        case _:
            return None


def _block(kind: int, body: bytes) -> bytes:
    length = struct.pack("<I", len(body) + 12)
    return struct.pack("<I", kind) + length + body + length


def _options(values: Mapping[int, bytes]) -> bytes:
    written = b"".join(struct.pack("<HH", code, len(value)) + _padded(value) for code, value in values.items() if value)
    return written + struct.pack("<HH", 0, 0)


def _decode_options(body: bytes, start: int, offset: int) -> dict[int, bytes]:
    options: dict[int, bytes] = {}
    while len(body) - start >= 4:
        code, size = struct.unpack_from("<HH", body, start)
        if code == 0:
            break
        if start + 4 + size > len(body):
            raise CaptureDamaged(f"offset {offset}: an option of {size} bytes does not fit its block")
        options[code] = body[start + 4 : start + 4 + size]
        start += 4 + size + -size % 4
    return options


def _padded(data: bytes) -> bytes:
    return data + bytes(-len(data) % 4)


def _text(value: bytes) -> str:
    return value.decode("utf-8", errors="replace")
