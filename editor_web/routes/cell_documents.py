"""The documents of the cell and of its modules under edit; only `PUT` changes a file, nothing changes the open cell."""

from __future__ import annotations

from editor_web.http_bodies.cell_document_bodies import CellDocumentBody, CellEditsBody
from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.document_bodies import ConflictBody, SaveBody, SaveResultBody, TextBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.editing.cells import CellDocumentName, CellDraft, CellEditAnswer

router = WireRouter(
    prefix="/api/v1/cell_documents",
    tags=["cell"],
    responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)


@router.get("")
def list_cell_documents(services: ServicesOf) -> tuple[CellDocumentName, ...]:
    """List the document of the open cell, if it is in the project, and the modules of the project."""
    return services.documents.cells.listed()


@router.post("/{document_id:path}/draft")
def read_cell_draft(document_id: str, body: TextBody, services: ServicesOf) -> CellDraft:
    """Read and check a text as the document's; one that cannot be read has findings and no items."""
    return services.documents.cells.examine(document_id, body.text)


@router.post("/{document_id:path}/edits")
def edit_cell_document(document_id: str, body: CellEditsBody, services: ServicesOf) -> CellEditAnswer:
    """Apply edits to a text, all or none; nothing is saved."""
    return services.documents.cells.edit(document_id, body.text, body.edits)


@router.get("/{document_id:path}")
def get_cell_document(document_id: str, services: ServicesOf) -> CellDocumentBody:
    """Return a document on disk, with its items and findings."""
    opened = services.documents.cells.open(document_id)
    return CellDocumentBody(id=opened.stored.id, saved_at=opened.stored.saved_at_s, draft=opened.draft)


@router.put("/{document_id:path}", responses={409: {"model": ConflictBody}})
def save_cell_document(document_id: str, body: SaveBody, services: ServicesOf) -> SaveResultBody:
    """Write a document; 409 with both texts and their merge, if any, if it has changed on disk since it was read."""
    saved = services.documents.cells.save(document_id, body.text, base_hash=body.base_hash)
    return SaveResultBody(hash=saved.hash, saved_at=saved.saved_at_s)
