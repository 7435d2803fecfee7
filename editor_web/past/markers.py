"""Timeline markers of a run: failures, commands, gates, goals, changes, faults."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from editor_web.live.event_log import log_line, status_of
from engine.event import (
    BehaviorChanged,
    Event,
    FaultInjected,
    GateReached,
    GoalFinished,
    GoalSent,
    LoopBlocked,
    NodeAbandoned,
    NodeDiverted,
    NodeExited,
    NodeRetried,
    OperatorChanged,
    OperatorCommanded,
    OutcomeRequested,
    RunEnded,
    RunResumed,
    RunSteppedBack,
    StopRequested,
)

MAX_MARKERS = 4000
"""Maximum number of markers in one response; goals are dropped first."""
_MARKED = (
    NodeAbandoned,
    BehaviorChanged,
    OperatorCommanded,
    NodeDiverted,
    NodeExited,
    FaultInjected,
    GateReached,
    GoalFinished,
    GoalSent,
    LoopBlocked,
    OperatorChanged,
    OutcomeRequested,
    NodeRetried,
    RunEnded,
    RunResumed,
    RunSteppedBack,
    StopRequested,
)


class TimelineMarker(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One marked event; `kind` is failure, command, gate, goal, change, fault or warning."""

    seq: int
    time_s: float
    kind: str
    path: str
    text: str


def marker_of(event: Event) -> TimelineMarker | None:
    """Return the marker of an event; None if it has none."""
    kind = _kind(event) if isinstance(event, _MARKED) else None
    if kind is None:
        return None
    if isinstance(event, GoalSent):
        # Goals are frequent, and their log line would contain the whole request.
        return TimelineMarker(seq=event.seq, time_s=event.time_s, kind=kind, path=event.path, text=event.address)
    line = log_line(event)
    text = f"ended with {event.outcome or 'an error'}" if isinstance(event, NodeExited) else line.text
    if line.causes:
        text = f"{text}: {line.causes[0].message}"
    return TimelineMarker(seq=event.seq, time_s=event.time_s, kind=kind, path=line.path, text=text)


def limit_markers(
    marks: Iterable[TimelineMarker], *, most: int = MAX_MARKERS
) -> tuple[tuple[TimelineMarker, ...], int]:
    """Return at most `most` markers in order, and the number dropped: goals first, then the earliest of the others."""
    every = tuple(marks)
    if len(every) <= most:
        return every, 0
    kept = [mark for mark in every if mark.kind != "goal"]
    goal_count = most - len(kept)
    if goal_count <= 0:
        return tuple(kept[-most:]), len(every) - most
    goals = [mark for mark in every if mark.kind == "goal"]
    # Evenly spread over the run, so that no part of it looks idle.
    step = len(goals) / goal_count
    kept += [goals[int(index * step)] for index in range(goal_count)]
    return tuple(sorted(kept, key=lambda mark: mark.seq)), len(every) - len(kept)


def _kind(event: Event) -> str | None:
    match event:
        case NodeExited():
            return "failure" if status_of(event) == "failed" else None
        case GoalSent():
            return "goal"
        case GoalFinished():
            return None if event.status == "succeeded" else "warning"
        case NodeDiverted():
            return "warning" if event.cause is not None else None
        case RunEnded():
            return "failure" if event.status == "errored" or event.cause is not None else None
        case OperatorCommanded() | OperatorChanged() | StopRequested():
            return "command"
        case GateReached() | OutcomeRequested():
            return "gate"
        case RunSteppedBack():
            return "failure" if event.cause is not None else "change"
        case BehaviorChanged() | RunResumed():
            return "change"
        case FaultInjected():
            return "fault"
        case NodeRetried() | NodeAbandoned() | LoopBlocked():
            return "warning"
        case _:
            return None
