"""Tells which engines are alive: an open journal holds a lock that ends with its process, however that ends."""

from __future__ import annotations

import fcntl
import os
import secrets
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path


class EnginePresence:
    """One engine that has a journal open; make it with `Presence.open`, end it with `close`."""

    def __init__(self, file: Path, descriptor: int) -> None:
        self.engine = file.name
        """The name under which the journal knows it."""
        self._file = file
        self._descriptor = descriptor

    @classmethod
    def open(cls, journal: Path) -> EnginePresence:
        """Announce an engine beside the journal file and forget those that died.

        Raises:
            OSError: the folder cannot be written.
        """
        folder = presence_folder(journal)
        folder.mkdir(exist_ok=True)
        _forget_dead(folder)
        file = folder / secrets.token_hex(8)
        # Locked under another name first, or somebody would take it for one whose process has died.
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
        """Take it back; may be called again."""
        if self._descriptor < 0:
            return
        # A folder that has become read-only must not keep the journal from closing: the lock says it all.
        with suppress(OSError):
            self._file.unlink(missing_ok=True)
        os.close(self._descriptor)
        self._descriptor = -1


def living_engines(journal: Path) -> Mapping[str, int]:
    """Return the engines that have this journal open now, with the ids of their processes."""
    return {file.name: _pid(file) for file, alive in _engines(presence_folder(journal)) if alive}


def presence_folder(journal: Path) -> Path:
    """Return where the engines of a journal file announce themselves."""
    return journal.with_name(f"{journal.stem}.engines")


def _forget_dead(folder: Path) -> None:
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
        return False  # it ended between the listing and now
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False  # this file system knows no locks; the fence between engines still holds
    finally:
        os.close(descriptor)
    return False


def _pid(file: Path) -> int:
    try:
        return int(file.read_text(encoding="ascii"))
    except (OSError, ValueError):
        return 0
