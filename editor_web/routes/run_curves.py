"""Curves of past and active runs, from their recordings."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Annotated

from fastapi import HTTPException, Query, Response

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.past.recorded_curves import MAX_CELLS, MAX_FIELDS, RecordedCurves, RecordedFields, RecordedPieces
from editor_web.routes.services import Services, ServicesOf
from editor_web.routes.wire_router import WireRouter, json_response
from engine.errors import RecordingError

router = WireRouter(prefix="/api/v1", tags=["past"], responses={404: {"model": ErrorBody}, 422: {"model": ErrorBody}})
_LONGEST_S = 1e9

TimeS = Annotated[float, Query(ge=-_LONGEST_S, le=_LONGEST_S, allow_inf_nan=False)]
FieldIds = Annotated[list[str], Query(alias="field", min_length=1, max_length=MAX_FIELDS)]
Cells = Annotated[int, Query(ge=1, le=MAX_CELLS)]


@router.get("/runs/{run_id}/fields", responses={200: {"model": RecordedFields}})
async def run_fields(run_id: str, services: ServicesOf) -> Response:
    """List the topics in the recording of a run with their numeric fields."""
    return await _read(services, run_id, RecordedPieces.fields)


@router.get("/runs/{run_id}/curves", responses={200: {"model": RecordedCurves}})
async def run_curves(
    run_id: str, services: ServicesOf, fields: FieldIds, from_s: TimeS, until_s: TimeS, cells: Cells = 500
) -> Response:
    """Return fields of a recorded run, `topic:path` each, over a time range."""
    return await _read(services, run_id, _curves(fields, from_s, until_s, cells))


@router.get("/recordings/{path:path}/fields", responses={200: {"model": RecordedFields}})
async def recording_fields(path: str, services: ServicesOf) -> Response:
    """List the topics of a recording with their numeric fields."""
    return await _read(services, path, RecordedPieces.fields)


@router.get("/recordings/{path:path}/curves", responses={200: {"model": RecordedCurves}})
async def recording_curves(
    path: str, services: ServicesOf, fields: FieldIds, from_s: TimeS, until_s: TimeS, cells: Cells = 500
) -> Response:
    """Return fields of a recording, `topic:path` each, over a time range."""
    return await _read(services, path, _curves(fields, from_s, until_s, cells))


def _curves(fields: list[str], from_s: float, until_s: float, cells: int) -> Callable[[RecordedPieces], RecordedCurves]:
    return lambda pieces: pieces.curves(list(dict.fromkeys(fields)), from_s=from_s, until_s=until_s, cells=cells)


async def _read(services: Services, name: str, read: Callable[[RecordedPieces], object]) -> Response:
    def found() -> Response:
        try:
            with RecordedPieces(services.backend.recording_files(name)) as pieces:
                return json_response(read(pieces))
        except RecordingError as error:
            raise HTTPException(404, error.message) from error

    return await asyncio.to_thread(found)
