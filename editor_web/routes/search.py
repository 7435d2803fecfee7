"""Search by name, for a page that leads to anything from anywhere; and where the behaviors use what was found."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Annotated

from fastapi import Query
from starlette.concurrency import run_in_threadpool

from editor_web.http_bodies.document_bodies import EntryName
from editor_web.routes.catalogue import entry_names
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.cell import CellItem, named_items
from engine.editing import StateView, state_views
from engine.library import NameHit, Usages, UsedKind, behavior_names, search_names
from engine.runtime.history import RunView

router = WireRouter(prefix="/api/v1/search", tags=["search"])

_MOST = 40


@router.get("")
async def search(services: ServicesOf, text: Annotated[str, Query(max_length=200)] = "") -> tuple[NameHit, ...]:
    """Return the behaviors, nodes, states, entries, runs, items and topics that have every word of a text."""
    backend = services.backend
    entries, runs = await entry_names(services), backend.runs()
    topics = [topic.name for topic in backend.inspector.topics()]

    def found() -> tuple[NameHit, ...]:
        names = [*behavior_names(backend.behaviors()), *_of_entries(entries), *_of_runs(runs)]
        names += _of_states(state_views(services.documents.catalogue))
        names += _of_items(named_items(backend.cell.document, topics=topics))
        return search_names(text, names, limit=_MOST)

    return await run_in_threadpool(found)


@router.get("/usages")
def usages(services: ServicesOf, kind: UsedKind, name: Annotated[str, Query(min_length=1, max_length=300)]) -> Usages:
    """Return where the saved behaviors of the project use a state, behavior, entry or userdata key."""
    return services.documents.library.usages(kind, name)


def _of_states(states: tuple[StateView, ...]) -> Iterator[NameHit]:
    for state in states:
        yield NameHit(kind="state", id=state.name, title=state.name, detail=state.summary, icon=state.icon)


def _of_entries(entries: tuple[EntryName, ...]) -> Iterator[NameHit]:
    for entry in entries:
        yield NameHit(kind="entry", id=entry.name, path=entry.kind, title=entry.name, detail=entry.kind)


def _of_runs(runs: tuple[RunView, ...]) -> Iterator[NameHit]:
    for run in runs:
        detail = f"{run.id} {run.outcome or run.status}"
        yield NameHit(kind="run", id=run.id, title=run.behavior.rpartition("/")[2], detail=detail)


def _of_items(items: Iterable[CellItem]) -> Iterator[NameHit]:
    for item in items:
        yield NameHit(kind="item", id=item.path, title=item.name, detail=f"{item.path} {item.kind} {item.model}")
        for topic in item.topics:
            yield NameHit(kind="topic", id=item.path, path=topic, title=topic, detail=f"topic of {item.path}")
