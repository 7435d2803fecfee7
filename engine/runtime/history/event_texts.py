"""What every event of a run says to a person: `EVENT_TEXTS` by message id; log of the page and command line use it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import msgspec

from engine.errors import Cause
from engine.event import (
    BehaviorChanged,
    BranchesPreempted,
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
    MessagePublished,
    MessageReceived,
    NodeAbandoned,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    NodeRetried,
    NodeSkipped,
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
from engine.runtime.history.run_reducer import exit_status


class EventText(msgspec.Struct, frozen=True, gc=False):
    """Text of an event: the node (empty for the run), debug, info, warning or error, and the cause of a failure."""

    path: str
    level: str
    text: str
    cause: Cause | None


class _Template(NamedTuple):
    level: str
    text: str


EVENT_TEXTS: Mapping[str, _Template] = {
    "run_started": _Template("info", "run started: {behavior}, seed {seed}, {clock} clock"),
    "resumed": _Template("warning", "resumed after event {after_seq}"),
    "resumed.rerun": _Template("warning", "resumed after event {after_seq}, running again {rerun}"),
    "entered": _Template("debug", "entered"),
    "entered.again": _Template("debug", "entered, visit {visit}"),
    "exited.done": _Template("info", "ended with {outcome}"),
    "exited.done.duration": _Template("info", "ended with {outcome} after {duration}"),
    "exited.failed": _Template("error", "ended with {outcome}"),
    "exited.failed.duration": _Template("error", "ended with {outcome} after {duration}"),
    "exited.stopped": _Template("warning", "stopped"),
    "exited.stopped.duration": _Template("warning", "stopped after {duration}"),
    "userdata": _Template("debug", "{key} = {value}"),
    "userdata_appended": _Template("debug", "{key} += {value}"),
    "transition": _Template("info", "{source} \u2014{outcome}\u2192 {target}"),
    "skipped": _Template("info", "skipped: disabled, continues with {outcome}"),
    "diverted": _Template("info", "preempted by {by}, continues at {target}"),
    "diverted.failed": _Template("warning", "preempted by {by}, continues at {target}"),
    "branches_preempted": _Template("info", "{condition}: {branches}"),
    "branches_preempted.none": _Template("info", "{condition}: all branches had ended"),
    "retry": _Template("warning", "attempt {attempt} after {wait}"),
    "status": _Template("debug", "{status}"),
    "log": _Template("info", "{message}"),
    "abandoned": _Template("error", "did not stop within {waited} s and was abandoned"),
    "loop_blocked": _Template("warning", "blocked the event loop for {blocked}, at {where}"),
    "goal": _Template("debug", "sent a goal to {address}: {request}"),
    "goal_finished": _Template("debug", "goal {goal} {status}"),
    "goal_finished.failed": _Template("warning", "goal {goal} {status}"),
    "goal_held": _Template("info", "goal {goal} held, at rest"),
    "goal_resumed": _Template("info", "goal {goal} resumed"),
    "call": _Template("debug", "called {address}: {request}"),
    "answer": _Template("debug", "call {call} answered {result}"),
    "answer.failed": _Template("warning", "call {call} failed"),
    "published": _Template("info", "published on {topic}: {message}"),
    "received": _Template("debug", "{topic}: {message}"),
    "fault": _Template("warning", "fault injected at {address}: {fault}"),
    "fault.detail": _Template("warning", "fault injected at {address}: {fault}, {detail}"),
    "command": _Template("info", "operator: {command}"),
    "command.arguments": _Template("info", "operator: {command} {arguments}"),
    "gate": _Template("info", "waits {point}: {reasons}"),
    "gate.outcome": _Template("info", "waits {point} with {outcome}: {reasons}"),
    "gate_passed": _Template("debug", "no longer waits {point}"),
    "outcome_requested": _Template("warning", "asks for {outcome}, which requires {required}"),
    "outcome_withdrawn": _Template("debug", "no longer asks for {outcome}"),
    "pause_confirmed": _Template("info", "paused, everything at rest"),
    "pause_confirmed.cannot": _Template("warning", "paused, everything at rest; cannot be held: {cannot}"),
    "operator": _Template("info", "operator {status}"),
    "operator.lost": _Template("warning", "operator lost"),
    "behavior_changed": _Template("info", "behavior changed: {report}"),
    "behavior_changed.same": _Template("info", "behavior changed: no effective difference"),
    "undo_began": _Template("info", "undo of visit {undoes} started"),
    "undo_ended.done": _Template("info", "undo of visit {undoes} done"),
    "undo_ended.failed": _Template("warning", "undo of visit {undoes} failed"),
    "undo_ended.stopped": _Template("warning", "undo of visit {undoes} stopped"),
    "stepped_back": _Template("info", "stepped back before its entry"),
    "stepped_back.values": _Template("info", "stepped back before its entry, restored {values}"),
    "stepped_back.failed": _Template("error", "could not step back"),
    "stop": _Template("warning", "stop requested: {reason}"),
    "run_ended": _Template("info", "run {status} after {duration}"),
    "run_ended.outcome": _Template("info", "run {status} with {outcome} after {duration}"),
    "run_ended.failed": _Template("error", "run {status} after {duration}"),
    "run_ended.failed_outcome": _Template("error", "run {status} with {outcome} after {duration}"),
}
"""Level and text of each message; an id is the tag of an event, with a variant where it has several.

The level of a `log` message is that of its event.
"""


_FORMS = {id_: (template.level, template.text.format_map) for id_, template in EVENT_TEXTS.items()}


def event_text(event: Event, *, duration_s: float | None = None) -> EventText:
    """Return the text of an event; `duration_s` is the duration of the node that ended, None to leave it out."""
    text = _node_text(event, duration_s) or _request_text(event) or _control_text(event) or _report_text(event)
    return text or _run_text(event)


def _say(id_: str, path: str, cause: Cause | None = None, /, **values: object) -> EventText:
    level, form = _FORMS[id_]
    return EventText(path, level, form(values), cause)


def _node_text(event: Event, duration_s: float | None) -> EventText | None:
    match event:
        case NodeEntered():
            return _say("entered" if event.visit == 1 else "entered.again", event.path, visit=event.visit)
        case NodeExited():
            outcome = event.outcome or "an error"
            id_ = f"exited.{exit_status(event)}"
            if duration_s is None:
                return _say(id_, event.path, event.cause, outcome=outcome)
            return _say(f"{id_}.duration", event.path, event.cause, outcome=outcome, duration=_seconds(duration_s))
        case UserdataWritten():
            return _say("userdata", event.path, key=event.key, value=_short(event.value))
        case UserdataAppended():
            return _say("userdata_appended", event.path, key=event.key, value=_short(event.value))
        case TransitionTaken():
            return _say("transition", event.path, source=event.source, outcome=event.outcome, target=event.target)
        case NodeDiverted():
            id_ = "diverted.failed" if event.cause is not None else "diverted"
            return _say(id_, event.path, event.cause, by=event.by, target=event.target)
        case NodeSkipped():
            return _say("skipped", event.path, outcome=event.outcome)
        case BranchesPreempted():
            id_ = "branches_preempted" if event.branches else "branches_preempted.none"
            return _say(id_, event.path, condition=event.condition, branches=", ".join(event.branches))
        case NodeRetried():
            return _say("retry", event.path, event.cause, attempt=event.attempt, wait=_seconds(event.wait_s))
        case StatusChanged():
            return _say("status", event.path, status=event.status)
        case _:
            return None


def _report_text(event: Event) -> EventText | None:
    match event:
        case MessageLogged():
            return EventText(event.path, event.level, EVENT_TEXTS["log"].text.format(message=event.message), None)
        case NodeAbandoned():
            return _say("abandoned", event.path, waited=f"{event.waited_s:g}")
        case LoopBlocked():
            return _say("loop_blocked", event.path, blocked=_seconds(event.blocked_s), where=event.where)
        case _:
            return None


def _request_text(event: Event) -> EventText | None:
    match event:
        case GoalSent():
            return _say("goal", event.path, address=event.address, request=_short(event.request))
        case GoalFinished():
            id_ = "goal_finished" if event.status == "succeeded" else "goal_finished.failed"
            return _say(id_, event.path, event.cause, goal=event.goal, status=event.status)
        case GoalHeld():
            return _say("goal_held", event.path, goal=event.goal)
        case GoalResumed():
            return _say("goal_resumed", event.path, goal=event.goal)
        case ServiceCalled():
            return _say("call", event.path, address=event.address, request=_short(event.request))
        case ServiceAnswered():
            if event.cause is not None:
                return _say("answer.failed", event.path, event.cause, call=event.call)
            return _say("answer", event.path, call=event.call, result=_short(event.result))
        case MessagePublished():
            return _say("published", event.path, topic=event.topic, message=_short(event.message))
        case MessageReceived():
            return _say("received", event.path, topic=event.topic, message=_short(event.message))
        case FaultInjected():
            id_ = "fault.detail" if event.detail else "fault"
            return _say(id_, event.path, address=event.address, fault=event.fault, detail=event.detail)
        case _:
            return None


def _control_text(event: Event) -> EventText | None:
    match event:
        case OperatorCommanded():
            id_ = "command.arguments" if event.arguments else "command"
            return _say(id_, event.path, command=event.command, arguments=_short(event.arguments))
        case GateReached():
            id_ = "gate.outcome" if event.outcome else "gate"
            reasons = ", ".join(event.reasons)
            return _say(id_, event.path, point=event.point, outcome=event.outcome, reasons=reasons)
        case GatePassed():
            return _say("gate_passed", event.path, point=event.point)
        case OutcomeRequested():
            return _say("outcome_requested", event.path, outcome=event.outcome, required=event.required)
        case OutcomeWithdrawn():
            return _say("outcome_withdrawn", event.path, outcome=event.outcome)
        case PauseConfirmed():
            id_ = "pause_confirmed.cannot" if event.cannot else "pause_confirmed"
            return _say(id_, "", cannot=", ".join(event.cannot))
        case OperatorChanged():
            return _say("operator.lost" if event.status == "lost" else "operator", "", status=event.status)
        case BehaviorChanged():
            id_ = "behavior_changed" if event.report else "behavior_changed.same"
            return _say(id_, "", report="; ".join(event.report))
        case UndoStarted():
            return _say("undo_began", event.path, undoes=event.undoes)
        case UndoEnded():
            how = "stopped" if event.preempted else "failed" if event.cause is not None else "done"
            return _say(f"undo_ended.{how}", event.path, event.cause, undoes=event.undoes)
        case RunSteppedBack():
            id_ = "stepped_back.failed" if event.cause is not None else "stepped_back"
            id_ = "stepped_back.values" if event.cause is None and event.values else id_
            return _say(id_, event.path, event.cause, values=_restored_values(event))
        case _:
            return None


def _run_text(event: Event) -> EventText:
    match event:
        case RunStarted():
            return _say("run_started", "", behavior=event.behavior, seed=event.seed, clock=event.clock)
        case RunResumed():
            id_ = "resumed.rerun" if event.rerun else "resumed"
            return _say(id_, "", after_seq=event.after_seq, rerun=", ".join(event.rerun))
        case StopRequested():
            return _say("stop", "", reason=event.reason)
        case RunEnded():
            failed = event.status == "errored" or event.cause is not None
            variant = "_".join(("failed",) * failed + ("outcome",) * bool(event.outcome))
            id_ = f"run_ended.{variant}" if variant else "run_ended"
            duration = _seconds(event.time_s)
            return _say(id_, "", event.cause, status=event.status, outcome=event.outcome, duration=duration)
        case _:
            return EventText("", "info", type(event).__name__, None)


def _restored_values(event: RunSteppedBack) -> str:
    values = [f"{each.key} = {_short(each.value, 60)}" if each.defined else f"no {each.key}" for each in event.values]
    return ", ".join(values)


def _seconds(duration_s: float) -> str:
    return f"{duration_s:.2f} s" if math.isfinite(duration_s) else "?"


def _short(value: object, limit: int = 160) -> str:
    text = msgspec.json.encode(value).decode()
    return text if len(text) <= limit else f"{text[:limit]}\u2026"
