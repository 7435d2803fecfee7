"""The catalogue: states, containers, other behaviors, entries and names of the cell that a behavior can use."""

from __future__ import annotations

import json
from typing import Any, cast

from fastapi import APIRouter
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.document_bodies import (
    CatalogueBody,
    ContainerBody,
    EntryBody,
    ReferableBehaviorBody,
    StateBody,
)
from editor_web.routes.services import Services, ServicesOf
from engine.editing.catalogue import container_views, state_views
from engine.errors import FlexcellError

router = APIRouter(prefix="/api/v1/catalogue", tags=["documents"])


@router.get("")
async def get_catalogue(services: ServicesOf) -> CatalogueBody:
    """Return everything that a behavior can use, each kind sorted by name."""
    entries = await _entries(services)
    return await run_in_threadpool(_catalogue, services, entries)


def _catalogue(services: Services, entries: tuple[EntryBody, ...]) -> CatalogueBody:
    return CatalogueBody(
        states=tuple(StateBody.model_validate(each) for each in state_views(services.documents.catalogue)),
        containers=tuple(ContainerBody.model_validate(each) for each in container_views()),
        behaviors=tuple(ReferableBehaviorBody.model_validate(each) for each in services.documents.referable()),
        entries=entries,
        names={str(kind): names for kind, names in services.documents.offered().items()},
    )


async def _entries(services: Services) -> tuple[EntryBody, ...]:
    try:
        answer = await services.backend.bus.call("store/list_entries", {})
    except FlexcellError:
        return ()  # a cell without a store has no entries
    listed = cast("list[list[Any]]", json.loads(answer).get("entries", []))
    return tuple(EntryBody(kind=str(kind), name=str(name), tags=()) for kind, name, _ in listed)
