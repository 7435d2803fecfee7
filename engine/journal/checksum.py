"""Checksums over what a journal holds of a run, so that a changed byte is found and told with its place.

Each event has one over its row and over the checksum of the event before it. The last of this chain is kept beside the
run: what is changed, put elsewhere, or missing breaks it at the first event that it concerns. They find damage; who
changes a journal on purpose can make them anew.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from hashlib import blake2b

SIZE = 16
"""Bytes of a checksum."""
_ROW = struct.Struct("<qdq")


def chain_start(run: str) -> bytes:
    """Return what the first event of a run is chained to."""
    return blake2b(run.encode(), digest_size=SIZE).digest()


def next_checksum(before: bytes, seq: int, time_s: float, epoch: int, data: bytes) -> bytes:
    """Return the checksum of an event whose predecessor has `before`."""
    # One call over one piece of bytes: every event comes through here.
    return blake2b(before + _ROW.pack(seq, time_s, epoch) + data, digest_size=SIZE).digest()


def checksum_of(values: Iterable[str | bytes | float | None]) -> bytes:
    """Return the checksum of the columns of a row."""
    digest = blake2b(digest_size=SIZE)
    for value in values:
        data = value if isinstance(value, bytes) else repr(value).encode()
        digest.update(struct.pack("<Q", len(data)) + data)
    return digest.digest()
