"""A document as it is on disk, and why it cannot be opened or saved."""

from __future__ import annotations

from dataclasses import dataclass

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
