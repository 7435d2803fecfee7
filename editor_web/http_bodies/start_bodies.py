"""JSON bodies for starting runs over HTTP."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from editor_web.http_bodies.common_bodies import HttpBody
from editor_web.http_bodies.control_bodies import AutonomyLevel


class RunPositionBody(HttpBody):
    """The event of a journaled run to begin at, at the last entered state unless `path` is given."""

    run: str
    seq: int = Field(ge=1)
    path: str | None = None


class SupervisionBody(HttpBody):
    """Supervision options of a run; `flexcell run --help` explains the same options."""

    autonomy: AutonomyLevel = "full"
    demand_operator: bool = False
    breakpoints: bool = False
    start_paused: bool = False
    loss_policy: Literal["hold", "continue", "stop"] = "hold"
    loss_timeout_s: float = Field(default=5.0, ge=0)


class StartBody(HttpBody):
    """A request to start a run; without a seed the server chooses one."""

    behavior: str
    parameters: dict[str, object] = {}
    inputs: dict[str, object] = {}
    seed: int | None = Field(default=None, ge=0, lt=2**31)
    supervision: SupervisionBody = SupervisionBody()
    begin: RunPositionBody | None = None
