"""What stands around a document: fixes of its findings, who refers to it, moving, restoring, older texts drawn."""

from __future__ import annotations

from typing import Any, cast

import msgspec
from fastapi import APIRouter

from editor_web.document_wire import DifferenceBody, DocumentBody, DraftedBody, TextBody
from editor_web.relation_wire import CompareBody, DeletedBody, FixBody, FixesBody, MoveBody, MovedBody, ReferrerBody
from editor_web.routes.document_route import DocumentRoute
from editor_web.routes.services import ServicesOf
from editor_web.wire import ErrorBody
from engine.editing.comparison import compare_texts
from engine.editing.mending import Fix, fixes_of
from engine.editing.references import move, referrers

router = APIRouter(
    prefix="/api/v1",
    tags=["documents"],
    route_class=DocumentRoute,
    responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)


@router.get("/deleted_documents")
def list_deleted(services: ServicesOf) -> list[DeletedBody]:
    """List the documents that were deleted and can be restored, those deleted last first."""
    return [DeletedBody(id=each, saved_at=version.saved_at_s) for each, version in services.documents.deleted()]


@router.post("/documents/{document_id:path}/fixes")
def get_fixes(document_id: str, body: TextBody, services: ServicesOf) -> list[FixesBody]:
    """Return edits that would mend findings of a text, for those findings that have some."""
    documents = services.documents
    findings = documents.findings(document_id, body.text)
    found = fixes_of(body.text, findings, file=document_id, knowledge=documents.knowledge(document_id))
    return [
        FixesBody(
            code=finding.code, path=finding.path, line=finding.line, message=finding.message,
            fixes=tuple(map(_fix, fixes)),
        )
        for finding, fixes in zip(findings, found, strict=True)
        if fixes
    ]  # fmt: skip


@router.get("/documents/{document_id:path}/referrers")
def list_referrers(document_id: str, services: ServicesOf) -> list[ReferrerBody]:
    """List the behaviors that refer to a document."""
    return [ReferrerBody.model_validate(each) for each in referrers(services.documents, document_id)]


@router.post("/documents/{document_id:path}/move")
def move_document(document_id: str, body: MoveBody, services: ServicesOf) -> MovedBody:
    """Give a document another id, and write the references to it anew where that is asked for."""
    moved = move(services.documents, document_id, body.id, follow=body.follow)
    opened = moved.opened
    drafted = DraftedBody.model_validate(services.documents.examine(opened.id, opened.text))
    document = DocumentBody(id=opened.id, text=opened.text, saved_at=opened.saved_at_s, **dict(drafted))
    return MovedBody(document=document, followed=moved.followed, left=moved.left)


@router.post("/documents/{document_id:path}/restore", status_code=201)
def restore_document(document_id: str, services: ServicesOf) -> DocumentBody:
    """Write a deleted document again, as it was last."""
    opened = services.documents.restore(document_id)
    drafted = DraftedBody.model_validate(services.documents.examine(opened.id, opened.text))
    return DocumentBody(id=opened.id, text=opened.text, saved_at=opened.saved_at_s, **dict(drafted))


@router.get("/documents/{document_id:path}/versions/{digest}/drawn")
def get_drawn_version(document_id: str, digest: str, services: ServicesOf) -> DraftedBody:
    """Draw a version as if it were the document's text now."""
    documents = services.documents
    return DraftedBody.model_validate(documents.draw(document_id, documents.version(document_id, digest)))


@router.post("/documents/{document_id:path}/compare")
def compare(document_id: str, body: CompareBody, services: ServicesOf) -> DifferenceBody:
    """Compare two texts of a document node by node."""
    services.documents.file_of(document_id)
    return DifferenceBody.model_validate(compare_texts(body.before, body.after, file=document_id))


def _fix(fix: Fix) -> FixBody:
    plain = cast("list[dict[str, Any]]", msgspec.to_builtins(fix.edits))
    return FixBody(title=fix.title, edits=tuple(plain))
