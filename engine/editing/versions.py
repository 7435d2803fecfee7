"""The versions of documents: every text that was opened or saved, by its hash, in a folder next to the project."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from engine.editing.analysis.diagnostics import text_hash
from engine.editing.stored_document import DocumentConflict, StoredDocument, read_stored
from engine.editing.text.node_merge import NodeMerge
from engine.errors import DocumentError

MAX_VERSIONS = 200
"""Maximum number of versions kept for a document; the oldest are removed first."""
_NAME = re.compile(r"(\d{13})-([0-9a-f]{64})(\.editor)?")
VersionAuthor = Literal["editor", "file"]


@dataclass(frozen=True, kw_only=True)
class DocumentVersion:
    """One version; `saved_at_s` is when it was first seen, seconds since 1970.

    `by` says whether the editor wrote it or another program did.
    """

    hash: str
    saved_at_s: float
    by: VersionAuthor = "file"


@dataclass(frozen=True)
class _Kept:
    """One file of the folder of a document."""

    stamp: int
    digest: str
    by: VersionAuthor

    @property
    def name(self) -> str:
        return f"{self.stamp:013d}-{self.digest}{'.editor' if self.by == 'editor' else ''}"

    def version(self) -> DocumentVersion:
        return DocumentVersion(hash=self.digest, saved_at_s=self.stamp / 1000, by=self.by)


class VersionHistory:
    """The versions under `folder`, a folder for each document by its id; `now_s` is the wall clock."""

    def __init__(self, folder: Path, *, now_s: Callable[[], float]) -> None:
        self._folder = folder
        self._now_s = now_s

    def keep(self, document_id: str, text: str, *, by: VersionAuthor = "file") -> DocumentVersion:
        """Keep a text unless it is kept already; a text that is kept again becomes the latest."""
        digest = text_hash(text)
        known = self._files(document_id)
        latest = known[-1] if known else None
        if latest is not None and latest.digest == digest:
            return latest.version()
        stamp = max(int(self._now_s() * 1000), latest.stamp + 1 if latest is not None else 0)
        folder = self._folder / document_id
        folder.mkdir(parents=True, exist_ok=True)
        old = next((each for each in known if each.digest == digest), None)
        made = _Kept(stamp, digest, by)
        if old is not None:
            (folder / old.name).replace(folder / made.name)
        else:
            write_atomically(folder / made.name, text)
        for gone in self._files(document_id)[:-MAX_VERSIONS]:
            (folder / gone.name).unlink(missing_ok=True)
        return made.version()

    def all(self, document_id: str) -> tuple[DocumentVersion, ...]:
        """Return the versions of a document, newest first."""
        return tuple(each.version() for each in reversed(self._files(document_id)))

    def ids(self) -> tuple[str, ...]:
        """Return the ids of all documents that have versions, sorted."""
        found = {
            file.parent.relative_to(self._folder).as_posix()
            for file in self._folder.rglob("*")
            if _NAME.fullmatch(file.name)
        }
        return tuple(sorted(found))

    def text(self, document_id: str, digest: str) -> str:
        """Return a version.

        Raises:
            DocumentError: the version is not kept, or no longer kept.
        """
        for kept in self._files(document_id):
            if kept.digest == digest:
                return (self._folder / document_id / kept.name).read_bytes().decode("utf-8")
        raise DocumentError("this version is not kept", where=document_id, hint="see the list of versions")

    def rename(self, old_id: str, new_id: str) -> None:
        """Move the versions of a renamed document."""
        old, new = self._folder / old_id, self._folder / new_id
        if old.is_dir():
            new.mkdir(parents=True, exist_ok=True)
            for file in old.iterdir():
                if _NAME.fullmatch(file.name):
                    file.replace(new / file.name)

    def _files(self, document_id: str) -> list[_Kept]:
        folder = self._folder / document_id
        if not folder.is_dir():
            return []
        found = (_NAME.fullmatch(file.name) for file in folder.iterdir())
        kept = [_Kept(int(name[1]), name[2], "editor" if name[3] else "file") for name in found if name]
        return sorted(kept, key=lambda each: (each.stamp, each.digest))


def write_atomically(file: Path, content: str | bytes) -> None:
    """Replace a file atomically: readers see the old or the new content, even after a power failure."""
    fresh = file.with_name(f".{file.name}.new")
    try:
        with fresh.open("wb") as stream:
            stream.write(content.encode("utf-8") if isinstance(content, str) else content)
            stream.flush()
            os.fsync(stream.fileno())
        if file.exists():
            fresh.chmod(file.stat().st_mode & 0o7777)
        fresh.replace(file)
    except OSError:
        fresh.unlink(missing_ok=True)
        raise


def save_checked(
    document_id: str,
    file: Path,
    text: str,
    *,
    base_hash: str,
    versions: VersionHistory,
    merged: Callable[[StoredDocument], NodeMerge | None],
) -> StoredDocument:
    """Write a document unless another text than that with `base_hash` is there; nothing that anybody wrote is lost.

    Args:
        document_id: Its id.
        file: Where it is.
        text: What is to be written.
        base_hash: The text that the writer began from.
        versions: Keeps what is there, and what is written.
        merged: Merges the text with what is there.

    Raises:
        DocumentConflict: the document has another text now; both are kept.
        DocumentError: it cannot be read.
        OSError: it cannot be written.
    """
    there = read_stored(document_id, file)
    if there.hash == text_hash(text):
        return there
    if there.hash != base_hash:
        # Whatever is chosen, neither text is lost.
        versions.keep(document_id, text, by="editor")
    versions.keep(document_id, there.text)
    if there.hash != base_hash:
        raise DocumentConflict(there, merged(there))
    write_atomically(file, text)
    versions.keep(document_id, text, by="editor")
    return read_stored(document_id, file)
