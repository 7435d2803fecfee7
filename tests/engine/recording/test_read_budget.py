"""A small recording that says that it is large is refused by all who read one, before it takes time or memory."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Callable, Iterable
from importlib import import_module
from itertools import repeat
from pathlib import Path
from typing import Any

import pytest
import zstandard
from mcap.opcode import Opcode
from mcap.records import Message
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

from engine.archive.recording_files import read_description, recording_files
from engine.errors import RecordingError
from engine.event import MessageLogged
from engine.journal import encode_event
from engine.recording import load_recording
from engine.recording.file_content import open_records
from engine.recording.finalization import finalize_recording
from engine.recording.indexed_recording import IndexedRecording
from engine.recording.read_budget import MAX_CHUNK, MAX_FILE, MAX_NAMES, MAX_RECORD

lz4: Any = import_module("lz4.frame")
MB = 2**20


def record(opcode: int, content: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(content)) + content


def text(value: str) -> bytes:
    return struct.pack("<I", len(value)) + value.encode()


def chunk(packed: bytes, said: int, compression: str) -> bytes:
    head = struct.pack("<QQQI", 0, 0, said, 0) + text(compression)
    return record(Opcode.CHUNK, head + struct.pack("<Q", len(packed)) + packed)


def zstd(data: bytes, *, said: int | None = None) -> bytes:
    return chunk(zstandard.compress(data), len(data) if said is None else said, "zstd")


def attachment(name: str) -> bytes:
    content = struct.pack("<QQ", 0, 0) + text(name) + text("") + struct.pack("<Q", 0)
    return record(Opcode.ATTACHMENT, content + struct.pack("<I", zlib.crc32(content)))


def written(path: Path, records: Iterable[bytes]) -> Path:
    path.write_bytes(MCAP0_MAGIC + record(Opcode.HEADER, text("") * 2) + b"".join(records))
    return path


FILLER = record(0x80, bytes(4 * MB - 9))
EMPTY = record(0x80, b"") * (MB // 9)
BOMBS: dict[str, tuple[Callable[[], Iterable[bytes]], str]] = {
    "says too much": (lambda: [zstd(b"x", said=2**40)], "declares 1099511627776 decompressed bytes"),
    "says more than it has": (lambda: [zstd(b"x" * 1000, said=2000)], "does not decompress to its declared 2000 bytes"),
    "says less than it has": (
        lambda: [zstd(bytes(64 * MB), said=1000)],
        "does not decompress to its declared 1000 bytes",
    ),
    "lz4": (
        lambda: [chunk(lz4.compress(bytes(200 * MB)), 1000, "lz4")],
        "does not decompress to its declared 1000 bytes",
    ),
    "not packed": (lambda: [chunk(b"x" * 100, 10, "")], "does not decompress to its declared 10 bytes"),
    "unknown": (lambda: [chunk(b"x", 1, "rar")], "unknown compression 'rar'"),
    "many chunks": (lambda: repeat(zstd(FILLER), 40), "decompresses to more than 300 times its size"),
    "many records": (lambda: repeat(zstd(EMPTY), 3), "more records than a file of its size can hold"),
    "many names": (lambda: (attachment(f"{n}") for n in range(MAX_NAMES + 1)), f"more than {MAX_NAMES}"),
}


@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_is_refused_when_it_is_loaded_recovered_and_listed(tmp_path: Path, name: str) -> None:
    records, said = BOMBS[name]
    part = written(tmp_path / "r.mcap.part", records())
    with pytest.raises(RecordingError, match=f"this file is damaged: .*{said}"):
        load_recording(part)
    with pytest.raises(RecordingError, match=f"this file is damaged: .*{said}"):
        finalize_recording(part, tmp_path / "r.mcap")
    assert [file.name for file in tmp_path.iterdir()] == ["r.mcap.part"]
    (listed,) = recording_files(tmp_path)
    assert listed.problem


@pytest.mark.parametrize(
    ("size", "length", "said"),
    [(MAX_FILE + 1, 100, f"more than {MAX_FILE}"), (2**32, 2**31, f"more than {MAX_RECORD}")],
)
def test_a_file_that_is_mostly_a_hole_is_not_read(tmp_path: Path, size: int, length: int, said: str) -> None:
    part = written(tmp_path / "r.mcap.part", [struct.pack("<BQ", Opcode.MESSAGE, length)])
    os.truncate(part, size)
    for use in (
        lambda: load_recording(part),
        lambda: finalize_recording(part, tmp_path / "r.mcap"),
        lambda: IndexedRecording.open(part),
    ):
        with pytest.raises(RecordingError, match=f"this file is damaged: .*{said}"):
            use()
    with pytest.raises(RecordingError):
        read_description(part)


def test_chunks_that_others_have_packed_are_read(tmp_path: Path) -> None:
    """By zstd without a word on its size, by lz4, and not at all."""
    message = record(Opcode.MESSAGE, struct.pack("<HIQQ", 7, 1, 0, 0) + b"{}")
    stream = zstandard.ZstdCompressor().compressobj()
    packed = stream.compress(message) + stream.flush()
    assert zstandard.frame_content_size(packed) == -1
    chunks = [(packed, "zstd"), (lz4.compress(message), "lz4"), (message, "")]
    path = written(tmp_path / "r.mcap", [chunk(data, len(message), kind) for data, kind in chunks])
    with open_records(path) as records:
        found = [each for each in records() if isinstance(each, Message)]
    assert [(each.channel_id, each.data) for each in found] == [(7, b"{}")] * 3


def test_an_index_that_leads_to_one_place_again_and_again_ends(tmp_path: Path) -> None:
    """A thousand entries of the index that all name one chunk."""
    path = tmp_path / "r.mcap"
    event = MessageLogged(seq=1, time_s=0.0, path="root", level="info", message="x" * 4 * MB)
    with path.open("wb") as stream:
        writer = Writer(stream, chunk_size=MAX_CHUNK, compression=CompressionType.ZSTD)
        writer.start(profile="flexcell", library="")
        channel = writer.register_channel("/flexcell/events", "json", 0)
        for _ in range(4):
            writer.add_message(channel, 0, encode_event(event), 0)
        writer.flush()
        index = vars(writer)["_Writer__chunk_indices"]
        index *= 1000
        writer.finish()
    with pytest.raises(RecordingError, match="decompresses to more than 300 times its size"):
        load_recording(path)
    with IndexedRecording.open(path) as moments:
        assert moments.topics == {}


def test_a_flood_of_topics_ends(tmp_path: Path) -> None:
    """Records of channels that use one number again and again."""
    channels = (
        record(Opcode.CHANNEL, struct.pack("<HH", 1, 0) + text(f"/{n}") + text("json") + struct.pack("<I", 0))
        for n in range(2**13 + 1)
    )
    part = written(tmp_path / "r.mcap.part", channels)
    with pytest.raises(RecordingError, match="more than 8192 topics"):
        IndexedRecording.open(part)
