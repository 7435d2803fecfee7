"""Captures that are not yet saved: in memory, and on disk so that none is lost with the process."""

from __future__ import annotations

import logging
import os
from pathlib import Path

import msgspec

from engine.errors import FlexcellError, StoreError
from engine.host.private_files import make_private_folder, open_private
from engine.skills.teaching import Capture
from engine.wording.suggestions import did_you_mean

MAX_CAPTURES = 200
"""Maximum number of captures; further ones are rejected, because the buffer is not a store."""

_log = logging.getLogger("flexcell.teaching")


class CaptureBuffer:
    """The captures by number, oldest first; without a folder they exist only in memory.

    Args:
        folder: Folder with one file per capture; created with the first one. Unreadable files
            are left unchanged and named in the log.
    """

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder
        self._captures: dict[int, Capture] = {}
        self._last = 0
        if folder is not None and folder.is_dir():
            self._load(folder)

    @property
    def captures(self) -> tuple[Capture, ...]:
        """All captures, oldest first."""
        return tuple(self._captures.values())

    def next_id(self) -> int:
        """Return an unused number.

        Raises:
            StoreError: the buffer is full.
        """
        if len(self._captures) >= MAX_CAPTURES:
            raise StoreError(
                f"{MAX_CAPTURES} captures are not saved yet", where="teach", hint="save or discard some of them"
            )
        return self._last + 1

    def put(self, capture: Capture) -> None:
        """Keep a capture; it replaces the one with the same number.

        Raises:
            StoreError: the capture cannot be written; it is still kept in memory.
        """
        number = capture.summary.id
        self._last = max(self._last, number)
        self._captures[number] = capture
        if self._folder is not None:
            self._write(self._folder, capture)

    def get(self, number: int) -> Capture:
        """Return a capture; raises StoreError if no capture has this number."""
        found = self._captures.get(number)
        if found is None:
            hint = did_you_mean(str(number), [str(one) for one in self._captures])
            raise StoreError(f"there is no capture {number}", where="teach", hint=hint or "the buffer is empty")
        return found

    def discard(self, number: int) -> None:
        """Delete a capture if it exists."""
        if self._captures.pop(number, None) is not None and self._folder is not None:
            self._file(self._folder, number).unlink(missing_ok=True)

    def _load(self, folder: Path) -> None:
        for file in sorted(folder.glob("capture-*.json")):
            try:
                capture = msgspec.json.decode(file.read_bytes(), type=Capture)
            except (OSError, msgspec.DecodeError, ValueError, FlexcellError) as error:
                _log.warning("%s is not a valid capture and is ignored: %s", file, error)
                continue
            self._captures[capture.summary.id] = capture
        self._captures = dict(sorted(self._captures.items()))
        self._last = max(self._captures, default=0)

    def _write(self, folder: Path, capture: Capture) -> None:
        file = self._file(folder, capture.summary.id)
        part = file.with_suffix(".part")
        try:
            make_private_folder(folder)
            with open_private(part) as stream:
                stream.write(msgspec.json.encode(capture))
                stream.flush()
                os.fsync(stream.fileno())
            part.replace(file)
        except OSError as error:
            raise StoreError(
                f"a capture cannot be written to disk: {error.strerror or error}",
                where=str(file),
                hint="save it to the store before the program ends",
            ) from error

    @staticmethod
    def _file(folder: Path, number: int) -> Path:
        return folder / f"capture-{number:06d}.json"
