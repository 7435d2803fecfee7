"""Finds damage in the write-ahead log of an SQLite file, which SQLite itself takes for the end of the log.

Sources: sections "WAL-Mode File Format" and "WAL-Index File Format", and "The Database File Format", of SQLite 3.
"""

from __future__ import annotations

import struct
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, NamedTuple

from engine.sqlite_schema import DamagedFile

_LOG_HEADER_BYTES = 32
_SUMMED = 24
"""Bytes of the header of the log that its checksum is of."""
_BIG_ENDIAN = 0x377F0683
"""Magic number of a log whose checksums are of big-endian numbers; the other one is smaller by 1."""
_FRAME_HEADER = struct.Struct(">4xI8s8x")
"""Of a frame: pages of the file after its commit, 0 within a transaction; salt."""
_INDEX_HEADER_BYTES = 48
_INDEX = struct.Struct("=16xI12x8s")
"""Of the index, in the byte order of the machine: frames in use; salt."""
_PAGE_SIZE_AT = 16
_LARGEST_PAGE = 65536
_DURABLE_COMMITS = 2
"""Commits behind damage from which on one of them was durable: each is synced before the next one begins."""


class _Index(NamedTuple):
    """What SQLite reads of a log; the header as a whole changes whenever somebody writes."""

    header: bytes
    frames: int
    salt: bytes


def require_whole_log(path: Path) -> None:
    """Refuse a database whose log goes on behind what SQLite reads of it: durable commits would be lost unnoticed.

    Due once a connection to `path` has read something, which makes the index of the log anew after a crash. Damage in
    the newest commit looks like a write that a power failure has cut, and is left out as SQLite does it.

    Raises:
        DamagedFile: it says where.
    """
    log_path = path.with_name(f"{path.name}-wal")
    with suppress(FileNotFoundError), log_path.open("rb") as log:
        index = _index(path)
        if index is None:
            return
        frame_bytes = _FRAME_HEADER.size + _page_bytes(path)
        end = _LOG_HEADER_BYTES + index.frames * frame_bytes
        lost = _commits_behind(log, end, index.salt if _has_sound_header(log) else _salt_of_first(log), frame_bytes)
        # While somebody writes, frames may stand behind those of the index.
        if lost >= _DURABLE_COMMITS and _index(path) == index:
            raise DamagedFile(f"{log_path.name} is damaged near byte {end}: {lost} commits behind it cannot be read")


def _index(path: Path) -> _Index | None:
    with suppress(FileNotFoundError), path.with_name(f"{path.name}-shm").open("rb") as file:
        header = file.read(_INDEX_HEADER_BYTES)
        if len(header) == _INDEX_HEADER_BYTES:
            return _Index(header, *_INDEX.unpack_from(header))
    return None


def _page_bytes(path: Path) -> int:
    with path.open("rb") as file:
        file.seek(_PAGE_SIZE_AT)
        size = int.from_bytes(file.read(2), "big")
    return _LARGEST_PAGE if size <= 1 else size


def _has_sound_header(log: BinaryIO) -> bool:
    log.seek(0)
    header = log.read(_LOG_HEADER_BYTES)
    if len(header) < _LOG_HEADER_BYTES:
        return False
    order = ">" if int.from_bytes(header[:4], "big") == _BIG_ENDIAN else "<"
    first = second = 0
    for one, other in struct.iter_unpack(f"{order}II", header[:_SUMMED]):
        first = (first + one + second) & 0xFFFFFFFF
        second = (second + other + first) & 0xFFFFFFFF
    return struct.pack(">II", first, second) == header[_SUMMED:]


def _salt_of_first(log: BinaryIO) -> bytes:
    """Return the salt that the frames of a log have whose own header is damaged."""
    log.seek(_LOG_HEADER_BYTES)
    header = log.read(_FRAME_HEADER.size)
    return _FRAME_HEADER.unpack(header)[1] if len(header) == _FRAME_HEADER.size else b""


def _commits_behind(log: BinaryIO, end: int, salt: bytes, frame_bytes: int) -> int:
    """Count the frames behind byte `end` that end a transaction of this log."""
    count = 0
    while True:
        log.seek(end)
        header = log.read(_FRAME_HEADER.size)
        if len(header) < _FRAME_HEADER.size:
            return count
        pages_after_commit, its_salt = _FRAME_HEADER.unpack(header)
        count += bool(pages_after_commit) and its_salt == salt
        end += frame_bytes
