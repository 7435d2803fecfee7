"""A moment of the past is exactly what the live view showed then."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from editor_web.past import state_history as subject
from editor_web.past.state_history import RunStateHistory
from editor_web.past.timeline import RunHistory
from editor_web.past.userdata_values import UserdataCheckpoints
from editor_web.telemetry.page_subscriptions import userdata_scope, watch_values
from engine.event import Event, MessageLogged
from engine.runtime.history import Watch
from engine.runtime.history.live_run import LiveRun
from engine.runtime.history.userdata_history import UserdataHistory
from tests.editor_web.past.events import STEPS, made_up
from tests.engine.run_document import plan_of, run_document

COUNTING = """
userdata: {count: 0}
root:
  machine:
    initial: add
    states:
      add:
        state: test.Count
        with: {up_to: 500}
        in: {count: count}
        out: {count: count}
        transitions: {more: add, full: good}
"""


def lived(events: list[Event], seq: int) -> LiveRun:
    """What the live view had folded after an event."""
    live = LiveRun("r")
    for event in events[:seq]:
        live.apply(event)
    return live


@settings(deadline=None, max_examples=60)
@given(steps=STEPS, ended=st.booleans(), where=st.floats(0, 1))
def test_every_moment_is_what_the_live_view_showed(
    steps: list[tuple[str, str, float]], ended: bool, where: float
) -> None:
    """Nodes, clock and the last lines of the log, whatever happened."""
    events = made_up(steps, ended=ended)
    seq = math.ceil(where * len(events))
    moments = RunStateHistory("r")
    for event in events:
        moments.follow(event)
    live = lived(events, seq)
    found, state = moments.at(seq), live.state
    assert (found.seq, found.time_s, found.nodes, found.log) == (seq, state.time_s, state.nodes, tuple(live.log))


def test_checkpoints_that_become_too_many_are_thinned_and_still_lead_anywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    """A long run keeps a bounded number of them; the log is whole at every moment."""
    events: list[Event] = [
        MessageLogged(seq=number, time_s=number / 10, path="root", level="info", message=str(number))
        for number in range(1, subject.CHECKPOINT_INTERVAL * 6)
    ]
    moments = RunStateHistory("r")
    monkeypatch.setattr(subject, "MAX_CHECKPOINTS", 3)
    for event in events:
        moments.follow(event)
    for seq in (1, 700, 1024, 2000, len(events)):
        found = moments.at(seq)
        assert [line.seq for line in found.log] == list(range(max(1, seq - 999), seq + 1))
        assert found.dropped == max(0, seq - 1000)


def test_a_time_leads_to_the_last_event_before_it() -> None:
    """Also among events of one time, and before the first one."""
    moments = RunStateHistory("r")
    for seq, time_s in enumerate((0.5, 1.0, 1.0, 2.0), 1):
        moments.follow(MessageLogged(seq=seq, time_s=time_s, path="", level="info", message=""))
    assert [moments.seq_at(time_s) for time_s in (0.0, 0.5, 0.9, 1.0, 1.9, 2.0, 99.0)] == [0, 1, 1, 3, 3, 4, 4]
    assert moments.at(0).nodes == {}


def test_an_event_that_comes_again_changes_nothing() -> None:
    """Two who follow the same run may both bring it."""
    course = RunHistory("r")
    for event in made_up([("enter", "root", 0.0), ("goal", "root", 1.0)], ended=True) * 2:
        course.follow(event)
    timeline = course.timeline()
    assert timeline.seq == 4
    assert [len(row.spans) for row in timeline.rows] == [1]
    assert [mark.kind for mark in timeline.marks] == ["goal"]


COUNT = Watch(expression="count * 2")


@settings(deadline=None, max_examples=20)
@given(seqs=st.lists(st.integers(0, 2600), min_size=1, max_size=6))
def test_the_values_of_every_moment_are_what_was_reported_live(seqs: list[int]) -> None:
    """In whatever order the moments are looked at, over several checkpoints."""
    plan = plan_of(COUNTING)
    events = run_document(COUNTING).events
    moments, books = RunStateHistory("r"), UserdataCheckpoints(UserdataHistory(lambda: plan))
    for event in events:
        moments.follow(event)
    for seq in seqs:
        live = UserdataHistory(lambda: plan)
        live.read(event for event in events if event.seq <= seq)
        found = books.at(moments, min(seq, moments.last_seq), watches=[COUNT])
        assert found.scopes == {path: userdata_scope(scope) for path, scope in live.scopes.items()}
        assert found.watches == watch_values([COUNT], live)


def test_without_the_behavior_there_are_no_values() -> None:
    """And that is said."""
    assert UserdataCheckpoints(None).at(RunStateHistory("r"), 3).problem == "the executed behavior is unknown"
