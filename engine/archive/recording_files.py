"""The recordings of a project: listed with their descriptions, and opened inside the project only."""

from __future__ import annotations

import os
from collections.abc import Iterator
from itertools import islice
from pathlib import Path, PurePosixPath

import msgspec
from mcap.records import Chunk, Metadata

from engine.errors import RecordingError
from engine.recording.description import RECORD_NAME, RecordingDescription, from_metadata
from engine.recording.file_content import open_records
from engine.recording.finalization import PART

SUFFIX = ".mcap"
MAX_RECORDINGS = 500
_KEEP_OUT = frozenset({"node_modules", "site-packages", "__pycache__"})
_OPENED = frozenset({".flexcell"})
_FIRST_RECORDS = 64
_DEPTH = 6
_MOST_FOLDERS = 5000


class RecordingFile(msgspec.Struct, frozen=True, kw_only=True):
    """One recording of the project; `problem` says why it cannot be opened, else empty."""

    path: str
    """Relative to the project, with forward slashes."""
    run: str
    behavior: str
    started_at_s: float
    size_bytes: int
    changed_at_s: float
    problem: str


def recording_files(project: Path) -> tuple[RecordingFile, ...]:
    """Return the recordings below a folder, newest first, at most `MAX_RECORDINGS`."""
    found = sorted(
        islice(_files(project.resolve()), MAX_RECORDINGS * 4), key=lambda pair: pair[1].st_mtime, reverse=True
    )
    return tuple(_described(project.resolve(), file, status) for file, status in found[:MAX_RECORDINGS])


def recording_path(project: Path, name: str) -> Path:
    """Return the file of a recording by its path in the project.

    Raises:
        RecordingError: it leads out of the project, or there is no such recording.
    """
    place = PurePosixPath(name)
    root = project.resolve()
    missing = RecordingError(
        "there is no such recording in this project", where=name, hint="see the list of recordings"
    )
    if "\0" in name or place.is_absolute() or ".." in place.parts or not is_recording(place.name):
        raise missing
    try:
        file = (root / place).resolve()
        known = file.is_relative_to(root) and file.is_file()
    except OSError as error:
        raise missing from error
    if not known:
        raise missing
    return file


def read_description(path: Path) -> RecordingDescription:
    """Read only the description at the start of a recording.

    Raises:
        RecordingError: it is not a recording of a run, or its start is damaged.
    """
    try:
        with open_records(path) as records:
            for record in islice(records(), _FIRST_RECORDS):
                if isinstance(record, Metadata) and record.name == RECORD_NAME:
                    return from_metadata(record.metadata, where=path)
                if isinstance(record, Chunk):
                    break
    except RecordingError:
        raise
    except OSError as error:
        raise RecordingError(f"cannot be read: {error.strerror or error}", where=path) from error
    except Exception as error:
        # The parser raises various exceptions; for the reader each means a damaged file.
        what = " ".join(str(error).split()) or type(error).__name__
        raise RecordingError(f"this file is damaged: {what}", where=path, hint="record it again") from error
    raise RecordingError("this is not a recording of a run", where=path, hint="give a file that --record wrote")


def is_recording(name: str) -> bool:
    """Return whether a file has the name of a recording."""
    return name.removesuffix(PART).endswith(SUFFIX)


def _files(root: Path) -> Iterator[tuple[Path, os.stat_result]]:
    due = [(root, 0)]
    for _ in range(_MOST_FOLDERS):
        if not due:
            return
        folder, depth = due.pop()
        try:
            entries = sorted(os.scandir(folder), key=lambda entry: entry.name)
        except OSError:
            continue  # unreadable files are not listed
        for entry in entries:
            if entry.is_dir(follow_symlinks=False):
                hidden = entry.name.startswith(".") and entry.name not in _OPENED
                if depth < _DEPTH and not hidden and entry.name not in _KEEP_OUT:
                    due.append((Path(entry.path), depth + 1))
            elif is_recording(entry.name) and entry.is_file(follow_symlinks=False):
                yield Path(entry.path), entry.stat()


def _described(root: Path, file: Path, status: os.stat_result) -> RecordingFile:
    name = file.relative_to(root).as_posix()
    try:
        description = read_description(file)
        run, behavior, started_at_s, problem = description.run, description.behavior, description.started_unix_s, ""
    except RecordingError as error:
        run, behavior, started_at_s, problem = "", "", status.st_mtime, error.message
    return RecordingFile(
        path=name,
        run=run,
        behavior=behavior,
        started_at_s=started_at_s or status.st_mtime,
        size_bytes=status.st_size,
        changed_at_s=status.st_mtime,
        problem=problem,
    )
