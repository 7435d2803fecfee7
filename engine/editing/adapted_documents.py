"""Behaviors of other cells adapted to the open cell, as documents of the project."""

from __future__ import annotations

from collections.abc import Mapping

from engine.editing.adaptation.adaptation import AdaptedBehavior, adapt, proposed_file
from engine.editing.document_repository import DocumentRepository
from engine.editing.stored_document import StoredDocument
from engine.errors import DocumentError


def plan_adaptation(
    documents: DocumentRepository, document_id: str, *, new_id: str = "", name: str = "", choices: Mapping[str, str]
) -> tuple[str, AdaptedBehavior]:
    """Return the id of the new document and what would be written; nothing is.

    Args:
        documents: The documents of the project.
        document_id: The behavior of another cell.
        new_id: Id of the new document; one beside the original if empty.
        name: The name of the new behavior; made of the old name and that of the cell if empty.
        choices: What names become, by `kind:name`; others are proposed.

    Raises:
        DocumentError: no cell is open, or the behavior cannot be read or names no cell.
        FlexcellError: a choice is for no name of the behavior, or the open cell has no such thing.
    """
    cell = documents.cell
    if cell is None:
        raise DocumentError("no cell is open", where=document_id, hint="serve the cell that it is adapted to")
    opened = documents.open(document_id)
    file = documents.file_of(document_id)
    output = documents.file_of(new_id) if new_id else proposed_file(file, cell)
    made = adapt(
        opened.text,
        file=file,
        output=output,
        name=name,
        cell=cell,
        context=documents.context(document_id),
        choices=choices,
    )
    return output.relative_to(documents.project).as_posix(), made


def write_adaptation(
    documents: DocumentRepository, document_id: str, *, new_id: str, name: str = "", choices: Mapping[str, str]
) -> StoredDocument:
    """Write the new document, after the copies of the behaviors inside it; the original does not change.

    Raises:
        DocumentError: as `plan_adaptation`, or the id is taken.
        FlexcellError: as `plan_adaptation`.
    """
    if documents.file_of(new_id).exists():
        raise DocumentError("there is a document with this id", where=new_id, hint="choose another name")
    _, made = plan_adaptation(documents, document_id, new_id=new_id, name=name, choices=choices)
    stored = [
        documents.add(each.file.relative_to(documents.project).as_posix(), each.text)
        for each in reversed(made.documents)
    ]
    return stored[-1]
