"""Digests of the recorded events, by which a reader finds events that were altered after the run.

They protect against damage and careless edits, not against an author who computes them anew.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence

DIGESTS_NAME = "flexcell.digests"
"""Name of the MCAP metadata record of the digests, written when the recording is closed."""
_EVENTS = "events"
_ALL = "sha256"
_BYTES = 4


class EventDigests:
    """Collects the digests of the events of a recording in their order."""

    def __init__(self) -> None:
        self._each = bytearray()
        self._all = hashlib.sha256()

    def add(self, encoded: bytes) -> None:
        """Take the next event, as it is written."""
        self._each += event_digest(encoded)
        self._all.update(encoded)

    def to_metadata(self) -> dict[str, str]:
        """Return the key-value pairs of the metadata record."""
        return {_EVENTS: self._each.hex(), _ALL: self._all.hexdigest()}


def event_digest(encoded: bytes) -> bytes:
    """Return the digest of one event."""
    return hashlib.sha256(encoded).digest()[:_BYTES]


def altered_events(pairs: Mapping[str, str] | None, encoded: Sequence[bytes]) -> dict[int, str] | None:
    """Return the recorded digests of the events that have another one now, by index; None without digests.

    Events that were added have no recorded digest: an empty text.
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
    if found or not encoded:
        return found
    overall = hashlib.sha256()
    for each in encoded:
        overall.update(each)
    # Events at the end are missing.
    return {} if overall.hexdigest() == pairs.get(_ALL) else {len(encoded): ""}
