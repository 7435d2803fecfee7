"""The row of one event, as journals up to format 4 have them; blocks came after."""

from __future__ import annotations

import msgspec

from engine.event import AnyEvent
from engine.journal.checksum import event_checksum
from engine.journal.codec import decode_event


class EventRow(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The row of one event; it has no checksum where a format before 4 wrote it."""

    run: str
    seq: int
    time_s: float
    epoch: int
    data: bytes
    checksum: bytes | None

    @property
    def last(self) -> int:
        """The number of its last event: the only one."""
        return self.seq

    def chained(self, before: bytes) -> bytes:
        """Return the checksum that it has where its predecessor has `before`."""
        return event_checksum(before, self.seq, self.time_s, self.epoch, self.data)

    def events(self) -> tuple[AnyEvent, ...]:
        """Return its event.

        Raises:
            JournalError: it is none.
        """
        return (decode_event(self.data),)

    def suspects(self) -> tuple[int, int]:
        """Return the first and the last event that may be the damaged one."""
        return self.seq, self.seq
