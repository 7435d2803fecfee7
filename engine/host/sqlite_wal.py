"""Detects damage in the write-ahead log of an SQLite file, which SQLite itself takes for the end of the log.

Only the log is opened. SQLite locks the file and its index by POSIX locks, which a process loses as soon as any part
of it closes either of them.

Sources: section "WAL-Mode File Format" of the documentation of SQLite 3, and "How To Corrupt An SQLite Database File".
"""

from __future__ import annotations

import struct
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, NamedTuple

from engine.host.sqlite_migrations import DamagedFile

_LOG_HEADER_BYTES = 32
_SUMMED = 24
"""Number of bytes of the log header that its checksum covers."""
_FRAME_SUMMED = 8
"""Number of bytes of a frame header that its checksum covers, followed by the page."""
_BIG_ENDIAN = 0x377F0683
"""Magic number of a log with big-endian checksums; that of little-endian ones is smaller by 1."""
_FRAME_HEADER = struct.Struct(">4xI8s8s")
"""Frame header: pages of the file after the commit, 0 within a transaction; salt; checksum."""
_PAGE_BYTES = 4096
"""Page size of flexcell's files, used when the header of the log does not give it."""
_DURABLE_COMMITS = 2
"""Number of commits after the damage that proves a durable one: each is synced before the next begins."""

Sums = tuple[int, int]


class _Loss(NamedTuple):
    """The byte at which the readable log ends, and the number of commits after it."""

    end: int
    commits: int


def require_whole_log(path: Path) -> None:
    """Refuse a database whose log continues after the part that SQLite reads: durable commits would be lost silently.

    Call it before opening the database: the first writing connection drops the unread part when it is closed.
    Damage in the latest commit looks like a write cut by a power failure, and is ignored as SQLite does.
    Takes about 80 µs of CPU time per page of the log.

    Raises:
        DamagedFile: the log is damaged; the message gives the byte.
    """
    log_path = path.with_name(f"{path.name}-wal")
    with suppress(FileNotFoundError), log_path.open("rb") as log:
        loss = _loss(log)
        # A concurrent write of another process may look like damage for an instant.
        if loss.commits >= _DURABLE_COMMITS and _loss(log) == loss:
            raise DamagedFile(
                f"{log_path.name} is damaged near byte {loss.end}: {loss.commits} commits after it cannot be read"
            )


def _loss(log: BinaryIO) -> _Loss:
    log.seek(0)
    header = log.read(_LOG_HEADER_BYTES)
    order = ">" if int.from_bytes(header[:4], "big") == _BIG_ENDIAN else "<"
    sums = _added((0, 0), header[:_SUMMED], order)
    is_sound = len(header) == _LOG_HEADER_BYTES and struct.pack(">II", *sums) == header[_SUMMED:]
    salt = header[16:24] if is_sound else b""
    page_bytes = int.from_bytes(header[8:12], "big") if is_sound else _PAGE_BYTES
    end, commits = _LOG_HEADER_BYTES, 0
    while len(frame := log.read(_FRAME_HEADER.size + page_bytes)) == _FRAME_HEADER.size + page_bytes:
        pages_after_commit, its_salt, its_sums = _FRAME_HEADER.unpack_from(frame)
        # Where the header of the log is damaged, the salt of the first frame identifies its frames.
        salt = salt or its_salt
        if is_sound:
            sums = _added(_added(sums, frame[:_FRAME_SUMMED], order), frame[_FRAME_HEADER.size :], order)
            is_sound = its_salt == salt and struct.pack(">II", *sums) == its_sums
        if is_sound:
            end += len(frame)
        elif pages_after_commit and its_salt == salt:
            commits += 1
    return _Loss(end, commits)


def _added(sums: Sums, data: bytes, order: str) -> Sums:
    """Return the checksum `sums` extended by `data`."""
    first, second = sums
    numbers = iter(struct.unpack(f"{order}{len(data) // 4}I", data[: len(data) // 4 * 4]))
    for one, other in zip(numbers, numbers, strict=False):
        first = (first + one + second) & 0xFFFFFFFF
        second = (second + other + first) & 0xFFFFFFFF
    return first, second
