"""A document as it is on disk, and why it cannot be opened or saved."""

from __future__ import annotations

from dataclasses import dataclass

from engine.editing.text.three_way_merge import MergeConflict
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
    """A document changed after the writer read it; `merged` has both changes if they do not conflict."""

    def __init__(self, theirs: StoredDocument, merged: str | None, conflicts: tuple[MergeConflict, ...]) -> None:
        hint = (
            "compare both versions and save again"
            if merged is None
            else "save the merged text, or choose one of the two"
        )
        super().__init__("the document has changed on disk", where=theirs.id, hint=hint)
        self.theirs = theirs
        self.merged = merged
        self.conflicts = conflicts
