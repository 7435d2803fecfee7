"""The records of a recording in file order, complete or truncated within a record.

For any file content, reading yields records or raises one `RecordingError`, with time and memory
bounded in proportion to the file size (`engine.recording.read_budget`).
"""

from __future__ import annotations

import fcntl
import zlib
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    Footer,
    McapRecord,
    Message,
    Metadata,
    MetadataIndex,
    Schema,
)
from mcap.writer import MCAP0_MAGIC

from engine.errors import RecordingError
from engine.recording.chunk_decompression import decompress_chunk
from engine.recording.read_budget import MAX_INDEX, ReadBudget

_FRAME = 9  # opcode and length before the content of every record
_FOOTER = _FRAME + 20
_DATA_END = _FRAME + 4
_PIECE = 2**20
_MAGIC = len(MCAP0_MAGIC)
_Read = Callable[[bytes], McapRecord]


def _reader(read: Callable[[ReadDataStream], McapRecord]) -> _Read:
    return lambda content: read(ReadDataStream(BytesIO(content)))


_READ: Mapping[int, _Read] = {
    Opcode.MESSAGE: lambda content: Message.read(ReadDataStream(BytesIO(content)), len(content)),
    Opcode.SCHEMA: _reader(Schema.read),
    Opcode.CHANNEL: _reader(Channel.read),
    Opcode.CHUNK: _reader(Chunk.read),
    Opcode.CHUNK_INDEX: _reader(ChunkIndex.read),
    Opcode.ATTACHMENT: _reader(Attachment.read),
    Opcode.ATTACHMENT_INDEX: _reader(AttachmentIndex.read),
    Opcode.METADATA: _reader(Metadata.read),
    Opcode.METADATA_INDEX: _reader(MetadataIndex.read),
    Opcode.FOOTER: _reader(Footer.read),
}
_IN_CHUNKS = frozenset({Opcode.MESSAGE, Opcode.SCHEMA, Opcode.CHANNEL})


@dataclass(kw_only=True)
class FileContent:
    """Metadata and attachments by name, and the messages of one topic in file order."""

    metadata: dict[str, dict[str, str]] = field(default_factory=dict[str, dict[str, str]])
    attachments: dict[str, bytes] = field(default_factory=dict[str, bytes])
    messages: list[Message] = field(default_factory=list[Message])
    complete: bool = False
    """Whether the file was closed properly."""


def read_content(path: Path, topic: str) -> FileContent:
    """Read one topic of a recording, through its index if there is one.

    Raises:
        RecordingError: the file cannot be read, is not an MCAP file, or is damaged.
    """
    with open_for_reading(path) as stream:
        return _by_index(stream, topic) or _in_sequence(stream, topic)


@contextmanager
def open_records(path: Path) -> Generator[Callable[[], Iterator[McapRecord]]]:
    """Open a file and return a function that iterates over its records from the start on each call.

    The records end where the file is truncated; chunks are decompressed. In a damaged file,
    the iteration raises the error of the parser.

    Raises:
        OSError: the file cannot be opened.
        RecordingError: the file is not an MCAP file.
    """
    with path.open("rb") as stream:
        lock_against_removal(stream)
        _require_magic(stream, path)
        yield lambda: _records(stream, _MAGIC, new_read_budget(stream))


def lock_against_removal(stream: BinaryIO) -> None:
    """Lock an open recording against removal of old recordings."""
    try:
        fcntl.flock(stream, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return  # it is being written and therefore in use, or the file system does not support locks


@contextmanager
def open_for_reading(path: Path) -> Generator[BinaryIO]:
    """Open a recording; any parser error in the block is raised as a damaged file.

    Raises:
        RecordingError: the file cannot be read, is not an MCAP file, or is damaged.
    """
    with damage_reported(path), path.open("rb") as stream:
        _require_magic(stream, path)
        yield stream


@contextmanager
def damage_reported(path: Path) -> Generator[None]:
    """Raise any error of the block as a RecordingError: the file cannot be read, or it is damaged."""
    try:
        yield
    except RecordingError:
        raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise RecordingError(f"cannot read this file: {reason}", where=path, hint="check its path") from error
    except Exception as error:
        # The parser raises various exceptions; for the reader each means a damaged file.
        what = " ".join(str(error).split()) or type(error).__name__
        raise RecordingError(f"this file is damaged: {what}", where=path, hint="record it again") from error


def _require_magic(stream: BinaryIO, path: Path) -> None:
    if stream.read(_MAGIC) != MCAP0_MAGIC:
        raise RecordingError("this is not an MCAP file", where=path, hint="give a file that --record wrote")


def new_read_budget(stream: BinaryIO) -> ReadBudget:
    """Return the budget for reading a file.

    Raises:
        ValueError: it is too large.
    """
    return ReadBudget(stream.seek(0, 2))


def read_index(stream: BinaryIO, allowance: ReadBudget) -> list[McapRecord] | None:
    """Return the records of the index at the end of a file; None if there is no index.

    Raises:
        ValueError: the file is damaged.
    """
    start = _index_start(stream, stream.seek(0, 2))
    return None if start is None else list(_records(stream, start, allowance))


def _by_index(stream: BinaryIO, topic: str) -> FileContent | None:
    """Read through the index at the end of the file; None if there is no index."""
    allowance = new_read_budget(stream)
    index = read_index(stream, allowance)
    if index is None:
        return None
    content = FileContent(complete=True)
    channel_ids = {record.id for record in index if isinstance(record, Channel) and record.topic == topic}
    for record in index:
        match record:
            case ChunkIndex():
                if channel_ids.intersection(record.message_index_offsets):
                    for found in _records(stream, record.chunk_start_offset, allowance, only=True):
                        _keep_message(found, channel_ids, content, allowance)
            case AttachmentIndex() | MetadataIndex():
                for found in _records(stream, record.offset, allowance, only=True):
                    _keep(found, content, allowance)
            case _:
                pass
    return content


def _index_start(stream: BinaryIO, size: int) -> int | None:
    if size < 2 * _MAGIC + _FOOTER:
        return None
    stream.seek(size - _FOOTER - _MAGIC)
    tail = stream.read()
    if tail[_FOOTER:] != MCAP0_MAGIC or tail[0] != Opcode.FOOTER:
        return None
    footer = Footer.read(ReadDataStream(BytesIO(tail[_FRAME:_FOOTER])))
    if footer.summary_start == 0:
        return None
    if not 0 <= size - footer.summary_start <= MAX_INDEX:
        raise ValueError(f"its index has {size - footer.summary_start} bytes")
    stream.seek(footer.summary_start)
    checked = stream.read(size - _MAGIC - footer.summary_start)[:-4]
    if footer.summary_crc and zlib.crc32(checked) != footer.summary_crc:
        raise ValueError("the checksum of its index is wrong")
    _verify_data(stream, footer.summary_start - _DATA_END)
    return footer.summary_start


def _verify_data(stream: BinaryIO, end: int) -> None:
    """Raise ValueError if the data before the record at `end` does not match the checksum in that record."""
    if end < _MAGIC:
        raise ValueError("its index begins before its data")
    stream.seek(end)
    record = stream.read(_DATA_END)
    if record[0] != Opcode.DATA_END:
        raise ValueError("its data has no end")
    expected = int.from_bytes(record[_FRAME:], "little")
    if expected == 0:
        # The file has no checksum.
        return
    stream.seek(0)
    found = 0
    while end > 0:
        piece = stream.read(min(end, _PIECE))
        found = zlib.crc32(piece, found)
        end -= len(piece)
    if found != expected:
        raise ValueError("the checksum of its data is wrong")


def _in_sequence(stream: BinaryIO, topic: str) -> FileContent:
    content = FileContent()
    channel_ids: set[int] = set()
    allowance = new_read_budget(stream)
    for record in _records(stream, _MAGIC, allowance):
        match record:
            case Channel():
                if record.topic == topic:
                    channel_ids.add(record.id)
            case Message():
                _keep_message(record, channel_ids, content, allowance)
            case Footer():
                content.complete = stream.read(_MAGIC) == MCAP0_MAGIC
            case _:
                _keep(record, content, allowance)
    return content


def _keep_message(record: McapRecord, channel_ids: set[int], content: FileContent, allowance: ReadBudget) -> None:
    if isinstance(record, Message) and record.channel_id in channel_ids:
        allowance.take_message(len(record.data))
        content.messages.append(record)


def _keep(record: McapRecord, content: FileContent, allowance: ReadBudget) -> None:
    if isinstance(record, Metadata):
        allowance.take_document(sum(len(key) + len(value) for key, value in record.metadata.items()))
        content.metadata[record.name] = record.metadata
    elif isinstance(record, Attachment):
        allowance.take_document(len(record.data))
        content.attachments[record.name] = record.data


def _records(stream: BinaryIO, offset: int, allowance: ReadBudget, *, only: bool = False) -> Iterator[McapRecord]:
    """Iterate over the records from `offset` to the footer or to the end of a truncated file."""
    size = stream.seek(0, 2)
    while offset + _FRAME <= size:
        stream.seek(offset)
        frame = stream.read(_FRAME)
        opcode, length = frame[0], int.from_bytes(frame[1:], "little")
        if offset + _FRAME + length > size:
            return
        allowance.take_record(length if opcode in _READ else 0)
        if opcode in _READ:
            yield from _parsed(opcode, stream.read(length), allowance)
        if only or opcode == Opcode.FOOTER:
            return
        offset += _FRAME + length


def _parsed(opcode: int, content: bytes, allowance: ReadBudget) -> Iterator[McapRecord]:
    if opcode == Opcode.CHUNK:
        yield from _in_chunk(decompress_chunk(Chunk.read(ReadDataStream(BytesIO(content))), allowance), allowance)
        return
    if opcode == Opcode.ATTACHMENT and zlib.crc32(content[:-4]) != int.from_bytes(content[-4:], "little"):
        raise ValueError("the checksum of a document in it is wrong")
    yield _READ[opcode](content)


def _in_chunk(data: bytes, allowance: ReadBudget) -> Iterator[McapRecord]:
    offset, size = 0, len(data)
    while offset + _FRAME <= size:
        opcode, length = data[offset], int.from_bytes(data[offset + 1 : offset + _FRAME], "little")
        offset += _FRAME
        allowance.take_record(length)
        if offset + length > size:
            break
        if opcode in _IN_CHUNKS:
            yield _READ[opcode](data[offset : offset + length])
        offset += length
    if offset != size:
        raise ValueError("a chunk ends in the middle of a record")
