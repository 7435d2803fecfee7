"""Replays a recorded run in virtual time and without its robots, and reports the first difference."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter

from engine.document import Behavior
from engine.errors import RecordingError
from engine.event import BehaviorChanged, Event
from engine.recording import RecordedEvent, Recording, recorded_behavior, recorded_substitutes
from engine.recording.recorded_run import changed_behavior
from engine.replay.document_differences import altered_records, changed_defaults
from engine.replay.expected_events import replayed_events
from engine.replay.order_search import search_order
from engine.replay.replay_difference import ReplayDifference
from engine.replay.replay_loop import ReplayLoop
from engine.replay.replay_run import ReplayRun
from engine.runtime.plan import Catalogue, Plan, new_plan


@dataclass(frozen=True, kw_only=True)
class ReplayReport:
    """The result of a replay."""

    recording: Recording
    differences: tuple[ReplayDifference, ...]
    """The first difference between the events, altered records, changed defaults; empty if the runs are equal."""
    events: tuple[Event, ...]
    """The events of the replay."""
    compared: int
    """Number of recorded events that occurred."""
    duration_s: float
    """Duration of the replay on the wall clock."""

    @property
    def difference(self) -> ReplayDifference | None:
        """The first of the differences; None if the runs are equal."""
        return self.differences[0] if self.differences else None

    @property
    def same(self) -> bool:
        """Whether all recorded events occurred and no others, unaltered, and with no other defaults."""
        return not self.differences


def replay(recording: Recording, catalogue: Catalogue, *, behavior: Behavior | None = None) -> ReplayReport:
    """Replay a recording, with another version of its behavior if one is given.

    Raises:
        RecordingError: it cannot be replayed.
        DocumentError: the behavior cannot be executed with the recorded parameters and inputs.
    """
    started_s = perf_counter()
    expected = replayed_events(recording)
    plan = new_plan(_executed(recording, behavior), catalogue)
    versions = dict(_versions(expected, plan, catalogue))
    if behavior is not None and versions:
        raise RecordingError("a run whose behavior was changed is replayed with its own versions only")

    def attempt(turns: Mapping[int, int]) -> ReplayRun:
        again = ReplayRun(recording, plan, expected, turns, versions)
        ReplayLoop().run_main(again.run())
        return again

    again = attempt({})
    if recording.description.clock == "virtual":
        again = search_order(again, attempt, expected)
    return ReplayReport(
        recording=recording,
        differences=(
            *((again.difference,) if again.difference is not None else ()),
            *altered_records(recording),
            *(changed_defaults(recording, behavior) if behavior is not None else ()),
        ),
        events=tuple(again.events),
        compared=again.met,
        duration_s=perf_counter() - started_s,
    )


def _versions(expected: Sequence[RecordedEvent], plan: Plan, catalogue: Catalogue) -> Iterator[tuple[int, Plan]]:
    """Go through what took over in hot changes, by the number of the event; the same stands in for its nodes."""
    for each in expected:
        if isinstance(each.event, BehaviorChanged) and (changed := changed_behavior(each.event)) is not None:
            yield each.event.seq, new_plan(changed.with_substitutes(plan.substitutes), catalogue)


def _executed(recording: Recording, changed: Behavior | None) -> Behavior:
    """Return what is run again: another version has the same substitutes, as nothing else was recorded."""
    if changed is None:
        return recorded_behavior(recording.documents)
    return changed.with_substitutes(recorded_substitutes(recording.documents))
