"""Text of every event of a run, for the log of the page."""

from __future__ import annotations

import math

import msgspec

from engine.cause_chain import links_from_root
from engine.event import (
    BehaviorChanged,
    BranchesPreempted,
    Cause,
    Event,
    FaultInjected,
    GatePassed,
    GateReached,
    GoalFinished,
    GoalHeld,
    GoalResumed,
    GoalSent,
    LoopBlocked,
    MessageLogged,
    MessageReceived,
    NodeAbandoned,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    NodeRetried,
    OperatorChanged,
    OperatorCommanded,
    OutcomeRequested,
    OutcomeWithdrawn,
    PauseConfirmed,
    RunEnded,
    RunResumed,
    RunStarted,
    RunSteppedBack,
    ServiceAnswered,
    ServiceCalled,
    StatusChanged,
    StopRequested,
    TransitionTaken,
    UndoEnded,
    UndoStarted,
    UserdataAppended,
    UserdataWritten,
)

# Outcomes shown as a failure if the event has no cause.
FAILURE_OUTCOMES = frozenset({"failed", "failure", "error", "errored", "aborted"})
LineParts = tuple[str, str, str, Cause | None]
"""Path, level, text, cause."""


class CauseLine(msgspec.Struct, frozen=True, kw_only=True):
    """One link of a cause chain; the first link is the root cause."""

    message: str
    where: str
    kind: str


class LogLine(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One line of the event log; `level` is debug, info, warning or error, `kind` the event's tag."""

    seq: int
    time_s: float
    kind: str
    level: str
    path: str
    text: str
    causes: tuple[CauseLine, ...] = ()


def status_of(event: NodeExited) -> str:
    """Return the status of an exited node: done, failed or stopped."""
    if event.preempted:
        return "stopped"
    return "failed" if event.cause is not None or event.outcome in FAILURE_OUTCOMES else "done"


def log_line(event: Event, *, duration_s: float = 0.0) -> LogLine:
    """Return the log line of an event; `duration_s` is the duration of the node that ended."""
    path, level, text, cause = _parts(event, duration_s)
    kind = str(type(event).__struct_config__.tag or "")
    return LogLine(
        seq=event.seq, time_s=event.time_s, kind=kind, level=level, path=path, text=text, causes=_lines(cause)
    )


def _parts(event: Event, duration_s: float) -> LineParts:
    parts = _node_event_parts(event, duration_s) or _skill_event_parts(event) or _control_event_parts(event)
    return parts or _run_event_parts(event)


def _node_event_parts(event: Event, duration_s: float) -> LineParts | None:
    match event:
        case NodeEntered():
            return event.path, "debug", "entered" if event.visit == 1 else f"entered, visit {event.visit}", None
        case NodeExited():
            level = {"failed": "error", "stopped": "warning"}.get(status_of(event), "info")
            how = "stopped" if event.preempted else f"ended with {event.outcome or 'an error'}"
            return event.path, level, f"{how} after {_seconds(duration_s)}", event.cause
        case UserdataWritten():
            return event.path, "debug", f"{event.key} = {_short(event.value)}", None
        case UserdataAppended():
            return event.path, "debug", f"{event.key} += {_short(event.value)}", None
        case TransitionTaken():
            return event.path, "info", f"{event.source} \u2014{event.outcome}\u2192 {event.target}", None
        case NodeDiverted():
            level = "warning" if event.cause is not None else "info"
            return event.path, level, f"preempted by {event.by}, continues at {event.target}", event.cause
        case BranchesPreempted():
            branches = ", ".join(event.branches)
            return event.path, "info", f"{event.condition}: {branches or 'all branches had ended'}", None
        case NodeRetried():
            return event.path, "warning", f"attempt {event.attempt} after {_seconds(event.wait_s)}", event.cause
        case StatusChanged():
            return event.path, "debug", event.status, None
        case MessageLogged():
            return event.path, event.level, event.message, None
        case NodeAbandoned():
            return event.path, "error", f"did not stop within {event.waited_s:g} s and was abandoned", None
        case LoopBlocked():
            text = f"blocked the event loop for {event.blocked_s:.2f} s, at {event.where}"
            return event.path, "warning", text, None
        case _:
            return None


def _skill_event_parts(event: Event) -> LineParts | None:
    match event:
        case GoalSent():
            return event.path, "debug", f"sent a goal to {event.address}: {_short(event.request)}", None
        case GoalFinished():
            level = "debug" if event.status == "succeeded" else "warning"
            return event.path, level, f"goal {event.goal} {event.status}", event.cause
        case GoalHeld():
            return event.path, "info", f"goal {event.goal} held, at rest", None
        case GoalResumed():
            return event.path, "info", f"goal {event.goal} resumed", None
        case ServiceCalled():
            return event.path, "debug", f"called {event.address}: {_short(event.request)}", None
        case ServiceAnswered():
            if event.cause is not None:
                return event.path, "warning", f"call {event.call} failed", event.cause
            return event.path, "debug", f"call {event.call} answered {_short(event.result)}", None
        case MessageReceived():
            return event.path, "debug", f"{event.topic}: {_short(event.message)}", None
        case FaultInjected():
            return (
                event.path,
                "warning",
                f"fault injected at {event.address}: {event.fault} {event.detail}".strip(),
                None,
            )
        case _:
            return None


def _control_event_parts(event: Event) -> LineParts | None:
    match event:
        case OperatorCommanded():
            arguments = f" {_short(event.arguments)}" if event.arguments else ""
            return event.path, "info", f"operator: {event.command}{arguments}", None
        case GateReached():
            outcome = f" with {event.outcome}" if event.outcome else ""
            return event.path, "info", f"waits {event.point}{outcome}: {', '.join(event.reasons)}", None
        case GatePassed():
            return event.path, "debug", f"no longer waits {event.point}", None
        case OutcomeRequested():
            return event.path, "warning", f"asks for {event.outcome}, which requires {event.required}", None
        case OutcomeWithdrawn():
            return event.path, "debug", f"no longer asks for {event.outcome}", None
        case PauseConfirmed():
            cannot = f"; cannot be held: {', '.join(event.cannot)}" if event.cannot else ""
            return "", "warning" if event.cannot else "info", f"paused, everything at rest{cannot}", None
        case OperatorChanged():
            return "", "warning" if event.status == "lost" else "info", f"operator {event.status}", None
        case BehaviorChanged():
            return "", "info", f"behavior changed: {'; '.join(event.report) or 'no effective difference'}", None
        case UndoStarted():
            return event.path, "info", f"undo of visit {event.undoes} started", None
        case UndoEnded():
            how = "stopped" if event.preempted else "failed" if event.cause is not None else "done"
            return (
                event.path,
                "info" if how == "done" else "warning",
                f"undo of visit {event.undoes} {how}",
                event.cause,
            )
        case RunSteppedBack():
            if event.cause is not None:
                return event.path, "error", "could not step back", event.cause
            return event.path, "info", f"stepped back before its entry{_restored_values(event)}", None
        case _:
            return None


def _restored_values(event: RunSteppedBack) -> str:
    values = [f"{each.key} = {_short(each.value, 60)}" if each.defined else f"no {each.key}" for each in event.values]
    return f", restored {', '.join(values)}" if values else ""


def _run_event_parts(event: Event) -> LineParts:
    match event:
        case RunStarted():
            return "", "info", f"run started: {event.behavior}, seed {event.seed}, {event.clock} clock", None
        case RunResumed():
            rerun = f", running again {', '.join(event.rerun)}" if event.rerun else ""
            return "", "warning", f"resumed after event {event.after_seq}{rerun}", None
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
    return tuple(CauseLine(message=c.message, where=c.where, kind=c.kind) for c in links_from_root(cause))
