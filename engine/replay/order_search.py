"""Searches the order of simultaneous responses with which a behavior reproduces its recording.

In the recorded run an answer took some turns of the loop from its device to the state that waited,
during which others that were ready at that instant did things that left no event. How many turns
is not recorded, and must not make a difference where any number gives the expected events again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product

from engine.event import (
    BehaviorChanged,
    GoalFinished,
    GoalHeld,
    GoalResumed,
    MessageReceived,
    OperatorChanged,
    OperatorCommanded,
    ServiceAnswered,
    StopRequested,
)
from engine.recording import RecordedEvent
from engine.replay.recorded_schedule import BEFORE_CANCEL
from engine.replay.replay_run import ReplayRun

_ANSWERS = (
    ServiceAnswered,
    GoalFinished,
    GoalHeld,
    GoalResumed,
    MessageReceived,
    StopRequested,
    OperatorCommanded,
    OperatorChanged,
    BehaviorChanged,
)
_MOST_TURNS = 4
_MOST_ANSWERS = 8
_TOGETHER = 3
_INSTANT_S = 1e-9
_EFFORT = 20_000
"""Maximum number of events processed in the search."""


def search_order(
    first: ReplayRun, attempt: Callable[[Mapping[int, int]], ReplayRun], expected: Sequence[RecordedEvent]
) -> ReplayRun:
    """Return the attempt with the most equal events, beginning with `first`; deterministic."""
    best = first
    left = max(1, _EFFORT // len(expected))
    while not best.same and best.met < len(expected):
        for turns in _variants(best, expected):
            left -= 1
            tried = attempt(turns)
            if tried.same or tried.met > best.met:
                best = tried
                break
            if left <= 0:
                return best
        else:
            return best
    return best


def _variants(best: ReplayRun, expected: Sequence[RecordedEvent]) -> Iterator[Mapping[int, int]]:
    """Iterate over other orders of the responses at the instant at which an attempt failed.

    Responses are moved one after the other, the last one first, then the last few together.
    """
    instant_s = expected[best.met].at_s
    places: list[int] = []
    for place in range(best.met, -1, -1):
        if abs(expected[place].at_s - instant_s) > _INSTANT_S or len(places) == _MOST_ANSWERS:
            break
        if isinstance(expected[place].event, _ANSWERS):
            places.append(place)
    for turns in (BEFORE_CANCEL, *range(1, _MOST_TURNS + 1)):
        for place in places:
            if best.turns.get(place, 0) != turns:
                yield {**best.turns, place: turns}
    last = places[:_TOGETHER]
    for moved in product(range(_MOST_TURNS), repeat=len(last)):
        yield {**best.turns, **dict(zip(last, moved, strict=True))}
