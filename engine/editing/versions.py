"""The versions of documents: every text that was opened or saved, by its hash, in a folder beside the project."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from engine.editing.examination import hash_of
from engine.errors import DocumentError

KEPT = 200
"""So many versions of a document are kept; the oldest go first."""
_NAME = re.compile(r"(\d{13})-([0-9a-f]{64})")


@dataclass(frozen=True, kw_only=True)
class Version:
    """One version; `saved_at_s` is when it was first seen, seconds since 1970."""

    hash: str
    saved_at_s: float


class Versions:
    """The versions under `folder`, a folder for each document by its id; `now_s` is the wall clock."""

    def __init__(self, folder: Path, *, now_s: Callable[[], float]) -> None:
        self._folder = folder
        self._now_s = now_s

    def keep(self, document_id: str, text: str) -> Version:
        """Keep a text unless it is kept already; what is kept again becomes the newest."""
        digest = hash_of(text)
        known = self._files(document_id)
        newest = known[-1] if known else None
        if newest is not None and newest[1] == digest:
            return Version(hash=digest, saved_at_s=newest[0] / 1000)
        stamp = max(int(self._now_s() * 1000), newest[0] + 1 if newest is not None else 0)
        folder = self._folder / document_id
        folder.mkdir(parents=True, exist_ok=True)
        old = next((each for each in known if each[1] == digest), None)
        target = folder / f"{stamp:013d}-{digest}"
        if old is not None:
            (folder / f"{old[0]:013d}-{digest}").replace(target)
        else:
            write_whole(target, text)
        for millis, gone in self._files(document_id)[:-KEPT]:
            (folder / f"{millis:013d}-{gone}").unlink(missing_ok=True)
        return Version(hash=digest, saved_at_s=stamp / 1000)

    def all(self, document_id: str) -> tuple[Version, ...]:
        """Return the versions of a document, newest first."""
        return tuple(
            Version(hash=digest, saved_at_s=stamp / 1000) for stamp, digest in reversed(self._files(document_id))
        )

    def text(self, document_id: str, digest: str) -> str:
        """Return a version.

        Raises:
            DocumentError: it is not kept, or no longer.
        """
        for stamp, known in self._files(document_id):
            if known == digest:
                return (self._folder / document_id / f"{stamp:013d}-{known}").read_bytes().decode("utf-8")
        raise DocumentError("this version is not kept", where=document_id, hint="see the list of versions")

    def rename(self, old_id: str, new_id: str) -> None:
        """Let the versions of a document go along with it."""
        old, new = self._folder / old_id, self._folder / new_id
        if old.is_dir():
            new.mkdir(parents=True, exist_ok=True)
            for file in old.iterdir():
                if _NAME.fullmatch(file.name):
                    file.replace(new / file.name)

    def _files(self, document_id: str) -> list[tuple[int, str]]:
        folder = self._folder / document_id
        if not folder.is_dir():
            return []
        found = (_NAME.fullmatch(file.name) for file in folder.iterdir())
        return sorted((int(name[1]), name[2]) for name in found if name)


def write_whole(file: Path, text: str) -> None:
    """Write a file so that everybody sees either the old or the new one, also after a loss of power."""
    fresh = file.with_name(f".{file.name}.new")
    with fresh.open("wb") as stream:
        stream.write(text.encode("utf-8"))
        stream.flush()
        os.fsync(stream.fileno())
    if file.exists():
        fresh.chmod(file.stat().st_mode & 0o7777)
    fresh.replace(file)
