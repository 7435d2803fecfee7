"""Bodies for starting runs."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from editor_web.http_bodies.common_bodies import RequestBody
from engine.project import RunPosition
from engine.runtime.control import AutonomyLevel, LossPolicy


class SupervisionBody(RequestBody, frozen=True, kw_only=True):
    """Supervision options of a run; `flexcell run --help` explains the same options."""

    autonomy: AutonomyLevel = "full"
    demand_operator: bool = False
    breakpoints: bool = False
    start_paused: bool = False
    loss_policy: LossPolicy = "hold"
    loss_timeout_s: Annotated[float, Meta(ge=0)] = 5.0


class StartBody(RequestBody, frozen=True, kw_only=True):
    """A request to start a run; without a seed the server chooses one."""

    behavior: str
    parameters: dict[str, object] = {}
    inputs: dict[str, object] = {}
    seed: Annotated[int, Meta(ge=0, lt=2**31)] | None = None
    supervision: SupervisionBody = SupervisionBody()
    begin: RunPosition | None = None
