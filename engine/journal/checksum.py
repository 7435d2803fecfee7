"""Checksums over the data of a run, which detect a changed byte and locate it.

The checksum of each row of events covers the row and the checksum of the row before it. The last checksum of this chain
is stored with the run: a changed, moved or missing row breaks the chain at the first row affected. The checksums detect
damage, not manipulation: anybody who can write the journal can recompute them.
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
    """Return the start value of the chain of a run."""
    return blake2b(run.encode(), digest_size=SIZE).digest()


def event_checksum(before: bytes, seq: int, time_s: float, epoch: int, data: bytes) -> bytes:
    """Return the checksum of a row of one event (format 4) whose predecessor has the checksum `before`."""
    return blake2b(before + _EVENT.pack(seq, time_s, epoch) + data, digest_size=SIZE).digest()


def block_checksum(before: bytes, seq: int, last: int, epoch: int, sums: bytes, data: bytes) -> bytes:
    """Return the checksum of a row of several events whose predecessor has the checksum `before`."""
    # One call over one buffer: every event passes through here.
    head = _BLOCK.pack(seq, last, epoch, len(sums))
    return blake2b(b"".join((before, head, sums, data)), digest_size=SIZE).digest()


def checksum_of(values: Iterable[str | bytes | float | None]) -> bytes:
    """Return the checksum of the columns of a row."""
    digest = blake2b(digest_size=SIZE)
    for value in values:
        data = value if isinstance(value, bytes) else repr(value).encode()
        digest.update(struct.pack("<Q", len(data)) + data)
    return digest.digest()
