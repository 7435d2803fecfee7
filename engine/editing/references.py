"""References between behaviors, and their update when a file moves."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from engine.editing.document_repository import DocumentRepository
from engine.editing.edits.apply import apply_edits
from engine.editing.edits.edit import AnyEdit, SetDocument, SetField
from engine.editing.referring_behavior import ReferringBehavior
from engine.editing.stored_document import StoredDocument
from engine.editing.text.draft import Draft
from engine.editing.text.outline import Outline
from engine.errors import DocumentError


@dataclass(frozen=True, kw_only=True)
class MoveResult:
    """A moved document; `updated` are the documents whose references were updated, `left` those that failed."""

    opened: StoredDocument
    updated: tuple[str, ...] = ()
    left: tuple[str, ...] = ()


def referrers(documents: DocumentRepository, document_id: str) -> tuple[ReferringBehavior, ...]:
    """Return the behaviors of the project that reference a document, sorted by id, without the document itself."""
    return tuple(referrer for referrer, _ in _referring(documents, document_id))


def move_with_references(documents: DocumentRepository, document_id: str, new_id: str, *, follow: bool) -> MoveResult:
    """Rename a document; with `follow`, update every reference to it, and its own references.

    A document whose references cannot be updated, because it is invalid or changes concurrently, is listed in `left`.

    Raises:
        DocumentError: there is no such document, the new id is taken, or it has another format.
    """
    referring = _referring(documents, document_id) if follow else []
    documents.rename(document_id, new_id)
    updated: list[str] = []
    left: list[str] = []
    for referrer, opened in referring:
        written = _relative(new_id, referrer.id)
        edits = [SetField(path=path, field="behavior", value=written) for path in referrer.paths]
        (updated if _rewrite(documents, opened, edits) else left).append(referrer.id)
    if follow and PurePosixPath(document_id).parent != PurePosixPath(new_id).parent:
        own = documents.open(new_id)
        edits = list(_own_edits(own.text, document_id, new_id))
        if edits and not _rewrite(documents, own, edits):
            left.append(new_id)
    return MoveResult(opened=documents.open(new_id), updated=tuple(updated), left=tuple(left))


def _referring(documents: DocumentRepository, document_id: str) -> list[tuple[ReferringBehavior, StoredDocument]]:
    target, name = documents.file_of(document_id), PurePosixPath(document_id).name
    found: list[tuple[ReferringBehavior, StoredDocument]] = []
    for other in sorted(documents.stamps()):
        try:
            # A text that does not contain the name of the file needs no parsing.
            if other == document_id or name.encode() not in documents.file_of(other).read_bytes():
                continue
            opened = documents.open(other)
            data = Draft(opened.text, file=other).data
        except (DocumentError, OSError):
            continue  # not a behavior, or unreadable: the list of behaviors reports the problem
        folder = documents.file_of(other).parent
        written = ((path, ref.data.get("behavior")) for path, ref in Outline(data).refs.items())
        paths = tuple(path for path, file in written if isinstance(file, str) and _names(folder, file, target))
        if paths:
            title = data.get("name")
            referring = ReferringBehavior(id=other, name=title if isinstance(title, str) else other, paths=paths)
            found.append((referring, opened))
    return found


def _names(folder: Path, written: str, target: Path) -> bool:
    try:
        return (folder / written).resolve() == target
    except (OSError, ValueError):
        return False  # not a valid path on this system


def _relative(document_id: str, of: str) -> str:
    return PurePosixPath(os.path.relpath(document_id, PurePosixPath(of).parent)).as_posix()


def _own_edits(text: str, old_id: str, new_id: str) -> Iterator[AnyEdit]:
    """Return the edits that adapt the references of a document to its new folder."""
    folder = PurePosixPath(old_id).parent
    data = Draft(text, file=new_id).data
    for path, ref in Outline(data).refs.items():
        written = ref.data.get("behavior")
        if isinstance(written, str):
            yield SetField(path=path, field="behavior", value=_relative(os.path.normpath(folder / written), new_id))
    cell = data.get("cell")
    if isinstance(cell, str):
        yield SetDocument(changes={"cell": _relative(os.path.normpath(folder / cell), new_id)})


def _rewrite(documents: DocumentRepository, opened: StoredDocument, edits: Sequence[AnyEdit]) -> bool:
    done = apply_edits(opened.text, edits, file=opened.id, context=documents.context(opened.id))
    if done.refused is not None:
        return False
    try:
        documents.save(opened.id, done.text, base_hash=opened.hash)
    except DocumentError:
        return False  # it changed concurrently, or cannot be written; the result reports it
    return True
