"""Blocks: consecutive events of one run in one row of the journal, one line of JSON each, under one checksum.

One row, one checksum and one encoder call per event would cost several times as much as the event itself. A block also
has a checksum of four bytes for each line, which locates a damaged event.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from zlib import adler32

import msgspec

from engine.errors import JournalError
from engine.event import AnyEvent, Event
from engine.journal.checksum import block_checksum
from engine.journal.codec import decode_event, decode_event_log, encode_event_log

_SUM = struct.Struct("<I")
MAX_EVENTS = 256
"""Maximum number of events in a block: reading the last event of a run reads one block."""
MAX_BYTES = 2**20
"""Maximum size of the lines of a block, unless it has a single event."""


class EventBlock(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The row of the events from `seq` to `last`; `epoch` identifies the engine that wrote it."""

    run: str
    seq: int
    last: int
    epoch: int
    sums: bytes
    data: bytes
    checksum: bytes

    def chained(self, before: bytes) -> bytes:
        """Return the checksum of this row when its predecessor has the checksum `before`."""
        return block_checksum(before, self.seq, self.last, self.epoch, self.sums, self.data)

    def events(self) -> tuple[AnyEvent, ...]:
        """Return the events of this row.

        Raises:
            JournalError: the data are not the events from `seq` to `last`; the message names the wrong one.
        """
        try:
            events = decode_event_log(self.data)
        except JournalError:
            # Decode again one by one: the error must name the event.
            events = tuple(self._each())
        if len(events) != self.last - self.seq + 1 or any(e.seq != n for n, e in enumerate(events, self.seq)):
            raise JournalError(f"the block does not hold the events {self.seq} to {self.last}")
        return events

    def suspects(self) -> tuple[int, int]:
        """Return the first and last event that may be damaged; both are the same event where the sums locate it."""
        for index, line in enumerate(self.data.split(b"\n")[: len(self.sums) // _SUM.size]):
            if _SUM.pack(adler32(line)) != self.sums[index * _SUM.size : (index + 1) * _SUM.size]:
                return self.seq + index, self.seq + index
        return self.seq, self.last

    def _each(self) -> Iterator[AnyEvent]:
        for number, line in enumerate(self.data.split(b"\n")[:-1], self.seq):
            try:
                yield decode_event(line)
            except JournalError as error:
                raise JournalError(f"event {number} of the block: {error.message}", hint=error.hint) from error


def new_blocks(run: str, epoch: int, events: Sequence[Event], before: bytes) -> Iterator[EventBlock]:
    """Yield the rows of events without gaps in their numbers, chained to `before`.

    Raises:
        JournalError: an event cannot be written as JSON.
    """
    for start in range(0, len(events), MAX_EVENTS):
        chunk = events[start : start + MAX_EVENTS]
        data, seq = encode_event_log(chunk), chunk[0].seq
        lines = data.split(b"\n")[:-1]
        for part in (lines,) if len(data) <= MAX_BYTES else _parts(lines):
            sums = struct.pack(f"<{len(part)}I", *map(adler32, part))
            text = data if part is lines else b"\n".join([*part, b""])
            last = seq + len(part) - 1
            before = block_checksum(before, seq, last, epoch, sums, text)
            yield EventBlock(run, seq, last, epoch, sums, text, before)
            seq = last + 1


def _parts(lines: Sequence[bytes]) -> Iterator[Sequence[bytes]]:
    """Split lines into parts of at most `MAX_BYTES`, or of one line."""
    begin, size = 0, 0
    for index, line in enumerate(lines):
        size += len(line) + 1
        if size > MAX_BYTES and index > begin:
            yield lines[begin:index]
            begin, size = index, len(line) + 1
    yield lines[begin:]
