"""Spans agree with the fold of the live view, stay bounded, and can be asked for piece by piece."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from editor_web.past.markers import TimelineMarker, limit_markers
from editor_web.past.timeline import RunHistory, Timeline
from engine.archive import ActivationInterval
from engine.event import Event
from tests.editor_web.past.events import STEPS, made_up

LONG = [("enter", "root", 0.0)] + [
    step for _ in range(400) for step in (("enter", "root/a", 0.5), ("exit", "root/a", 0.5))
]


def history_of(events: list[Event]) -> RunHistory:
    """A run whose events are all taken."""
    course = RunHistory("r")
    for event in events:
        course.follow(event)
    return course


def spans_of(timeline: Timeline) -> dict[str, tuple[ActivationInterval, ...]]:
    """By path."""
    return {row.path: row.spans for row in timeline.rows}


@settings(deadline=None, max_examples=60)
@given(steps=STEPS, ended=st.booleans(), where=st.floats(0, 1))
def test_a_node_is_active_in_its_spans_and_nowhere_else(
    steps: list[tuple[str, str, float]], ended: bool, where: float
) -> None:
    """At any event: what the graph shows as active has a bar there, and the other way round."""
    events = made_up(steps, ended=ended)
    course = history_of(events)
    seq = math.ceil(where * len(events))
    active = {path for path, node in course.states.at(seq).nodes.items() if node.status == "active"}
    spans = spans_of(course.timeline())
    assert active == {
        path for path, row in spans.items() for span in row if span.seq <= seq and not 0 < span.end_seq <= seq
    }


@settings(deadline=None, max_examples=40)
@given(steps=STEPS, where=st.floats(0, 1))
def test_pieces_make_up_the_whole(steps: list[tuple[str, str, float]], where: float) -> None:
    """What was told first, and what is new after it, is what is told at once in the end."""
    events = made_up(steps, ended=True)
    first = math.ceil(where * len(events))
    course = history_of(events[:first])
    known = spans_of(course.timeline())
    for event in events[first:]:
        course.follow(event)
    fresh = spans_of(course.timeline(after_seq=first))
    joined = {
        path: {span.seq: span for span in (*known.get(path, ()), *fresh.get(path, ()))} for path in {*known, *fresh}
    }
    whole = spans_of(course.timeline())
    assert joined == {path: {span.seq: span for span in row} for path, row in whole.items()}


def test_too_many_spans_become_few_that_say_how_many_they_are() -> None:
    """None is lost: the visits are counted, the worst of them is told."""
    events = made_up([*LONG[:401], ("enter", "root/a", 0.0), ("fail", "root/a", 0.0), *LONG[401:]], ended=True)
    timeline = history_of(events).timeline(most=50)
    row = spans_of(timeline)["root/a"]
    assert timeline.merged
    assert len(row) <= 50
    assert sum(span.count for span in row) == 401
    assert [span.status for span in row].count("failed") == 1


def test_a_part_of_a_long_run_is_reported_exactly() -> None:
    """Only what touches that time."""
    course = history_of(made_up(LONG, ended=True))
    part = course.timeline(from_s=100.0, until_s=103.0, most=50)
    assert all(span.count == 1 for span in spans_of(part)["root/a"])
    assert all(
        span.end_s is not None and span.end_s >= 100 and span.start_s <= 103 for span in spans_of(part)["root/a"]
    )


def test_goals_make_room_for_marks_that_matter_more() -> None:
    """And what is left out is counted."""
    marks = [
        TimelineMarker(seq=seq, time_s=seq, kind="failure" if seq % 100 == 0 else "goal", path="", text="")
        for seq in range(1, 1001)
    ]
    kept, left_out = limit_markers(marks, most=50)
    assert (len(kept), left_out) == (50, 950)
    assert [mark.seq for mark in kept if mark.kind == "failure"] == list(range(100, 1001, 100))
    assert [mark.seq for mark in kept] == sorted(mark.seq for mark in kept)
