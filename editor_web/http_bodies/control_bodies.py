"""JSON bodies for operating runs over HTTP: commands and responses."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from editor_web.http_bodies.common_bodies import HttpBody

AutonomyLevel = Literal["off", "low", "high", "full"]
GateSide = Literal["before", "after"]


class WaitingNodeBody(HttpBody):
    """A node that waits at the gate, `before` its entry or `after` its outcome, with the reasons."""

    path: str
    visit: int
    point: GateSide
    outcome: str
    required: str
    reasons: tuple[str, ...]


class BreakpointBody(HttpBody):
    """A breakpoint; `path` may contain `*` and `?`, `condition` is an expression over userdata."""

    path: str = Field(min_length=1)
    when: GateSide = "before"
    condition: str | None = None
    hits: int = Field(default=1, ge=1)
    outcomes: tuple[str, ...] = ()
    enabled: bool = True


class ControlBody(HttpBody):
    """The operator's view of a run; `confirmed` is true when everything that a pause holds is at rest."""

    paused: bool
    confirmed: bool
    cannot: tuple[str, ...]
    waiting: tuple[WaitingNodeBody, ...]
    locks: tuple[str, ...]
    breakpoints: tuple[BreakpointBody, ...]
    autonomy: AutonomyLevel
    operator: str
    active: tuple[str, ...]
    stepping: bool
    demanded: bool
    loss_policy: Literal["hold", "continue", "stop"]
    loss_timeout_s: float


class StepBody(HttpBody):
    """One step of a paused run, in the branch of `path` if given."""

    mode: Literal["into", "over", "out"] = "into"
    path: str = ""


class StepBackBody(HttpBody):
    """One step back of a paused run, in the branch of `path` if given."""

    path: str = ""


class NodeCommandBody(HttpBody):
    """The node that a command addresses."""

    path: str


class LockBody(NodeCommandBody):
    """Hold the outcome of a node; `reason` goes into the event log."""

    reason: str = Field(default="", max_length=200)


class ForceBody(HttpBody):
    """End an active or waiting node with an outcome."""

    path: str
    outcome: str


class AutonomyBody(HttpBody):
    """The autonomy level; outcomes that require less than `level` pass without an answer."""

    level: AutonomyLevel


class BreakpointsBody(HttpBody):
    """All breakpoints of a run or a behavior; they replace the previous ones."""

    breakpoints: tuple[BreakpointBody, ...]


class HotChangeBody(HttpBody):
    """A request for a hot change; with `preempt`, active nodes that cannot continue are preempted."""

    preempt: bool = False


class HotChangeResultBody(HttpBody):
    """The result of a hot change, one line per difference."""

    changes: tuple[str, ...]


class ResumeBody(HttpBody):
    """A request to resume an interrupted run: `answers` by path are `rerun` or an outcome."""

    answers: dict[str, str] = {}
    changed: bool = False


class InterruptedRunBody(HttpBody):
    """A run of the journal whose engine ended without ending the run; `behavior` is the name of its behavior."""

    id: str
    behavior: str
    started_at_s: float = Field(validation_alias="started_unix_s")
    last_seq: int
