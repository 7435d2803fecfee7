"""Bodies of the steps after a stop of the cell."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from editor_web.http_bodies.common_bodies import RequestBody


class ReleaseStopBody(RequestBody, frozen=True, kw_only=True):
    """A request to release the stop of this number, null for the latest; refused if the cell was stopped again."""

    stop: Annotated[int, Meta(ge=1, le=2**53)] | None = None


class RecoveryStepBody(RequestBody, frozen=True, kw_only=True):
    """A step of the recovery; it has no settings."""
