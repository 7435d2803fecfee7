"""The events that a replay must reproduce, and the interventions from outside among them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from engine.errors import Cause, RecordingError
from engine.event import (
    AnyEvent,
    BehaviorChanged,
    Event,
    FaultInjected,
    LoopBlocked,
    MessageLogged,
    OperatorChanged,
    OperatorCommanded,
    RunEnded,
    RunResumed,
    RunStarted,
    StopRequested,
)
from engine.recording import RecordedEvent, Recording
from engine.runtime.run_options import RunOptions

_UNAPPLIED = re.compile(r" was never applied: ")
_SLACK_S = 1e-3

OutsideEvent = StopRequested | OperatorCommanded | OperatorChanged | BehaviorChanged


@dataclass(frozen=True)
class Intervention:
    """An external intervention: a stop, a command, an operator; `place` counts from 0."""

    place: int
    at_s: float
    event: OutsideEvent
    failure: Cause | None = None
    """Where a stop was no wish but the end of all that could be done: the cause that the run ended with."""


def is_replayed(event: Event) -> bool:
    """Return whether a replay reproduces this event; injected faults are part of the responses."""
    if isinstance(event, MessageLogged):
        return _UNAPPLIED.search(event.message) is None
    return not isinstance(event, (FaultInjected, LoopBlocked))


def replayed_events(recording: Recording) -> tuple[RecordedEvent, ...]:
    """Return the events that a replay reproduces, from the first.

    Raises:
        RecordingError: this run cannot be replayed from its start.
    """
    expected = tuple(each for each in recording.events if is_replayed(each.event))
    if not expected:
        raise RecordingError("this recording contains no events", where=recording.path, hint="record it again")
    if not isinstance(expected[0].event, RunStarted):
        raise RecordingError(
            "this recording does not begin with the start of its run", where=recording.path, hint="record it again"
        )
    for each in expected:
        _require_replayable(each.event, recording)
    return expected


def interventions(expected: Sequence[RecordedEvent], supervision: RunOptions) -> Iterator[Intervention]:
    """Iterate over external interventions, without the run's own reactions to them."""
    lost_s: float | None = None
    for place, each in enumerate(expected):
        event = each.event
        if isinstance(event, OperatorChanged):
            lost_s = each.at_s if event.status == "lost" else None
        if not isinstance(event, (StopRequested, OperatorCommanded, OperatorChanged, BehaviorChanged)):
            continue
        if place == 1 and supervision.start_paused:
            continue
        if lost_s is not None and _is_loss(event, each.at_s - lost_s, supervision):
            lost_s = None
            continue
        yield Intervention(place, each.at_s, event, _failure(event, expected[-1].event))


def _failure(event: OutsideEvent, end: Event) -> Cause | None:
    if not isinstance(event, StopRequested) or not isinstance(end, RunEnded) or end.status != "errored":
        return None
    return end.cause if end.cause is not None and end.cause.message.startswith(event.reason) else None


def _is_loss(event: OutsideEvent, after_s: float, supervision: RunOptions) -> bool:
    """Return whether this event is the reaction of the loss policy."""
    if after_s < supervision.loss_timeout_s - _SLACK_S:
        return False
    if supervision.loss_policy == "hold":
        return isinstance(event, OperatorCommanded) and event.command == "pause"
    return isinstance(event, StopRequested) and event.reason == "the operator was lost"


def _require_replayable(event: AnyEvent, recording: Recording) -> None:
    match event:
        case RunResumed() | OperatorCommanded(command="start_from"):
            why = "this run was not executed from its start"
        case BehaviorChanged(documents=documents) if not documents:
            why = "the behavior of this run was changed during the run, and the new version was not kept"
        case _:
            return
    raise RecordingError(
        f"{why} (event {event.seq}), which cannot be replayed", where=recording.path, hint="record it in one piece"
    )
