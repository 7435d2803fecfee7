"""Comparison of two past runs, and the trend of a behavior."""

from __future__ import annotations

import asyncio
from typing import Annotated

from fastapi import HTTPException, Query, Request, Response

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter, json_response
from engine.archive import Archive, ArchivedRun, PastRun, RunComparison, RunTrend, RunTrends, compare_runs
from engine.errors import JournalError, RecordingError

router = WireRouter(prefix="/api/v1", tags=["past"], responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}})

RunName = Annotated[str, Query(max_length=1000)]


@router.get("/past-runs/comparison", responses={200: {"model": RunComparison}})
async def compare(services: ServicesOf, right: RunName, left: RunName = "") -> Response:
    """Compare two runs, by id or by the path of a recording.

    Without `left`, the last run before `right` of the same behavior that succeeded is the left one.
    """
    return await asyncio.to_thread(lambda: json_response(_compared(services.backend.archive, left, right)))


@router.get("/runs/{run_id}/last-good-run", responses={200: {"model": PastRun | None}})
async def last_good_run(run_id: str, services: ServicesOf) -> Response:
    """Return the last run of the same behavior that succeeded before this one; null if there is none."""
    archive = services.backend.archive

    def found() -> PastRun | None:
        run = next((each for each in archive.runs() if each.id == run_id), None)
        return archive.last_good_run(run) if run is not None else None

    return await asyncio.to_thread(lambda: json_response(found()))


@router.get("/past-runs/trend", responses={200: {"model": RunTrend}})
async def trend(
    request: Request,
    behavior: Annotated[str, Query(max_length=200)],
    last: Annotated[int, Query(ge=1, le=200)] = 20,
) -> Response:
    """Return how the last runs of a behavior went, by the name of the behavior."""
    trends: RunTrends = request.app.state.run_trends
    return await asyncio.to_thread(lambda: json_response(trends.of(behavior, last=last)))


def _compared(archive: Archive, left: str, right: str) -> RunComparison:
    second = _opened(archive, right)
    if left:
        return compare_runs(_opened(archive, left), second)
    good = archive.last_good_run(second.summary)
    if good is None:
        raise HTTPException(404, f"no run of {second.summary.behavior!r} before this one succeeded")
    return compare_runs(_opened(archive, good.id), second)


def _opened(archive: Archive, name: str) -> ArchivedRun:
    try:
        return archive.open(name)
    except (JournalError, RecordingError) as error:
        raise HTTPException(404, error.message) from error
