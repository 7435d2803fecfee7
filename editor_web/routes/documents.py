"""Documents under edit: requests carry the text, edits are functions of it; only `PUT` changes the file on disk."""

from __future__ import annotations

from typing import Annotated

from fastapi import HTTPException, Query, Response
from msgspec.structs import asdict
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.document_bodies import (
    ConflictBody,
    CopyBody,
    CopyResultBody,
    DocumentBody,
    DraftBody,
    EditsBody,
    MergeBody,
    NewDocumentBody,
    NewIdBody,
    PictureBody,
    SaveBody,
    SaveResultBody,
    TargetFindingsBody,
    TargetsBody,
    TextBody,
    VersionBody,
    VersionTextBody,
    conflict_body,
    document_body,
)
from editor_web.routes.services import Services, ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.editing import (
    DocumentAnalysis,
    DocumentDiff,
    EditAnswer,
    KeyFlow,
    StoredDocument,
    compare_texts,
    copy_nodes,
    pdf_of,
)
from engine.library import FindingView

PDF = "application/pdf"

router = WireRouter(
    prefix="/api/v1/documents",
    tags=["documents"],
    responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)


@router.post("", status_code=201)
def create_document(body: NewDocumentBody, services: ServicesOf) -> DocumentBody:
    """Create a document from a template; its id is its path, `behaviors/folder/name.yaml`."""
    created = services.documents.create(body.id, template=body.template, name=body.name)
    return _document(services, created)


@router.post("/{document_id:path}/draft")
def draft(document_id: str, body: DraftBody, services: ServicesOf) -> DocumentAnalysis:
    """Draw and check a text as the document's; an unreadable text has findings and no graph."""
    documents = services.documents
    analyze = documents.examine if body.check else documents.draw
    return analyze(document_id, body.text)


@router.post("/{document_id:path}/findings")
def find(document_id: str, body: TextBody, services: ServicesOf) -> tuple[FindingView, ...]:
    """Check a text as the document's, without drawing it."""
    return services.documents.findings(document_id, body.text)


@router.post("/{document_id:path}/targets")
async def find_targets(document_id: str, body: TargetsBody, services: ServicesOf) -> TargetFindingsBody:
    """Check that the arms of a text's cell reach its targets; the first check takes seconds and blocks nothing else."""
    documents = services.documents
    file = documents.file_of(document_id)
    drawn = await run_in_threadpool(documents.draw, document_id, body.text)
    if drawn.document is None or drawn.document.cell is None:
        return TargetFindingsBody()
    checked = await services.targets.findings(f"{body.page} {document_id}", file, body.text)
    if checked is None:
        return TargetFindingsBody(dropped=True)
    return TargetFindingsBody(**asdict(checked))


@router.post("/{document_id:path}/names")
def find_names(document_id: str, body: TextBody, services: ServicesOf) -> dict[str, tuple[str, ...]]:
    """Return the names in the cell of a text, by kind; those of the open cell if the text names no cell."""
    return {str(kind): names for kind, names in services.documents.offered_to(document_id, body.text).items()}


@router.post("/{document_id:path}/edits")
def edit(document_id: str, body: EditsBody, services: ServicesOf) -> EditAnswer:
    """Apply edits to a text, all or none; nothing is saved. A graph that the server knows comes as a difference."""
    return services.documents.edit(document_id, body.text, body.edits, check=body.check, graph=body.graph)


@router.post("/{document_id:path}/merge")
def merge(document_id: str, body: MergeBody, services: ServicesOf) -> ConflictBody:
    """Merge a text with the document on disk by nodes, with a side for each conflict; nothing is saved."""
    merged = services.documents.merge(document_id, body.text, base_hash=body.base_hash, sides=body.sides)
    return conflict_body(merged)


@router.post("/{document_id:path}/data_flow")
def get_data_flow(document_id: str, body: TextBody, services: ServicesOf) -> tuple[KeyFlow, ...]:
    """Return the writers and readers of each key of a text; 422 if it is not a valid behavior."""
    return services.documents.data_flow(document_id, body.text)


@router.post("/{document_id:path}/copy")
def copy(document_id: str, body: CopyBody, services: ServicesOf) -> CopyResultBody:
    """Return nodes of a text as YAML with their comments, ready to paste."""
    context = services.documents.context(document_id)
    return CopyResultBody(yaml=copy_nodes(body.text, body.paths, file=document_id, context=context))


@router.post("/{document_id:path}/pdf", responses={200: {"content": {PDF: {}}}})
def write_pdf(document_id: str, body: PictureBody) -> Response:
    """Return the drawing of a document as a PDF; 422 if it is no drawing of a behavior."""
    del document_id
    return Response(pdf_of(body.svg), media_type=PDF)


@router.post("/{document_id:path}/rename")
def rename_document(document_id: str, body: NewIdBody, services: ServicesOf) -> DocumentBody:
    """Give a document a new id; it keeps its versions."""
    return _document(services, services.documents.rename(document_id, body.id))


@router.post("/{document_id:path}/duplicate", status_code=201)
def duplicate_document(document_id: str, body: NewIdBody, services: ServicesOf) -> DocumentBody:
    """Copy a document on disk."""
    return _document(services, services.documents.duplicate(document_id, body.id))


@router.get("/{document_id:path}/versions")
def list_versions(document_id: str, services: ServicesOf) -> list[VersionBody]:
    """List the versions of a document, newest first, also of a deleted one."""
    versions = services.documents.versions(document_id)
    now = services.documents.hash_on_disk(document_id)
    return [
        VersionBody(hash=each.hash, saved_at=each.saved_at_s, by=each.by, current=each.hash == now) for each in versions
    ]


@router.get("/{document_id:path}/versions/{digest}")
def get_version(document_id: str, digest: str, services: ServicesOf) -> VersionTextBody:
    """Return the text of a version."""
    versions = services.documents.versions(document_id)
    version = next((each for each in versions if each.hash == digest), None)
    if version is None:
        raise HTTPException(404, "no such version of this document")
    text = services.documents.version(document_id, digest)
    current = digest == services.documents.hash_on_disk(document_id)
    return VersionTextBody(hash=digest, saved_at=version.saved_at_s, by=version.by, current=current, text=text)


@router.get("/{document_id:path}/diff")
def get_difference(
    document_id: str, services: ServicesOf, before: Annotated[str, Query(alias="from", pattern="^[0-9a-f]{64}$")],
    after: Annotated[str, Query(alias="to", pattern="^([0-9a-f]{64})?$")] = "",
) -> DocumentDiff:  # fmt: skip
    """Compare two versions node by node; without `to`, compare with the document on disk."""
    documents = services.documents
    old = documents.version(document_id, before)
    new = documents.version(document_id, after) if after else documents.open(document_id).text
    return compare_texts(old, new, file=document_id)


@router.get("/{document_id:path}")
def get_document(document_id: str, services: ServicesOf, check: bool = True) -> DocumentBody:
    """Return a document on disk, drawn and checked; without `check` the response is faster and has no findings."""
    opened = services.documents.open(document_id)
    analyze = services.documents.examine if check else services.documents.draw
    return document_body(opened, analyze(opened.id, opened.text))


@router.put("/{document_id:path}", responses={409: {"model": ConflictBody}})
def save_document(document_id: str, body: SaveBody, services: ServicesOf) -> SaveResultBody:
    """Write a document; 409 with both texts and their merge if it has changed on disk since it was read."""
    saved = services.documents.save(document_id, body.text, base_hash=body.base_hash)
    return SaveResultBody(hash=saved.hash, saved_at=saved.saved_at_s)


@router.delete("/{document_id:path}", status_code=204)
def delete_document(document_id: str, services: ServicesOf) -> None:
    """Delete a document; its text is kept as a version."""
    services.documents.delete(document_id)


def _document(services: Services, opened: StoredDocument) -> DocumentBody:
    return document_body(opened, services.documents.examine(opened.id, opened.text))
