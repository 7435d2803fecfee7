"""Behaviors: the list, and one behavior with its form, findings and graph."""

from __future__ import annotations

from fastapi import APIRouter, HTTPException

from editor_web.http_bodies.common_bodies import BehaviorBody, BehaviorSummaryBody, ErrorBody
from editor_web.routes.services import ServicesOf
from engine.errors import FlexcellError

router = APIRouter(prefix="/api/v1/behaviors", tags=["behaviors"])


@router.get("")
def list_behaviors(services: ServicesOf) -> list[BehaviorSummaryBody]:
    """List all behaviors of the project, sorted by id."""
    return [BehaviorSummaryBody.model_validate(b) for b in services.backend.behaviors()]


@router.get("/{behavior_id:path}", responses={404: {"model": ErrorBody}})
def get_behavior(behavior_id: str, services: ServicesOf) -> BehaviorBody:
    """Return one behavior; its id is the document's path relative to the project."""
    try:
        return BehaviorBody.model_validate(services.backend.behavior(behavior_id))
    except FlexcellError as error:
        raise HTTPException(404, error.message) from error
