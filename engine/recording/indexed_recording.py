"""Random access to the topics of a recording by time, through its index, also during recording.

Times are the run's: seconds since it started, as its events have them.
"""

from __future__ import annotations

import struct
from array import array
from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Self

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, ChunkIndex, Schema
from mcap.writer import MCAP0_MAGIC

from engine.journal import decode_event
from engine.recording.chunk_decompression import decompress_chunk
from engine.recording.file_content import damage_reported, lock_against_removal, new_read_budget, read_index
from engine.recording.finalization import EVENT_TOPIC, PART
from engine.recording.read_budget import MAX_RECORD

_FRAME = struct.Struct("<BQ")  # opcode, length
_MESSAGE = struct.Struct("<HIQQ")  # channel, number, time in the log, time of publishing
_ENTRIES = struct.Struct("<HI")  # channel, length of the list
_BLOCK = 4 * 2**20
_KEPT_CHUNK_BYTES = 64 * 2**20
_MAX_CHANNELS = 2**13
_SHOWN_ELSEWHERE = "/foxglove/"
_OURS = "flexcell."


@dataclass(frozen=True, slots=True)
class StoredMessage:
    """A message as it lies in the file; `place` is the same for the same message."""

    place: tuple[int, int]
    data: bytes


@dataclass(kw_only=True)
class _Track:
    """Index of one topic: times and positions of its messages; `chunks` holds the chunk in a finalized file."""

    times_ns: array[int] = field(default_factory=lambda: array("q"))
    places: array[int] = field(default_factory=lambda: array("q"))
    chunks: array[int] = field(default_factory=lambda: array("i"))


class IndexedRecording:
    """One recording, open for random access; belongs to one thread; a context manager. Create it with `open`."""

    def __init__(self, path: Path, stream: BinaryIO) -> None:
        self.path = path
        self._stream = stream
        self._channels: dict[int, str] = {}
        self._types: dict[int, int] = {}
        self._schemas: dict[int, str] = {}
        self._tracks: dict[str, _Track] = {}
        self._chunks: list[ChunkIndex] = []
        self._unfolded: OrderedDict[int, bytes] = OrderedDict()
        self._entry_bytes = 0
        self._read_to = len(MCAP0_MAGIC)
        self._zero_ns: int | None = None
        self._first_ns = self._last_ns = 0
        self._growing = True

    @classmethod
    def open(cls, path: Path) -> Self:
        """Open a recording; a finalized file has an index, for a live file it is built here.

        Raises:
            RecordingError: it cannot be read, or is damaged.
        """
        with damage_reported(path):
            stream = path.open("rb")
            try:
                lock_against_removal(stream)
                if stream.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
                    raise ValueError("it is not an MCAP file")
                new_read_budget(stream)
                opened = cls(path, stream)
                opened._begin()
            except BaseException:
                stream.close()
                raise
        return opened

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._stream.close()

    @property
    def topics(self) -> Mapping[str, str]:
        """The names of the topics in it, each with the name of its messages' type."""
        return {
            topic.removeprefix("/"): self._schemas[self._types[number]].removeprefix(_OURS)
            for number, topic in self._channels.items()
            if not _is_other(topic)
        }

    @property
    def span_s(self) -> tuple[float, float]:
        """Times of its first and its last message so far; (0, 0) before the first event."""
        return (self._time_s(self._first_ns), self._time_s(self._last_ns)) if self._zero_ns is not None else (0.0, 0.0)

    def refresh(self) -> None:
        """Read the records written since the last call.

        Raises:
            RecordingError: it is damaged.
        """
        if self._growing:
            with damage_reported(self.path):
                self._scan()

    def at(self, topic: str, time_s: float) -> StoredMessage | None:
        """Return the latest message of a topic at a time; None before the first.

        Raises:
            RecordingError: it is damaged.
        """
        if self._zero_ns is None:
            return None
        with damage_reported(self.path):
            track = self._track(f"/{topic}")
            if track is None:
                return None
            # Past all times that fit, everything has been.
            at_ns = self._zero_ns + round(min(max(time_s, -1e9), 1e9) * 1e9)
            row = bisect_right(track.times_ns, at_ns) - 1
            return self._stored(track, row) if row >= 0 else None

    def count(self, topic: str) -> int:
        """Return how many messages of a topic there are so far.

        Raises:
            RecordingError: it is damaged.
        """
        with damage_reported(self.path):
            track = self._track(f"/{topic}")
            return 0 if track is None else len(track.times_ns)

    def between(self, topic: str, from_s: float, until_s: float, *, most: int) -> Iterator[tuple[float, bytes]]:
        """Yield times and data of the messages of a topic in a time range, with the one that was the latest before it.

        Of more than `most` messages, at least half as many, which lie evenly among all.

        Raises:
            RecordingError: it is damaged.
        """
        if self._zero_ns is None:
            return
        with damage_reported(self.path):
            track = self._track(f"/{topic}")
            if track is None:
                return
            rows = [
                bisect_right(track.times_ns, self._zero_ns + round(min(max(at_s, -1e9), 1e9) * 1e9))
                for at_s in (from_s, until_s)
            ]
            first, end = max(0, rows[0] - 1), rows[1]
            for row in range(first, end, max(1, -(-(end - first) // most))):
                yield self._time_s(track.times_ns[row]), self._stored(track, row).data

    def _begin(self) -> None:
        index = None if self.path.suffix == PART else read_index(self._stream, new_read_budget(self._stream))
        if index is None:
            self._scan()
            return
        self._growing = False
        for record in index:
            if isinstance(record, Channel):
                self._channels[record.id], self._types[record.id] = record.topic, record.schema_id
            elif isinstance(record, Schema):
                self._schemas[record.id] = record.name
        self._chunks = [record for record in index if isinstance(record, ChunkIndex)]
        times = [(c.message_start_time, c.message_end_time) for c in self._chunks if c.message_index_offsets]
        self._first_ns = min((first for first, _ in times), default=0)
        self._last_ns = max((last for _, last in times), default=0)
        events = self._track(EVENT_TOPIC)
        if events is not None and len(events.times_ns):
            self._set_zero(events.times_ns[0], self._stored(events, 0).data)

    def _scan(self) -> None:
        """Continue reading a live file, up to its last complete record."""
        size = self._stream.seek(0, 2)
        while self._read_to + _FRAME.size <= size:
            self._stream.seek(self._read_to)
            block = self._stream.read(_BLOCK)
            used = self._scan_block(block)
            if used == 0:
                _, length = _FRAME.unpack_from(block)
                if length > MAX_RECORD:
                    raise ValueError(f"a record declares {length} bytes, more than {MAX_RECORD}")
                if self._read_to + _FRAME.size + length > size:
                    return  # it is being written
                self._stream.seek(self._read_to)
                used = self._scan_block(self._stream.read(_FRAME.size + length))
            self._read_to += used

    def _scan_block(self, block: bytes) -> int:
        """Process all complete records of a block; return their size in bytes."""
        at, end = 0, len(block)
        while at + _FRAME.size <= end:
            opcode, length = _FRAME.unpack_from(block, at)
            content = at + _FRAME.size
            if content + length > end:
                break
            if opcode == Opcode.MESSAGE:
                channel, _, time_ns, _ = _MESSAGE.unpack_from(block, content)
                topic = self._channels.get(channel)
                if topic is None:
                    raise ValueError(f"a message belongs to the missing channel {channel}")
                if topic == EVENT_TOPIC and self._zero_ns is None:
                    self._first_ns = time_ns
                    self._set_zero(time_ns, block[content + _MESSAGE.size : content + length])
                self._last_ns = max(self._last_ns, time_ns)
                if not _is_other(topic):
                    track = self._tracks[topic]
                    track.times_ns.append(time_ns)
                    track.places.append(self._read_to + at)
            elif opcode == Opcode.CHANNEL:
                read = Channel.read(ReadDataStream(BytesIO(block[content : content + length])))
                self._channels[read.id], self._types[read.id] = read.topic, read.schema_id
                self._tracks.setdefault(read.topic, _Track())
                if len(self._tracks) > _MAX_CHANNELS:
                    raise ValueError(f"it has more than {_MAX_CHANNELS} topics")
            elif opcode == Opcode.SCHEMA:
                schema = Schema.read(ReadDataStream(BytesIO(block[content : content + length])))
                self._schemas[schema.id] = schema.name
            at = content + length
        return at

    def _set_zero(self, time_ns: int, event: bytes) -> None:
        self._zero_ns = time_ns - round(decode_event(event).time_s * 1e9)

    def _time_s(self, time_ns: int) -> float:
        return (time_ns - (self._zero_ns or 0)) / 1e9

    def _track(self, topic: str) -> _Track | None:
        known = self._tracks.get(topic)
        if known is not None or self._growing:
            return known
        numbers = {number for number, name in self._channels.items() if name == topic}
        if not numbers:
            return None
        track = self._tracks[topic] = _Track()
        for row, chunk in enumerate(self._chunks):
            for number in numbers.intersection(chunk.message_index_offsets):
                for time_ns, place in self._entries(chunk.message_index_offsets[number]):
                    track.times_ns.append(time_ns)
                    track.places.append(place)
                    track.chunks.append(row)
        return track

    def _entries(self, offset: int) -> Iterator[tuple[int, int]]:
        size = self._stream.seek(0, 2)
        self._stream.seek(offset)
        opcode, length = _FRAME.unpack(self._stream.read(_FRAME.size))
        # Each entry occurs once in a valid file; repeated entries indicate a crafted index.
        self._entry_bytes += length
        if opcode != Opcode.MESSAGE_INDEX or self._entry_bytes > size:
            raise ValueError("its index points outside the file")
        content = self._stream.read(length)
        numbers = array("Q", content[_ENTRIES.size : _ENTRIES.size + _ENTRIES.unpack_from(content)[1]])
        return zip(numbers[::2], numbers[1::2], strict=True)

    def _stored(self, track: _Track, row: int) -> StoredMessage:
        place = track.places[row]
        if not track.chunks:
            self._stream.seek(place)
            _, length = _FRAME.unpack(self._stream.read(_FRAME.size))
            return StoredMessage((-1, place), self._stream.read(length)[_MESSAGE.size :])
        chunk = track.chunks[row]
        data = self._chunk(chunk)
        _, length = _FRAME.unpack_from(data, place)
        return StoredMessage((chunk, place), data[place + _FRAME.size + _MESSAGE.size : place + _FRAME.size + length])

    def _chunk(self, row: int) -> bytes:
        if row in self._unfolded:
            self._unfolded.move_to_end(row)
            return self._unfolded[row]
        index = self._chunks[row]
        self._stream.seek(index.chunk_start_offset)
        opcode, length = _FRAME.unpack(self._stream.read(_FRAME.size))
        if opcode != Opcode.CHUNK or length > MAX_RECORD:
            raise ValueError("its index points outside the file")
        chunk = Chunk.read(ReadDataStream(BytesIO(self._stream.read(length))))
        data = self._unfolded[row] = decompress_chunk(chunk, new_read_budget(self._stream))
        while len(self._unfolded) > 1 and sum(map(len, self._unfolded.values())) > _KEPT_CHUNK_BYTES:
            self._unfolded.popitem(last=False)
        return data


def _is_other(topic: str) -> bool:
    """Events come from the journal, and Foxglove views duplicate recorded messages."""
    return topic.startswith((_SHOWN_ELSEWHERE, EVENT_TOPIC))
