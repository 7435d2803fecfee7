"""Bodies of the editor: texts and edits, documents with their graph and findings, their versions, the catalogue."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import msgspec
from msgspec import Meta

from editor_web.http_bodies.common_bodies import ErrorBody, RequestBody
from engine.document import MAX_BYTES
from engine.editing import (
    AnyEdit,
    BehaviorReferenceView,
    ContainerView,
    DocumentAnalysis,
    DocumentConflict,
    NodeMerge,
    Side,
    StateView,
    StoredDocument,
    TargetFindings,
)

Text = Annotated[str, Meta(max_length=MAX_BYTES)]
Hash = Annotated[str, Meta(pattern="^[0-9a-f]{64}$")]
Path = Annotated[str, Meta(max_length=4000)]
Id = Annotated[str, Meta(max_length=300)]


@dataclass(frozen=True, kw_only=True)
class DocumentBody(DocumentAnalysis):
    """A document on disk; `saved_at` is the time of its last change, seconds since 1970."""

    id: str
    text: str
    saved_at: float


class CopyResultBody(msgspec.Struct, frozen=True, kw_only=True):
    """Nodes as YAML, ready to paste."""

    yaml: str


class TextBody(RequestBody, frozen=True, kw_only=True):
    """A text under edit."""

    text: Text


class PictureBody(RequestBody, frozen=True, kw_only=True):
    """The drawing of a behavior, as the page exports it."""

    svg: str


class TargetsBody(TextBody, frozen=True, kw_only=True):
    """A text whose targets are checked; a newer request of the same page replaces the pending one."""

    page: Annotated[str, Meta(max_length=40)]


class TargetFindingsBody(TargetFindings, frozen=True, kw_only=True):
    """The targets that an arm of the document's cell cannot reach; `dropped` if the page has sent a newer text."""

    dropped: bool = False


class DraftBody(TextBody, frozen=True, kw_only=True):
    """A text to draw; without `check` the response is faster and has no findings."""

    check: bool = True


class EditsBody(DraftBody, frozen=True, kw_only=True):
    """A text and the edits to apply, all or none.

    `graph` is the hash of the text whose graph the page has; the answer then has only the difference, if the server
    knows that graph too.
    """

    edits: Annotated[tuple[AnyEdit, ...], Meta(max_length=500)]
    graph: Hash | None = None


class CopyBody(TextBody, frozen=True, kw_only=True):
    """A text and the nodes to copy from it."""

    paths: Annotated[list[Path], Meta(max_length=1000)]


class SaveBody(TextBody, frozen=True, kw_only=True):
    """A text to write, and the hash of the version it is based on."""

    base_hash: Hash


class SaveResultBody(msgspec.Struct, frozen=True, kw_only=True):
    """The version that is on disk now."""

    hash: str
    saved_at: float


class ConflictBody(ErrorBody, frozen=True, kw_only=True):
    """The document has changed on disk; `merge` has both changes, null if they cannot be merged by nodes."""

    theirs: str
    theirs_hash: str
    merge: NodeMerge | None


class MergeBody(SaveBody, frozen=True, kw_only=True):
    """A text to merge with the one on disk, and the side to take for conflicts, by `path field`."""

    sides: dict[Path, Side] = {}


class NewDocumentBody(RequestBody, frozen=True, kw_only=True):
    """A document to create from a template: machine, sequence or concurrency."""

    id: Id
    name: Annotated[str, Meta(max_length=128)] = ""
    template: Annotated[str, Meta(max_length=40)] = "machine"


class NewIdBody(RequestBody, frozen=True, kw_only=True):
    """The new id of a document or of its copy."""

    id: Id


class VersionBody(msgspec.Struct, frozen=True, kw_only=True):
    """One version of a document and when it was first seen; `by` is `editor`, or `file` for a change on disk."""

    hash: str
    saved_at: float
    by: str
    current: bool


class VersionTextBody(VersionBody, frozen=True, kw_only=True):
    """A version with its text."""

    text: str


class EntryName(msgspec.Struct, frozen=True, kw_only=True):
    """A named entry of the cell's store."""

    kind: str
    name: str


class CatalogueBody(msgspec.Struct, frozen=True, kw_only=True):
    """Everything that a behavior can use.

    `names` are the names in the open cell by kind, the `cell_name` in the JSON Schema of a parameter: robots, parts,
    cameras, frames. A tool, link, output or label has the prefix of its owner: `left/panda_hand`.
    """

    states: tuple[StateView, ...]
    containers: tuple[ContainerView, ...]
    behaviors: tuple[BehaviorReferenceView, ...]
    entries: tuple[EntryName, ...]
    names: dict[str, tuple[str, ...]]


def document_body(stored: StoredDocument, analysis: DocumentAnalysis) -> DocumentBody:
    """Return a document with its analysis."""
    return DocumentBody(**vars(analysis), id=stored.id, text=stored.text, saved_at=stored.saved_at_s)


def conflict_body(error: DocumentConflict) -> ConflictBody:
    """Return what a save has met."""
    return ConflictBody(
        message=error.message,
        where=error.theirs.id,
        hint=error.hint or "",
        theirs=error.theirs.text,
        theirs_hash=error.theirs.hash,
        merge=error.merge,
    )
