"""Bodies for starting runs."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from editor_web.http_bodies.common_bodies import RequestBody
from engine.project import RunPosition
from engine.runtime import Supervision


class StartBody(RequestBody, frozen=True, kw_only=True):
    """A request to start a run; without a seed the server chooses one.

    With `breakpoints`, those in the file of the behavior hold. The run pauses once before the node `until`.
    """

    behavior: str
    parameters: dict[str, object] = {}
    inputs: dict[str, object] = {}
    seed: Annotated[int, Meta(ge=0, lt=2**31)] | None = None
    supervision: Supervision = Supervision()
    breakpoints: bool = False
    begin: RunPosition | None = None
    until: Annotated[str, Meta(max_length=4000)] | None = None
