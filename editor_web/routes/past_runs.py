"""History of runs: timeline, state at any time and failure of a run; past runs and recordings of the project."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from typing import Annotated

import msgspec
from fastapi import HTTPException, Query, Request, Response
from msgspec.structs import replace

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.past_bodies import OpenRunBody, PastRunsBody, open_run_body, past_run_body
from editor_web.past import MeasuredMarkers, OpenRun, OpenRunCache, PastRunState, RunFailure, Timeline
from editor_web.past.run_search import RUN_KINDS, PastRunQuery, RunKind, search_runs
from editor_web.past.userdata_values import PastUserdata
from editor_web.routes.services import Services, ServicesOf
from editor_web.routes.wire_router import WireRouter, json_response
from engine.archive import ArchivedRun, RecordingFile
from engine.errors import FlexcellError, RecordingError
from engine.runtime.history import LOG_LINES, MAX_WATCHES, Watch

_PROBLEMS: dict[int | str, dict[str, object]] = {404: {"model": ErrorBody}, 422: {"model": ErrorBody}}


def _found(kind: object) -> dict[int | str, dict[str, object]]:
    return {**_PROBLEMS, 200: {"model": kind}}


router = WireRouter(prefix="/api/v1", tags=["past"])
_LATEST_S = 1e12

FromS = Annotated[float, Query(ge=0, le=_LATEST_S, allow_inf_nan=False)]
UntilS = Annotated[float | None, Query(ge=0, le=_LATEST_S, allow_inf_nan=False)]
AfterSeq = Annotated[int, Query(ge=0, le=2**53)]
Seq = Annotated[int | None, Query(ge=0, le=2**53)]
Lines = Annotated[int, Query(ge=0, le=LOG_LINES)]
Name = Annotated[str, Query(max_length=200)]
Watches = Annotated[str, Query(max_length=20_000, description="A JSON list of watches")]
_WATCHES = msgspec.json.Decoder(Annotated[tuple[Watch, ...], msgspec.Meta(max_length=MAX_WATCHES)])


@router.get("/past-runs")
async def list_past_runs(
    services: ServicesOf,
    text: Name = "",
    kind: Annotated[RunKind, Query()] = "all",
    since_s: FromS = 0.0,
    until_s: UntilS = None,
    offset: AfterSeq = 0,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
) -> PastRunsBody:
    """List the matching runs of the journal, newest first, filtered by words, kind of end and start time."""
    backend = services.backend
    here = {run.id for run in backend.runs()}
    query = PastRunQuery(text=text, kind=kind, since_s=since_s, until_s=math.inf if until_s is None else until_s)
    runs = await asyncio.to_thread(backend.archive.runs)
    page, total, counts = search_runs(runs, query, offset=offset, limit=limit)
    bodies = tuple(
        past_run_body(run, recording=backend.archive.recording_of(run.id), here=run.id in here) for run in page
    )
    return PastRunsBody(runs=bodies, total=total, counts={name: counts[name] for name in RUN_KINDS})


@router.get("/runs/{run_id}/past", responses=_PROBLEMS)
async def open_past_run(run_id: str, services: ServicesOf, request: Request) -> OpenRunBody:
    """Open a run of the journal, with the behavior as of its start."""
    opened = await asyncio.to_thread(_of_journal, _open_runs(request), run_id, fresh=True)
    recording = services.backend.archive.recording_of(run_id)
    return _opened_body(opened, recording=recording)


@router.get("/runs/{run_id}/timeline", responses=_found(Timeline))
async def run_timeline(
    run_id: str, request: Request, from_s: FromS = 0.0, until_s: UntilS = None, after: AfterSeq = 0
) -> Response:
    """Return the activation intervals and markers of a run; only those after event `after`."""
    return await _of_run(request, run_id, _timeline(from_s, until_s, after), fresh=True)


@router.get("/runs/{run_id}/at", responses=_found(PastRunState))
async def run_moment(
    run_id: str, request: Request, time_s: UntilS = None, seq: Seq = None, known: Seq = None, lines: Lines = LOG_LINES
) -> Response:
    """Return the state of a run at a time or after an event; 204 if that is the state after event `known`."""
    return await _of_run(request, run_id, _moment(time_s, seq, known, lines))


@router.get("/runs/{run_id}/failure", responses=_found(RunFailure | None))
async def run_failure(run_id: str, services: ServicesOf, request: Request) -> Response:
    """Return the failure of a run; null if it did not fail."""
    try:
        here = services.backend.run(run_id)
        is_failed: bool | None = here.status == "errored" or (here.status == "finished" and not here.success)
    except FlexcellError:
        is_failed = None
    return await _of_run(request, run_id, _failure(is_failed))


@router.get("/runs/{run_id}/measured", responses=_found(MeasuredMarkers))
async def run_measured(run_id: str, services: ServicesOf, request: Request) -> Response:
    """Return the measured markers of a run: contacts, grasps, forces and limits."""
    return await _of_run(request, run_id, _measured(services, run_id))


@router.get("/runs/{run_id}/userdata", responses=_found(PastUserdata))
async def run_values(run_id: str, request: Request, seq: Seq = None, watches: Watches = "") -> Response:
    """Return the userdata of a run after an event."""
    return await _of_run(request, run_id, _values(seq, watches))


@router.get("/recordings")
async def list_recordings(services: ServicesOf) -> tuple[RecordingFile, ...]:
    """List the recordings of the project, newest first."""
    return await asyncio.to_thread(services.backend.archive.recordings)


@router.get("/recordings/{path:path}/timeline", responses=_found(Timeline))
async def recording_timeline(
    path: str, request: Request, from_s: FromS = 0.0, until_s: UntilS = None, after: AfterSeq = 0
) -> Response:
    """Return the timeline of a recording."""
    return await asyncio.to_thread(_of_recording, _open_runs(request), path, _timeline(from_s, until_s, after))


@router.get("/recordings/{path:path}/at", responses=_found(PastRunState))
async def recording_moment(
    path: str, request: Request, time_s: UntilS = None, seq: Seq = None, known: Seq = None, lines: Lines = LOG_LINES
) -> Response:
    """Return the state of a recorded run at a time or after an event."""
    return await asyncio.to_thread(_of_recording, _open_runs(request), path, _moment(time_s, seq, known, lines))


@router.get("/recordings/{path:path}/failure", responses=_found(RunFailure | None))
async def recording_failure(path: str, request: Request) -> Response:
    """Return the failure of a recorded run; null if it did not fail."""
    return await asyncio.to_thread(_of_recording, _open_runs(request), path, _failure(None))


@router.get("/recordings/{path:path}/measured", responses=_found(MeasuredMarkers))
async def recording_measured(path: str, services: ServicesOf, request: Request) -> Response:
    """Return the measured markers of a recorded run."""
    return await asyncio.to_thread(_of_recording, _open_runs(request), path, _measured(services, path))


@router.get("/recordings/{path:path}/userdata", responses=_found(PastUserdata))
async def recording_values(path: str, request: Request, seq: Seq = None, watches: Watches = "") -> Response:
    """Return the userdata of a recorded run after an event."""
    return await asyncio.to_thread(_of_recording, _open_runs(request), path, _values(seq, watches))


@router.get("/recordings/{path:path}", responses=_PROBLEMS)
async def open_recording(path: str, request: Request) -> OpenRunBody:
    """Open a recording, with the behavior that it contains."""
    opened = await asyncio.to_thread(_recording, _open_runs(request), path)
    return _opened_body(opened, recording=path)


RunReader = Callable[[OpenRun], object]


def _values(seq: int | None, written: str) -> RunReader:
    try:
        watches = _WATCHES.decode(written) if written else ()
    except msgspec.MsgspecError as error:
        raise HTTPException(422, f"`watches`: {error}") from error
    return lambda opened: opened.values(seq=seq, watches=watches)


def _timeline(from_s: float, until_s: float | None, after: int) -> RunReader:
    until = math.inf if until_s is None else until_s
    return lambda opened: opened.timeline(from_s=from_s, until_s=until, after_seq=after)


def _moment(time_s: float | None, seq: int | None, known: int | None, lines: int) -> RunReader:
    return lambda opened: opened.at(time_s=time_s, seq=seq, known=known, lines=lines) or Response(status_code=204)


def _measured(services: Services, name: str) -> RunReader:
    """Return a reader of the measured markers; a recording that cannot be read is told as if there were none."""

    def read(opened: OpenRun) -> object:
        try:
            return opened.measured(services.backend.recording_files(name))
        except RecordingError as error:
            return replace(opened.measured(()), unread=error.message)

    return read


def _failure(is_failed: bool | None) -> RunReader:
    """Return a reader of the failure; without `is_failed`, the archived summary decides."""

    def read(opened: OpenRun) -> object:
        archived = opened.archived
        failed = archived.summary.failed if is_failed is None and archived is not None else bool(is_failed)
        return opened.failure(is_failed=failed)

    return read


def _open_runs(request: Request) -> OpenRunCache:
    return request.app.state.open_runs


async def _of_run(request: Request, run_id: str, read: RunReader, *, fresh: bool = False) -> Response:
    """Read a run of this server, else of the journal, on a thread that does not block the engine."""
    open_runs = _open_runs(request)
    known = open_runs.of_server(run_id)
    if known is None:
        return await asyncio.to_thread(lambda: _response(read(_of_journal(open_runs, run_id, fresh=fresh))))
    opened, further = known

    def follow_and_read() -> Response:
        opened.follow(further)
        return _response(read(opened))

    return await asyncio.to_thread(follow_and_read)


def _of_journal(open_runs: OpenRunCache, run_id: str, *, fresh: bool) -> OpenRun:
    # A run that is open already needs no access to the journal.
    if (fresh or not open_runs.keeps(run_id)) and not any(run.id == run_id for run in open_runs.archive.runs()):
        raise HTTPException(404, f"there is no run {run_id[:80]!r} on this server or in its journal")
    return open_runs.of_journal(run_id, fresh=fresh)


def _of_recording(open_runs: OpenRunCache, path: str, read: RunReader) -> Response:
    return _response(read(_recording(open_runs, path)))


def _recording(open_runs: OpenRunCache, path: str) -> OpenRun:
    try:
        open_runs.archive.recording_file(path)
    except RecordingError as error:
        raise HTTPException(404, error.message) from error
    return open_runs.of_recording(path)


def _response(value: object) -> Response:
    return value if isinstance(value, Response) else json_response(value)


def _opened_body(opened: OpenRun, *, recording: str) -> OpenRunBody:
    archived: ArchivedRun | None = opened.archived
    if archived is None:
        raise HTTPException(404, "no such run")
    return open_run_body(archived, recording=recording)
