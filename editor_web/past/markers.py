"""Timeline markers of a run: failures, commands, gates, goals, changes, faults."""

from __future__ import annotations

from collections.abc import Iterable
from typing import get_args

import msgspec

from engine.event import AnyEvent, Event, GoalSent
from engine.runtime.history import log_line

MAX_MARKERS = 4000
"""Maximum number of markers in one response; goals are dropped first."""
_ALWAYS = {
    "command": "command",
    "operator": "command",
    "stop": "command",
    "gate": "gate",
    "outcome_requested": "gate",
    "behavior_changed": "change",
    "resumed": "change",
    "fault": "fault",
    "retry": "warning",
    "abandoned": "warning",
    "loop_blocked": "warning",
}
"""The kind of the marker of an event, by its tag."""
_BY_LEVEL = {
    "exited": {"error": "failure"},
    "goal_finished": {"warning": "warning"},
    "diverted": {"warning": "warning"},
    "run_ended": {"error": "failure"},
    "stepped_back": {"error": "failure", "info": "change"},
}
"""The same where it depends on how severe the event is; without a kind, it has no marker."""
_MARKED = frozenset(kind for kind in get_args(AnyEvent) if kind.__struct_config__.tag in {**_ALWAYS, **_BY_LEVEL})


class TimelineMarker(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One marked event; `kind` is failure, command, gate, goal, change, fault or warning."""

    seq: int
    time_s: float
    kind: str
    path: str
    text: str


def marker_of(event: Event) -> TimelineMarker | None:
    """Return the marker of an event; None if it has none."""
    if isinstance(event, GoalSent):
        # Goals are frequent, and their log line would contain the whole request.
        return TimelineMarker(seq=event.seq, time_s=event.time_s, kind="goal", path=event.path, text=event.address)
    if type(event) not in _MARKED:
        return None
    line = log_line(event)
    kind = _ALWAYS.get(line.kind) or _BY_LEVEL.get(line.kind, {}).get(line.level)
    if kind is None:
        return None
    text = f"{line.text}: {line.causes[0].message}" if line.causes else line.text
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
