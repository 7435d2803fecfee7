"""Digests of the recorded events, by which a reader finds events that were altered after the run.

They protect against damage and careless edits, not against an author who computes them anew.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence

DIGESTS_NAME = "flexcell.digests"
"""Name of the MCAP metadata record of the digests, written when the recording is closed."""
_EVENTS = "events"
_BYTES = 4


class EventDigests:
    """Collects the digests of the events of a recording in their order."""

    def __init__(self) -> None:
        self._each = bytearray()

    def add(self, encoded: bytes) -> None:
        """Take the next event, as it is written."""
        self._each += event_digest(encoded)

    def to_metadata(self) -> dict[str, str]:
        """Return the key-value pairs of the metadata record."""
        return {_EVENTS: self._each.hex()}


def event_digest(encoded: bytes) -> bytes:
    """Return the digest of one event."""
    return hashlib.sha256(encoded).digest()[:_BYTES]


def altered_events(pairs: Mapping[str, str] | None, encoded: Sequence[bytes]) -> dict[int, str] | None:
    """Return the recorded digests of the events that have another one now, by index; None without digests.

    An event that was added has no recorded digest, an empty text; where the last events are missing, the index after
    the last one has that of the first missing one.
    """
    if pairs is None:
        return None
    digits = 2 * _BYTES
    recorded = pairs.get(_EVENTS, "")
    found = {
        index: expected
        for index, each in enumerate(encoded)
        if (expected := recorded[index * digits : (index + 1) * digits]) != event_digest(each).hex()
    }
    missing = recorded[len(encoded) * digits :]
    return {**found, len(encoded): missing[:digits]} if missing else found
