"""What the page shows of one run, folded from its events: node states, taken transitions, log lines."""

from __future__ import annotations

import math
from collections import deque

import msgspec

from engine.event import (
    Cause,
    Entered,
    Event,
    Exited,
    GoalFinished,
    GoalSent,
    Logged,
    Retried,
    RunEnded,
    RunStarted,
    StopRequested,
    Transitioned,
    UserdataWritten,
)

LOG_LINES = 1000
# Outcomes that read as a failure where the event brings no cause with it.
FAILURE_OUTCOMES = frozenset({"failed", "failure", "error", "errored", "aborted"})


class NodeLive(msgspec.Struct, frozen=True, kw_only=True):
    """One node: idle, active, done, failed or stopped.

    `visits` counts activations, so a visit shorter than a frame is still seen. Times are on the
    run's clock; `duration_s` is of the last finished visit. `followed` is the arrow that a machine
    took last, as `source|outcome`.
    """

    status: str = "idle"
    visits: int = 0
    outcome: str = ""
    entered_s: float = 0.0
    duration_s: float = 0.0
    cause: str = ""
    followed: str = ""


class CauseLine(msgspec.Struct, frozen=True, kw_only=True):
    """One link of a cause chain, outermost first."""

    message: str
    where: str
    kind: str


class LogLine(msgspec.Struct, frozen=True, kw_only=True):
    """One line of the event log; `level` is debug, info, warning or error, `kind` the event's tag."""

    seq: int
    time_s: float
    kind: str
    level: str
    path: str
    text: str
    causes: tuple[CauseLine, ...] = ()


class Change(msgspec.Struct, frozen=True, kw_only=True):
    """What one event changed."""

    nodes: dict[str, NodeLive]
    line: LogLine
    run_changed: bool


class LiveRun:
    """The folded state of one run; `apply` is the only way it changes."""

    def __init__(self, run_id: str) -> None:
        self.run_id = run_id
        self.seq = 0
        self.time_s = 0.0
        self.real_time = False
        self.ended = False
        self.nodes: dict[str, NodeLive] = {}
        self.log: deque[LogLine] = deque(maxlen=LOG_LINES)

    def apply(self, event: Event) -> Change | None:
        """Fold one event in; None when it was already."""
        if event.seq <= self.seq:
            return None
        self.seq = event.seq
        self.time_s = event.time_s
        changed = self._nodes_changed(event)
        self.nodes.update(changed)
        line = log_line(event, duration_s=_duration(event, changed))
        self.log.append(line)
        return Change(nodes=changed, line=line, run_changed=isinstance(event, RunStarted | StopRequested | RunEnded))

    def _nodes_changed(self, event: Event) -> dict[str, NodeLive]:
        if isinstance(event, RunStarted):
            self.real_time = event.clock == "real"
        if isinstance(event, Entered):
            return self._entered(event)
        if isinstance(event, Exited):
            return {event.path: self._exited(event)}
        if isinstance(event, Transitioned):
            node = self.nodes.get(event.path, NodeLive())
            return {event.path: msgspec.structs.replace(node, followed=f"{event.source}|{event.outcome}")}
        if isinstance(event, RunEnded):
            self.ended = True
            return {
                path: msgspec.structs.replace(node, status="stopped", duration_s=event.time_s - node.entered_s)
                for path, node in self.nodes.items()
                if node.status == "active"
            }
        return {}

    def _entered(self, event: Entered) -> dict[str, NodeLive]:
        inside = f"{event.path}/"
        # What lies inside starts afresh with its container; the counters go on.
        changed = {
            path: NodeLive(visits=node.visits)
            for path, node in self.nodes.items()
            if path.startswith(inside) and node.status != "idle"
        }
        changed[event.path] = NodeLive(status="active", visits=event.visit, entered_s=event.time_s)
        return changed

    def _exited(self, event: Exited) -> NodeLive:
        node = self.nodes.get(event.path, NodeLive(entered_s=event.time_s))
        return msgspec.structs.replace(
            node,
            status=_status(event),
            visits=event.visit,
            outcome=event.outcome,
            duration_s=event.time_s - node.entered_s,
            cause=event.cause.message if event.cause else "",
        )


def _status(event: Exited) -> str:
    if event.preempted:
        return "stopped"
    return "failed" if event.cause is not None or event.outcome in FAILURE_OUTCOMES else "done"


def _duration(event: Event, changed: dict[str, NodeLive]) -> float:
    return changed[event.path].duration_s if isinstance(event, Exited) else 0.0


def log_line(event: Event, *, duration_s: float = 0.0) -> LogLine:
    """Say one event in words; `duration_s` is how long the node that ended took."""
    path, level, text, cause = _words(event, duration_s)
    kind = str(type(event).__struct_config__.tag or "")
    return LogLine(
        seq=event.seq, time_s=event.time_s, kind=kind, level=level, path=path, text=text, causes=_lines(cause)
    )


def _words(event: Event, duration_s: float) -> tuple[str, str, str, Cause | None]:
    match event:
        case RunStarted():
            return "", "info", f"run started: {event.behavior}, seed {event.seed}, {event.clock} clock", None
        case Entered():
            return event.path, "debug", "entered" if event.visit == 1 else f"entered, visit {event.visit}", None
        case Exited():
            level = {"failed": "error", "stopped": "warning"}.get(_status(event), "info")
            how = "stopped" if event.preempted else f"ended with {event.outcome}"
            return event.path, level, f"{how} after {_seconds(duration_s)}", event.cause
        case UserdataWritten():
            return event.path, "debug", f"{event.key} = {_short(event.value)}", None
        case Transitioned():
            return event.path, "info", f"{event.source} \u2014{event.outcome}\u2192 {event.target}", None
        case GoalSent():
            return event.path, "debug", f"asked {event.address}: {_short(event.request)}", None
        case GoalFinished():
            level = "debug" if event.status == "succeeded" else "warning"
            return event.path, level, f"goal {event.goal} {event.status}", event.cause
        case Logged():
            return event.path, event.level, event.message, None
        case Retried():
            return event.path, "warning", f"attempt {event.attempt} after {_seconds(event.wait_s)}", event.cause
        case StopRequested():
            return "", "warning", f"stop requested: {event.reason}", None
        case RunEnded():
            level = "error" if event.status == "errored" or event.cause is not None else "info"
            how = f"run {event.status}" + (f" with {event.outcome}" if event.outcome else "")
            return "", level, f"{how} after {_seconds(event.time_s)}", event.cause
        case _:
            return "", "info", type(event).__name__, None


def _seconds(duration_s: float) -> str:
    return f"{duration_s:.2f} s" if math.isfinite(duration_s) else "?"


def _short(value: object, limit: int = 160) -> str:
    text = msgspec.json.encode(value).decode()
    return text if len(text) <= limit else f"{text[:limit]}\u2026"


def _lines(cause: Cause | None) -> tuple[CauseLine, ...]:
    chain = cause.chain() if cause else ()
    return tuple(CauseLine(message=c.message, where=c.where, kind=c.kind) for c in chain)
