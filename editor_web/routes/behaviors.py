"""Behaviors: the list, and one behavior with its form, findings and graph."""

from __future__ import annotations

from fastapi import HTTPException

from editor_web.http_bodies.common_bodies import BehaviorSummary, ErrorBody, summary_of
from editor_web.routes.services import ServicesOf
from editor_web.routes.wire_router import WireRouter
from engine.errors import FlexcellError
from engine.library import BehaviorView

router = WireRouter(prefix="/api/v1/behaviors", tags=["behaviors"])


@router.get("")
def list_behaviors(services: ServicesOf) -> list[BehaviorSummary]:
    """List all behaviors of the project, sorted by id."""
    return [summary_of(each) for each in services.backend.behaviors()]


@router.get("/{behavior_id:path}", responses={404: {"model": ErrorBody}})
def get_behavior(behavior_id: str, services: ServicesOf) -> BehaviorView:
    """Return one behavior; its id is the document's path relative to the project."""
    try:
        return services.backend.behavior(behavior_id)
    except FlexcellError as error:
        raise HTTPException(404, error.message) from error
