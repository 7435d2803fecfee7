"""The catalogue: states, containers, other behaviors, entries and names of the cell that a behavior can use."""

from __future__ import annotations

import msgspec
from fastapi import HTTPException
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.document_bodies import CatalogueBody, EntryName
from editor_web.routes.services import Services, ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.editing import StateSource, container_views, state_source, state_views
from engine.errors import FlexcellError
from engine.skills.entries import EntryList

router = WireRouter(
    prefix="/api/v1/catalogue", tags=["documents"], responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}}
)


@router.get("")
async def get_catalogue(services: ServicesOf) -> CatalogueBody:
    """Return everything that a behavior can use, each kind sorted by name."""
    entries = await entry_names(services)
    return await run_in_threadpool(_catalogue, services, entries)


@router.get("/states/{name:path}/source")
def get_state_source(name: str, services: ServicesOf) -> StateSource:
    """Return the Python source of a state of the catalogue; no other file can be asked for."""
    documents = services.documents
    if name not in documents.catalogue:
        raise HTTPException(404, "there is no such state")
    return state_source(documents.catalogue, name, project=documents.project)


def _catalogue(services: Services, entries: tuple[EntryName, ...]) -> CatalogueBody:
    return CatalogueBody(
        states=state_views(services.documents.catalogue),
        containers=container_views(),
        behaviors=services.documents.referable(),
        entries=entries,
        names={str(kind): names for kind, names in services.documents.offered().items()},
    )


async def entry_names(services: Services) -> tuple[EntryName, ...]:
    """Return the entries of the cell's store; a cell without a store has none."""
    try:
        answer = await services.backend.bus.call("store/list_entries", {})
    except FlexcellError:
        return ()
    listed = msgspec.json.decode(answer, type=EntryList).entries
    return tuple(EntryName(kind=kind, name=name) for kind, name, _ in listed)
