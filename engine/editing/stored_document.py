"""A document as it is on disk, and why it cannot be opened or saved."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from engine.document.text.yaml_source import MAX_BYTES
from engine.editing.analysis.diagnostics import text_hash
from engine.editing.text.node_merge import NodeMerge
from engine.errors import DocumentError


@dataclass(frozen=True, kw_only=True)
class StoredDocument:
    """A document as it is on disk."""

    id: str
    text: str
    hash: str
    saved_at_s: float


class NoSuchDocument(DocumentError):
    """No document of the project has this id, or no version has this hash."""


class DocumentConflict(DocumentError):
    """A document changed after the writer read it; `merge` has both changes, None where they cannot be merged."""

    def __init__(self, theirs: StoredDocument, merge: NodeMerge | None) -> None:
        hint = (
            "compare both versions and save again"
            if merge is None
            else "save the merged text, or choose for each conflict"
        )
        super().__init__("the document has changed on disk", where=theirs.id, hint=hint)
        self.theirs = theirs
        self.merge = merge


def read_stored(document_id: str, file: Path) -> StoredDocument:
    """Return a document as it is on disk.

    Raises:
        NoSuchDocument: there is no such file.
        DocumentError: it cannot be read, is not UTF-8 or is too large.
    """
    try:
        if not file.is_file():
            raise NoSuchDocument("there is no such document", where=document_id, hint="see the list of behaviors")
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
        saved_at_s = file.stat().st_mtime
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise DocumentError("the file is not UTF-8", where=document_id, hint="save it as UTF-8") from error
    except OSError as error:
        raise DocumentError(f"cannot read this file: {error.strerror}", where=document_id) from error
    if len(content) > MAX_BYTES:
        raise DocumentError("the file is too large for the editor", where=document_id)
    return StoredDocument(id=document_id, text=text, hash=text_hash(text), saved_at_s=saved_at_s)


@contextmanager
def writing_errors(document_id: str) -> Generator[None]:
    """Raise an OS error of a block that writes a document as a DocumentError with the document and a hint."""
    try:
        yield
    except OSError as error:
        raise DocumentError(
            f"the document cannot be written: {error.strerror}",
            where=document_id,
            hint="grant this server write permission in the project folder, or free disk space",
        ) from error
