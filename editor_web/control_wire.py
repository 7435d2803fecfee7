"""The JSON by which runs are operated over HTTP: the commands and what they answer."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from editor_web.wire import Wire

Level = Literal["off", "low", "high", "full"]
Place = Literal["before", "after"]


class WaitingBody(Wire):
    """A node that waits at the gate: `before` its entry or `after` its outcome, and for what."""

    path: str
    visit: int
    point: Place
    outcome: str
    required: str
    reasons: tuple[str, ...]


class BreakpointBody(Wire):
    """Where a run pauses by itself; `path` may hold `*` and `?`, `condition` is an expression over userdata."""

    path: str = Field(min_length=1)
    when: Place = "before"
    condition: str | None = None
    hits: int = Field(default=1, ge=1)
    outcomes: tuple[str, ...] = ()
    enabled: bool = True


class ControlBody(Wire):
    """What an operator sees of a run; `confirmed` once everything that was to be held is at rest."""

    paused: bool
    confirmed: bool
    cannot: tuple[str, ...]
    waiting: tuple[WaitingBody, ...]
    locks: tuple[str, ...]
    breakpoints: tuple[BreakpointBody, ...]
    autonomy: Level
    operator: str
    active: tuple[str, ...]
    stepping: bool
    demanded: bool
    loss_policy: Literal["hold", "continue", "stop"]
    loss_timeout_s: float


class StepBody(Wire):
    """One step of a paused run, in the branch of `path` where one is given."""

    mode: Literal["into", "over", "out"] = "into"
    path: str = ""


class StepBackBody(Wire):
    """One step back of a paused run, in the branch of `path` where one is given."""

    path: str = ""


class NodeBody(Wire):
    """The node that a command is about."""

    path: str


class LockBody(NodeBody):
    """Hold the outcome of a node; `reason` goes into the event log."""

    reason: str = Field(default="", max_length=200)


class ForceBody(Wire):
    """End an active or waiting node with an outcome."""

    path: str
    outcome: str


class AutonomyBody(Wire):
    """Outcomes that require less than `level` pass by themselves."""

    level: Level


class BreakpointsBody(Wire):
    """All breakpoints of a run, or of a behavior; they replace those before."""

    breakpoints: tuple[BreakpointBody, ...]


class TakeFileBody(Wire):
    """A request for a hot change; with `preempt`, what is active and cannot go on as it is is preempted."""

    preempt: bool = False


class ChangeBody(Wire):
    """What a hot change did, a line for each difference."""

    changes: tuple[str, ...]


class ResumeBody(Wire):
    """A request to go on with an interrupted run: `answers` by path are `rerun` or an outcome."""

    answers: dict[str, str] = {}
    changed: bool = False


class InterruptedBody(Wire):
    """A run of the journal whose engine died; `behavior` is the name of what it executed."""

    id: str
    behavior: str
    started_at_s: float = Field(validation_alias="started_unix_s")
    last_seq: int
