"""Sweeps: list, results, and their execution; a sweep only simulates, whatever the cell of this server does."""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Query, Response

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.sweep_bodies import NewSweepBody, SaveCaseBody, ShrinkBody, SweepIdBody, SweepStartBody
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.sweep import TrialResult
from engine.sweep_library import (
    Baseline,
    CompareSweep,
    CreateSweep,
    FactorChoice,
    FindBaselines,
    ListSweeps,
    OfferFactors,
    ReadRuns,
    ReadSweep,
    ReadTrial,
    RecordedTrial,
    SearchView,
    Shrinking,
    SweepComparison,
    SweepList,
    SweepRuns,
    SweepView,
)

_PROBLEMS: dict[int | str, dict[str, object]] = {
    404: {"model": ErrorBody},
    409: {"model": ErrorBody},
    422: {"model": ErrorBody},
}
router = WireRouter(prefix="/api/v1", tags=["sweeps"])
Number = Annotated[int, Path(ge=0, le=2**31)]


def _found(kind: object) -> dict[int | str, dict[str, object]]:
    return {**_PROBLEMS, 200: {"model": kind}}


@router.get("/sweeps", responses=_found(SweepList))
async def list_sweeps(services: ServicesOf) -> Response:
    """List the sweep documents of the project with what is saved of them, and the results that belong to none."""
    return _json(await services.sweeps.ask(ListSweeps()))


@router.post("/sweeps", status_code=201, responses=_PROBLEMS)
async def create_sweep(body: NewSweepBody, services: ServicesOf) -> SweepIdBody:
    """Write a new sweep document, if it can be executed."""
    await services.sweeps.ask(CreateSweep(sweep=body.id, document=body.document))
    return SweepIdBody(id=body.id)


@router.get("/sweep-factors", responses=_found(tuple[FactorChoice, ...]))
async def list_factors(behavior: Annotated[str, Query(max_length=500)], services: ServicesOf) -> Response:
    """List what a sweep of a behavior can vary."""
    return _json(await services.sweeps.ask(OfferFactors(behavior=behavior)))


@router.post("/sweeps/{sweep_id:path}/start", status_code=202, responses=_PROBLEMS)
async def start_sweep(sweep_id: str, body: SweepStartBody, services: ServicesOf) -> None:
    """Begin to execute the runs without a result, in processes of their own; how far it is comes by the live stream."""
    await services.sweeps.start(sweep_id, again=body.again)


@router.post("/sweeps/{sweep_id:path}/stop", status_code=202, responses=_PROBLEMS)
async def stop_sweep(sweep_id: str, services: ServicesOf) -> None:
    """End the execution; what has ended is saved, and starting it again goes on with the rest."""
    services.sweeps.stop(sweep_id)


@router.get("/sweeps/{sweep_id:path}/runs", responses=_found(SweepRuns))
async def list_sweep_runs(sweep_id: str, services: ServicesOf) -> Response:
    """List the runs of a sweep, failing ones first."""
    return _json(await services.sweeps.ask(ReadRuns(sweep=sweep_id)))


@router.get("/sweeps/{sweep_id:path}/runs/{number}", responses=_found(TrialResult))
async def get_sweep_run(sweep_id: str, number: Number, services: ServicesOf) -> Response:
    """Return one run of a sweep, with its times in nodes."""
    return _json(await services.sweeps.ask(ReadTrial(sweep=sweep_id, number=number)))


@router.post("/sweeps/{sweep_id:path}/runs/{number}/recording", responses=_found(RecordedTrial))
async def record_sweep_run(sweep_id: str, number: Number, services: ServicesOf) -> Response:
    """Execute a run again, record it, and tell whether it had the same events as before."""
    return _json(await services.sweeps.record(sweep_id, number))


@router.get("/sweeps/{sweep_id:path}/runs/{number}/shrinking")
async def get_shrinking(sweep_id: str, number: Number, services: ServicesOf) -> Shrinking:
    """Return how far a failing run is shrunk to the smallest change from nominal, and what came of it."""
    return services.sweeps.shrinkings.of(sweep_id, number)


@router.post("/sweeps/{sweep_id:path}/runs/{number}/shrinking", status_code=202, responses=_PROBLEMS)
async def start_shrinking(sweep_id: str, number: Number, body: ShrinkBody, services: ServicesOf) -> None:
    """Begin to shrink a failing run, in a process with a low priority."""
    await services.sweeps.shrinkings.start(sweep_id, number, same=body.same)


@router.post("/sweeps/{sweep_id:path}/runs/{number}/shrinking/stop", status_code=202, responses=_PROBLEMS)
async def stop_shrinking(sweep_id: str, number: Number, services: ServicesOf) -> None:
    """End it with the smallest change found so far."""
    services.sweeps.shrinkings.stop(sweep_id, number)


@router.post("/sweeps/{sweep_id:path}/runs/{number}/shrinking/case", status_code=201, responses=_PROBLEMS)
async def save_case(sweep_id: str, number: Number, body: SaveCaseBody, services: ServicesOf) -> SweepIdBody:
    """Save the smallest change as a test case: a sweep of one run that requires success."""
    await services.sweeps.save_case(sweep_id, number, body.id)
    return SweepIdBody(id=body.id)


@router.get("/sweeps/{sweep_id:path}/baselines", responses=_found(tuple[Baseline, ...]))
async def list_baselines(sweep_id: str, services: ServicesOf) -> Response:
    """List the other versions that have executed configurations of a sweep, the newest first."""
    return _json(await services.sweeps.ask(FindBaselines(sweep=sweep_id)))


@router.get("/sweeps/{sweep_id:path}/comparison", responses=_found(SweepComparison))
async def compare_sweep(
    sweep_id: str,
    results: Annotated[str, Query(max_length=1000)],
    version: Annotated[str, Query(max_length=100)],
    services: ServicesOf,
    margin: Annotated[float | None, Query(ge=0.0, le=1.0)] = None,
) -> Response:
    """Compare a sweep with a baseline: whether its success rate is lower, and by no more than the margin."""
    request = CompareSweep(sweep=sweep_id, results=results, version=version, margin=margin)
    return _json(await services.sweeps.ask(request))


@router.get("/sweeps/{sweep_id:path}", responses=_found(SweepView | SearchView))
async def get_sweep(sweep_id: str, services: ServicesOf) -> Response:
    """Return everything that a sweep has shown, or a search for failures has found."""
    return _json(await services.sweeps.ask(ReadSweep(sweep=sweep_id)))


def _json(body: bytes) -> Response:
    return Response(body, media_type="application/json")
