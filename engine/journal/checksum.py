"""Checksums over what a journal holds of a run, so that a changed byte is found and told with its place.

Each row of events has one over itself and over the checksum of the row before it. The last of this chain is kept beside
the run: what is changed, put elsewhere, or missing breaks it at the first row that it concerns. They find damage; who
changes a journal on purpose can make them anew.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from hashlib import blake2b

SIZE = 16
"""Bytes of a checksum."""
_EVENT = struct.Struct("<qdq")
_BLOCK = struct.Struct("<qqqq")


def chain_start(run: str) -> bytes:
    """Return what the first row of a run is chained to."""
    return blake2b(run.encode(), digest_size=SIZE).digest()


def event_checksum(before: bytes, seq: int, time_s: float, epoch: int, data: bytes) -> bytes:
    """Return the checksum of a row of one event, as format 4 had them, whose predecessor has `before`."""
    return blake2b(before + _EVENT.pack(seq, time_s, epoch) + data, digest_size=SIZE).digest()


def block_checksum(before: bytes, seq: int, last: int, epoch: int, sums: bytes, data: bytes) -> bytes:
    """Return the checksum of a row of several events whose predecessor has `before`."""
    # One call over one piece of bytes: every event comes through here.
    head = _BLOCK.pack(seq, last, epoch, len(sums))
    return blake2b(b"".join((before, head, sums, data)), digest_size=SIZE).digest()


def checksum_of(values: Iterable[str | bytes | float | None]) -> bytes:
    """Return the checksum of the columns of a row."""
    digest = blake2b(digest_size=SIZE)
    for value in values:
        data = value if isinstance(value, bytes) else repr(value).encode()
        digest.update(struct.pack("<Q", len(data)) + data)
    return digest.digest()
