"""The open cell: what it consists of, whether its devices are connected, and reconnection of lost ones.

Beside it the documents of the cell and of its modules under edit: only `PUT` changes a file, nothing changes the open
cell.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Query, Response
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.cell_document_bodies import CellDocumentBody, CellEditsBody
from editor_web.http_bodies.common_bodies import ConnectBody, ErrorBody, SimulationBody
from editor_web.http_bodies.document_bodies import (
    ConflictBody,
    SaveBody,
    SaveResultBody,
    TargetFindingsBody,
    TargetsBody,
    TextBody,
)
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.cell import (
    CellConnection,
    CellItems,
    DeviceDetails,
    ModelNames,
    SceneFiles,
    SceneFormat,
    devices_of_cell,
    items_of_cell,
    model_names,
)
from engine.editing import ReferringBehavior
from engine.editing.cells import CellDocumentName, CellDraft, CellEditAnswer
from engine.errors import CellError

SCENE_TYPES: dict[str, dict[str, str]] = {"model/gltf-binary": {}, "application/xml": {}, "application/zip": {}}
_scene_files = SceneFiles()

router = WireRouter(prefix="/api/v1/cell", tags=["cell"])
documents = WireRouter(
    prefix="/api/v1/cell_documents",
    tags=["cell"],
    responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)


@router.get("/items")
async def get_items(services: ServicesOf) -> CellItems:
    """Return the items of the open cell: robots, tools, fixtures, parts, cameras and what else it has."""
    backend = services.backend
    topics = [topic.name for topic in backend.inspector.topics()]
    return await run_in_threadpool(items_of_cell, backend.cell.document, name=backend.cell_name, topics=topics)


@router.get("/models")
def get_model_names(services: ServicesOf) -> ModelNames:
    """Return the models of robots and tools that the document of a cell may name."""
    del services
    return model_names()


@router.get("/devices")
async def get_devices(services: ServicesOf) -> tuple[DeviceDetails, ...]:
    """Return the devices with a driver: what it can do, what enabling does, its options and their schema."""
    return await run_in_threadpool(devices_of_cell, services.backend.cell.document)


@router.get(
    "/scene",
    responses={200: {"content": SCENE_TYPES}, 409: {"model": ErrorBody}, 422: {"model": ErrorBody}},
)
async def get_scene(services: ServicesOf, scene_format: Annotated[SceneFormat, Query(alias="format")]) -> Response:
    """Return the scene of the saved document of the cell for other programs; URDF is a ZIP file with its meshes."""
    document = services.backend.cell.document
    if document is None:
        raise CellError("this cell has no document", where=services.backend.cell_name)
    made = await _scene_files.made(document.file, scene_format)
    headers = {"content-disposition": f'attachment; filename="{made.name}"'}
    return Response(made.content, media_type=made.media_type, headers=headers)


@router.get("/naming_behaviors")
async def list_naming_behaviors(
    services: ServicesOf, name: Annotated[str, Query(min_length=1, max_length=200)]
) -> tuple[ReferringBehavior, ...]:
    """Return the saved behaviors for the open cell that name one of its items, or what stands on a module."""
    return await run_in_threadpool(services.documents.naming, name)


@router.get("/connection")
async def get_connection(services: ServicesOf) -> CellConnection:
    """Return whether every device is connected, and which one is lost and why."""
    return services.backend.cell_connection


@router.post("/connect", status_code=204, responses={409: {"model": ErrorBody}, 422: {"model": ErrorBody}})
async def connect_cell(body: ConnectBody, services: ServicesOf) -> None:
    """Reconnect lost devices; 409 while a run is active, 422 if a device does not reconnect."""
    del body
    await services.backend.connect_cell()


@router.post("/simulation", status_code=202, responses={409: {"model": ErrorBody}, 422: {"model": ErrorBody}})
async def switch_simulation(body: SimulationBody, services: ServicesOf) -> None:
    """Close the cell and open it anew with these devices simulated and all others real; 409 while something is active.

    All connections end; the server answers again at the same address once the cell is open.
    """
    await services.backend.reopening.request(body.simulated)


@documents.get("")
def list_cell_documents(services: ServicesOf) -> tuple[CellDocumentName, ...]:
    """List the document of the open cell, if it is in the project, and the modules of the project."""
    return services.documents.cells.listed()


@documents.post("/{document_id:path}/draft")
def read_cell_draft(document_id: str, body: TextBody, services: ServicesOf) -> CellDraft:
    """Read and check a text as the document's; one that cannot be read has findings and no items."""
    return services.documents.cells.examine(document_id, body.text)


@documents.post("/{document_id:path}/rest")
async def find_contacts_at_rest(document_id: str, body: TargetsBody, services: ServicesOf) -> TargetFindingsBody:
    """Check what touches in the cell of a text with all arms at home; the first check takes seconds, blocking nothing.

    A module alone has none.
    """
    file = services.documents.cells.cell_file(document_id)
    if file is None:
        return TargetFindingsBody()
    checked = await services.targets.findings(f"{body.page} {document_id}", file, body.text, of="cell")
    if checked is None:
        return TargetFindingsBody(dropped=True)
    return TargetFindingsBody(findings=checked.findings, problem=checked.problem)


@documents.post("/{document_id:path}/edits")
def edit_cell_document(document_id: str, body: CellEditsBody, services: ServicesOf) -> CellEditAnswer:
    """Apply edits to a text, all or none; nothing is saved."""
    return services.documents.cells.edit(document_id, body.text, body.edits)


@documents.get("/{document_id:path}")
def get_cell_document(document_id: str, services: ServicesOf) -> CellDocumentBody:
    """Return a document on disk, with its items and findings."""
    opened = services.documents.cells.open(document_id)
    return CellDocumentBody(id=opened.stored.id, saved_at=opened.stored.saved_at_s, draft=opened.draft)


@documents.put("/{document_id:path}", responses={409: {"model": ConflictBody}})
def save_cell_document(document_id: str, body: SaveBody, services: ServicesOf) -> SaveResultBody:
    """Write a document; 409 with both texts and their merge, if any, if it has changed on disk since it was read."""
    saved = services.documents.cells.save(document_id, body.text, base_hash=body.base_hash)
    return SaveResultBody(hash=saved.hash, saved_at=saved.saved_at_s)
