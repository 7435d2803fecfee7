"""Bodies of the commands to a run; the answers are the engine's `ControlView`."""

from __future__ import annotations

import msgspec

from editor_web.http_bodies.common_bodies import Name, RequestBody
from engine.runtime.control import AutonomyLevel, Breakpoint, StepMode


class StepBody(RequestBody, frozen=True, kw_only=True):
    """One step of a paused run, in the branch of `path` if given."""

    mode: StepMode = "into"
    path: str = ""


class StepBackBody(RequestBody, frozen=True, kw_only=True):
    """One step back of a paused run, in the branch of `path` if given."""

    path: str = ""


class NodeCommandBody(RequestBody, frozen=True, kw_only=True):
    """The node that a command addresses."""

    path: str


class LockBody(NodeCommandBody, frozen=True, kw_only=True):
    """Hold the outcome of a node; `reason` goes into the event log."""

    reason: Name = ""


class ForceBody(NodeCommandBody, frozen=True, kw_only=True):
    """End an active or waiting node with an outcome."""

    outcome: str


class UserdataBody(RequestBody, frozen=True, kw_only=True):
    """A value of the userdata of a run, whole; the empty scope is that of the behavior."""

    scope: str = ""
    key: str
    value: object


class AutonomyBody(RequestBody, frozen=True, kw_only=True):
    """The autonomy level; outcomes that require less than `level` pass without an answer."""

    level: AutonomyLevel


class BreakpointsBody(RequestBody, frozen=True, kw_only=True):
    """All breakpoints of a run or a behavior; they replace the previous ones."""

    breakpoints: tuple[Breakpoint, ...]


class HotChangeBody(RequestBody, frozen=True, kw_only=True):
    """A request for a hot change; with `preempt`, active nodes that cannot continue are preempted."""

    preempt: bool = False


class HotChangeResultBody(msgspec.Struct, frozen=True, kw_only=True):
    """The result of a hot change, one line per difference."""

    changes: tuple[str, ...]


class ResumeBody(RequestBody, frozen=True, kw_only=True):
    """A request to resume an interrupted run: `answers` by path are `rerun` or an outcome."""

    answers: dict[str, str] = {}
    changed: bool = False
