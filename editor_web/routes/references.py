"""Fixes of a document's findings, references to it, moving, adapting, restoring, and drawing of older versions."""

from __future__ import annotations

from msgspec.structs import asdict

from editor_web.http_bodies.adaptation_bodies import AdaptationBody, AdaptationRequest
from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.document_bodies import DocumentBody, TextBody, document_body
from editor_web.http_bodies.reference_bodies import (
    CompareBody,
    DeletedDocumentBody,
    FixesBody,
    MoveBody,
    MoveResultBody,
)
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.editing import (
    DocumentAnalysis,
    DocumentDiff,
    ReferringBehavior,
    compare_texts,
    move_with_references,
    plan_adaptation,
    referrers,
    write_adaptation,
)
from engine.editing.fixes import fixes_of

router = WireRouter(
    prefix="/api/v1",
    tags=["documents"],
    responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)


@router.get("/deleted_documents")
def list_deleted(services: ServicesOf) -> list[DeletedDocumentBody]:
    """List the deleted documents that can be restored, last deleted first."""
    return [DeletedDocumentBody(id=each, saved_at=version.saved_at_s) for each, version in services.documents.deleted()]


@router.post("/documents/{document_id:path}/fixes")
def get_fixes(document_id: str, body: TextBody, services: ServicesOf) -> list[FixesBody]:
    """Return the fixes for findings of a text, for those findings that have any."""
    documents = services.documents
    findings = documents.findings(document_id, body.text)
    fixes_by_finding = fixes_of(body.text, findings, file=document_id, context=documents.context(document_id))
    return [
        FixesBody(**asdict(finding), fixes=fixes)
        for finding, fixes in zip(findings, fixes_by_finding, strict=True)
        if fixes
    ]


@router.get("/documents/{document_id:path}/referrers")
def list_referrers(document_id: str, services: ServicesOf) -> tuple[ReferringBehavior, ...]:
    """List the behaviors that refer to a document."""
    return referrers(services.documents, document_id)


@router.post("/documents/{document_id:path}/move")
def move_document(document_id: str, body: MoveBody, services: ServicesOf) -> MoveResultBody:
    """Give a document a new id, and update the references to it if `follow` is set."""
    moved = move_with_references(services.documents, document_id, body.id, follow=body.follow)
    opened = moved.opened
    document = document_body(opened, services.documents.examine(opened.id, opened.text))
    return MoveResultBody(document=document, updated=moved.updated, left=moved.left)


@router.post("/documents/{document_id:path}/restore", status_code=201)
def restore_document(document_id: str, services: ServicesOf) -> DocumentBody:
    """Restore the last text of a deleted document."""
    opened = services.documents.restore(document_id)
    return document_body(opened, services.documents.examine(opened.id, opened.text))


@router.get("/documents/{document_id:path}/versions/{digest}/drawn")
def get_drawn_version(document_id: str, digest: str, services: ServicesOf) -> DocumentAnalysis:
    """Draw a version as the document's text."""
    documents = services.documents
    return documents.draw(document_id, documents.version(document_id, digest))


@router.post("/documents/{document_id:path}/compare")
def compare(document_id: str, body: CompareBody, services: ServicesOf) -> DocumentDiff:
    """Compare two texts of a document node by node."""
    services.documents.file_of(document_id)
    return compare_texts(body.before, body.after, file=document_id)


@router.post("/documents/{document_id:path}/adaptation")
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


@router.post("/documents/{document_id:path}/adapt", status_code=201)
def adapt_document(document_id: str, body: AdaptationRequest, services: ServicesOf) -> DocumentBody:
    """Write the adapted behavior as a new document, with copies of nested behaviors that name things of its cell."""
    documents = services.documents
    written = write_adaptation(documents, document_id, new_id=body.id, name=body.name, choices=body.names)
    return document_body(written, documents.examine(written.id, written.text))
