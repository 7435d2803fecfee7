"""Detects which engines are alive: an open journal holds a lock that the system releases when its process ends."""

from __future__ import annotations

import fcntl
import os
import secrets
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path


class EnginePresence:
    """One engine that has a journal open; create it with `EnginePresence.open`, end it with `close`."""

    def __init__(self, file: Path, descriptor: int) -> None:
        self.engine = file.name
        """The name of this engine in the journal."""
        self._file = file
        self._descriptor = descriptor

    @classmethod
    def open(cls, journal: Path) -> EnginePresence:
        """Create the lock file of an engine beside the journal file and remove those of dead engines.

        Raises:
            OSError: the folder cannot be written.
        """
        folder = presence_folder(journal)
        folder.mkdir(exist_ok=True)
        _remove_dead(folder)
        file = folder / secrets.token_hex(8)
        # Locked under another name first: another engine would take an unlocked file for that of a dead process.
        new = file.with_name(f".{file.name}")
        descriptor = os.open(new, os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o600)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            os.write(descriptor, str(os.getpid()).encode())
            new.rename(file)
        except OSError:
            os.close(descriptor)
            new.unlink(missing_ok=True)
            raise
        return cls(file, descriptor)

    def close(self) -> None:
        """Remove the lock file; may be called again."""
        if self._descriptor < 0:
            return
        # A folder that has become read-only must not keep the journal from closing: the lock decides, not the file.
        with suppress(OSError):
            self._file.unlink(missing_ok=True)
        os.close(self._descriptor)
        self._descriptor = -1


def living_engines(journal: Path) -> Mapping[str, int]:
    """Return the engines that have this journal open, with their process ids."""
    return {file.name: _pid(file) for file, alive in _engines(presence_folder(journal)) if alive}


def presence_folder(journal: Path) -> Path:
    """Return the folder of the lock files of a journal's engines."""
    return journal.with_name(f"{journal.stem}.engines")


def _remove_dead(folder: Path) -> None:
    for file, alive in _engines(folder):
        if not alive:
            file.unlink(missing_ok=True)


def _engines(folder: Path) -> Iterator[tuple[Path, bool]]:
    if not folder.is_dir():
        return
    for file in sorted(folder.iterdir()):
        if not file.name.startswith("."):
            yield file, _locked(file)


def _locked(file: Path) -> bool:
    try:
        descriptor = os.open(file, os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False  # the engine has ended since the listing
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False  # this file system does not support locks; the fence between engines still holds
    finally:
        os.close(descriptor)
    return False


def _pid(file: Path) -> int:
    try:
        return int(file.read_text(encoding="ascii"))
    except (OSError, ValueError):
        return 0
