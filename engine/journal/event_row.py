"""The row of one event, as written by journals up to format 4; later formats write blocks."""

from __future__ import annotations

import msgspec

from engine.event import AnyEvent
from engine.journal.checksum import event_checksum
from engine.journal.codec import decode_event


class EventRow(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The row of one event; it has no checksum when a format before 4 wrote it."""

    run: str
    seq: int
    time_s: float
    epoch: int
    data: bytes
    checksum: bytes | None

    @property
    def last(self) -> int:
        """The number of the only event."""
        return self.seq

    def chained(self, before: bytes) -> bytes:
        """Return the checksum of this row when its predecessor has the checksum `before`."""
        return event_checksum(before, self.seq, self.time_s, self.epoch, self.data)

    def events(self) -> tuple[AnyEvent, ...]:
        """Return the event.

        Raises:
            JournalError: the data is not an event.
        """
        return (decode_event(self.data),)

    def suspects(self) -> tuple[int, int]:
        """Return the first and last event that may be damaged."""
        return self.seq, self.seq
