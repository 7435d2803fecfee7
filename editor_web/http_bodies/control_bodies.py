"""The JSON by which runs are operated over HTTP: the commands and what they answer."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from editor_web.http_bodies.common_bodies import HttpBody

AutonomyLevel = Literal["off", "low", "high", "full"]
GateSide = Literal["before", "after"]


class WaitingNodeBody(HttpBody):
    """A node that waits at the gate: `before` its entry or `after` its outcome, and for what."""

    path: str
    visit: int
    point: GateSide
    outcome: str
    required: str
    reasons: tuple[str, ...]


class BreakpointBody(HttpBody):
    """Where a run pauses by itself; `path` may hold `*` and `?`, `condition` is an expression over userdata."""

    path: str = Field(min_length=1)
    when: GateSide = "before"
    condition: str | None = None
    hits: int = Field(default=1, ge=1)
    outcomes: tuple[str, ...] = ()
    enabled: bool = True


class ControlBody(HttpBody):
    """What an operator sees of a run; `confirmed` once everything that was to be held is at rest."""

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
    """One step of a paused run, in the branch of `path` where one is given."""

    mode: Literal["into", "over", "out"] = "into"
    path: str = ""


class StepBackBody(HttpBody):
    """One step back of a paused run, in the branch of `path` where one is given."""

    path: str = ""


class NodeCommandBody(HttpBody):
    """The node that a command is about."""

    path: str


class LockBody(NodeCommandBody):
    """Hold the outcome of a node; `reason` goes into the event log."""

    reason: str = Field(default="", max_length=200)


class ForceBody(HttpBody):
    """End an active or waiting node with an outcome."""

    path: str
    outcome: str


class AutonomyBody(HttpBody):
    """Outcomes that require less than `level` pass by themselves."""

    level: AutonomyLevel


class BreakpointsBody(HttpBody):
    """All breakpoints of a run, or of a behavior; they replace those before."""

    breakpoints: tuple[BreakpointBody, ...]


class HotChangeBody(HttpBody):
    """A request for a hot change; with `preempt`, what is active and cannot go on as it is is preempted."""

    preempt: bool = False


class HotChangeResultBody(HttpBody):
    """What a hot change did, a line for each difference."""

    changes: tuple[str, ...]


class ResumeBody(HttpBody):
    """A request to go on with an interrupted run: `answers` by path are `rerun` or an outcome."""

    answers: dict[str, str] = {}
    changed: bool = False


class InterruptedRunBody(HttpBody):
    """A run of the journal whose engine died; `behavior` is the name of what it executed."""

    id: str
    behavior: str
    started_at_s: float = Field(validation_alias="started_unix_s")
    last_seq: int
