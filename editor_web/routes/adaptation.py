"""Adapting a behavior of another cell to the open one: what would become of it, and the new document."""

from __future__ import annotations

from editor_web.http_bodies.adaptation_bodies import AdaptationBody, AdaptationRequest
from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.document_bodies import DocumentBody, document_body
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.editing import plan_adaptation, write_adaptation

router = WireRouter(
    prefix="/api/v1/documents",
    tags=["documents"],
    responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)


@router.post("/{document_id:path}/adaptation")
def propose_adaptation(document_id: str, body: AdaptationRequest, services: ServicesOf) -> AdaptationBody:
    """Map the names of a behavior to the open cell and check the result; nothing is written."""
    documents = services.documents
    new_id, made = plan_adaptation(documents, document_id, new_id=body.id, name=body.name, choices=body.names)
    return AdaptationBody(
        id=new_id,
        name=made.name,
        plan=made.plan,
        copies=tuple(each.file.relative_to(documents.project).as_posix() for each in made.documents[1:]),
    )


@router.post("/{document_id:path}/adapt", status_code=201)
def adapt_document(document_id: str, body: AdaptationRequest, services: ServicesOf) -> DocumentBody:
    """Write the adapted behavior as a new document, with copies of nested behaviors that name things of its cell."""
    documents = services.documents
    written = write_adaptation(documents, document_id, new_id=body.id, name=body.name, choices=body.names)
    return document_body(written, documents.examine(written.id, written.text))
