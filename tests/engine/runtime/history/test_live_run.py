"""The fold from events to what the page shows."""

from __future__ import annotations

from typing import get_args

import msgspec
import pytest

from engine.errors import Cause
from engine.event import (
    AnyEvent,
    Event,
    GoalFinished,
    MessageLogged,
    NodeEntered,
    NodeExited,
    RunEnded,
    RunResumed,
    RunStarted,
    RunSteppedBack,
    StatusChanged,
    TransitionTaken,
    UndoEnded,
    UndoStarted,
)
from engine.runtime.history.event_log import CauseLine, log_line
from engine.runtime.history.event_texts import event_text
from engine.runtime.history.live_run import LOG_LINES, LiveRun
from engine.runtime.history.run_state import NodeLive, PlanLive


def entered(seq: int, path: str, visit: int = 1, time_s: float = 0.0) -> Event:
    return NodeEntered(seq=seq, time_s=time_s, path=path, visit=visit, kind="state", inputs={})


def exited(seq: int, path: str, outcome: str = "done", *, time_s: float = 0.0, cause: Cause | None = None) -> Event:
    return NodeExited(seq=seq, time_s=time_s, path=path, visit=1, outcome=outcome, cause=cause)


def arrived(seq: int, result: dict[str, object]) -> Event:
    return GoalFinished(seq=seq, time_s=float(seq), path="root/plan", goal="g", status="succeeded", result=result)


def folded(*events: Event) -> LiveRun:
    live = LiveRun("r")
    for event in events:
        live.apply(event)
    return live


def test_two_branches_are_active_at_the_same_time() -> None:
    """Concurrency shown truthfully."""
    live = folded(entered(1, "root"), entered(2, "root/left"), entered(3, "root/right"))
    assert {path for path, node in live.state.nodes.items() if node.status == "active"} == {
        "root",
        "root/left",
        "root/right",
    }


def test_a_run_that_is_resumed_is_announced_as_one_that_starts_is() -> None:
    """Otherwise no page hears of it before it waits or ends."""
    live = folded(entered(1, "root"))
    change = live.apply(RunResumed(seq=2, time_s=0.0, epoch=2, after_seq=1, rerun=()))
    assert change is not None
    assert change.run_changed


def test_a_visit_shorter_than_a_frame_is_counted() -> None:
    """The counter is what the page lights a blink by."""
    live = folded(entered(1, "root/a", time_s=1.0), exited(2, "root/a", time_s=1.001))
    assert live.state.nodes["root/a"] == NodeLive(
        status="done", visits=1, outcome="done", entered_s=1.0, duration_s=1.001 - 1.0
    )


def test_a_failure_is_distinguished_from_another_outcome() -> None:
    """By its cause, or by the name of its outcome."""
    live = folded(
        exited(1, "root/a", "empty", cause=Cause(message="nothing held")),
        exited(2, "root/b", "failed"),
        exited(3, "root/c", "empty"),
        NodeExited(seq=4, time_s=0.0, path="root/d", visit=1, outcome="preempted", preempted=True),
    )
    assert {path: node.status for path, node in live.state.nodes.items()} == {
        "root/a": "failed",
        "root/b": "failed",
        "root/c": "done",
        "root/d": "stopped",
    }
    assert live.state.nodes["root/a"].cause == "nothing held"


def test_a_condition_that_does_not_hold_is_no_failure_and_says_why() -> None:
    """It was red on the page, and an error in the log, where the machine just goes the other way."""
    because = Cause(message="the condition is false", where="root/where", kind="flow.Decide")
    event = exited(2, "root/where", "false", cause=because)
    live = folded(entered(1, "root/where"), event)
    assert live.state.nodes["root/where"].status == "done"
    text = event_text(event)
    assert (text.level, text.cause) == ("info", because)


def test_a_condition_in_a_tree_fails_where_the_tree_says_so() -> None:
    live = folded(
        entered(1, "root/branch/where"),
        exited(2, "root/branch/where", "false"),
        StatusChanged(seq=3, time_s=0.0, path="root/branch/where", status="failure"),
    )
    assert live.state.nodes["root/branch/where"].status == "failed"


def test_what_lies_inside_a_container_starts_afresh_with_it() -> None:
    """Counters go on, old outcomes do not look new; a neighbour with the same beginning stays."""
    live = folded(
        entered(1, "root/a"),
        entered(2, "root/a/x"),
        exited(3, "root/a/x"),
        entered(4, "root/ab"),
        entered(5, "root/a", visit=2),
    )
    assert live.state.nodes["root/a/x"] == NodeLive(visits=1)
    assert live.state.nodes["root/ab"].status == "active"


def test_the_arrow_taken_last_is_known_until_the_machine_starts_anew() -> None:
    """Highlighted in the graph."""
    arrow = TransitionTaken(seq=2, time_s=0.0, path="root", source="a", outcome="done", target="b")
    live = folded(entered(1, "root"), arrow)
    assert live.state.nodes["root"].last_transition == "a|done"
    live.apply(entered(3, "root", visit=2))
    assert live.state.nodes["root"].last_transition == ""


def test_the_path_taken_is_counted_by_outcome_until_the_machine_starts_anew() -> None:
    """Lit in the graph; a further visit of the state keeps the count."""

    def leaves(seq: int, outcome: str) -> TransitionTaken:
        return TransitionTaken(seq=seq, time_s=0.0, path="root", source="a", outcome=outcome, target="a")

    live = folded(
        entered(1, "root"),
        entered(2, "root/a"),
        leaves(3, "again"),
        entered(4, "root/a", visit=2),
        leaves(5, "again"),
        entered(6, "root/a", visit=3),
        leaves(7, "done"),
    )
    assert live.state.nodes["root/a"].taken == {"again": 2, "done": 1}
    live.apply(entered(8, "root", visit=2))
    assert live.state.nodes["root/a"].taken == {}


def test_nothing_is_left_active_after_the_end() -> None:
    """Also when the end came without exits."""
    live = folded(entered(1, "root"), entered(2, "root/a"), RunEnded(seq=3, time_s=2.0, status="errored"))
    assert {node.status for node in live.state.nodes.values()} == {"stopped"}
    assert live.state.ended


def test_an_event_that_was_folded_already_changes_nothing() -> None:
    """A journal and the stream may overlap."""
    live = folded(entered(1, "root"), exited(2, "root"))
    assert live.apply(entered(1, "root")) is None
    assert live.state.nodes["root"].status == "done"


def test_a_way_that_was_planned_belongs_to_the_visit_that_planned_it() -> None:
    """Of all results of goals only a way is one."""
    plan: dict[str, object] = {
        "robot": "left",
        "waypoints": [[0.0], [1.0]],
        "speed": 0.3,
        "duration_s": 2.5,
        "tool_path": [[0.0, 0.0, 0.0], [0.3, 0.4, 0.0], [0.3, 0.4, 1.0]],
        "found_by": "fast",
        "planning_s": 0.01,
    }
    live = folded(entered(1, "root/plan"), arrived(2, {"joints": [1.0]}))
    assert live.state.nodes["root/plan"].plan is None
    live.apply(arrived(3, plan))
    assert live.state.nodes["root/plan"].plan == PlanLive(
        robot="left", duration_s=2.5, length_m=1.5, found_by="fast", planning_s=0.01
    )
    live.apply(entered(4, "root/plan", visit=2))
    assert live.state.nodes["root/plan"].plan is None


def test_the_log_is_bounded() -> None:
    """Old lines go."""
    live = LiveRun("r")
    for seq in range(1, LOG_LINES + 11):
        live.apply(MessageLogged(seq=seq, time_s=0.0, path="root", level="info", message=str(seq)))
    assert (len(live.log), live.log[0].seq) == (LOG_LINES, 11)


def test_a_cause_chain_is_reported_from_the_inside_out() -> None:
    """All links, in order."""
    cause = Cause(message="outer", where="root/a", kind="A", because=Cause(message="inner", where="arm", kind="B"))
    line = log_line(exited(1, "root/a", "failed", cause=cause), duration_s=1.5)
    assert (line.level, line.text) == ("error", "ended with failed after 1.50 s")
    assert line.causes == (
        CauseLine(message="inner", where="arm", kind="B"),
        CauseLine(message="outer", where="root/a", kind="A"),
    )


_SAMPLES: dict[str, object] = {
    "<class 'int'>": 1,
    "<class 'float'>": 1.0,
    "dict[str, object]": {},
    "tuple[str, ...]": (),
}
EVENTS: list[type[Event]] = [kind for kind in get_args(AnyEvent) if kind is not RunStarted]


@pytest.mark.parametrize("kind", EVENTS, ids=[kind.__name__ for kind in EVENTS])
def test_every_kind_of_event_is_said_in_words(kind: type[Event]) -> None:
    """The name of a class is no sentence; a new kind of event needs its words."""
    given: dict[str, object] = {"seq": 1, "time_s": 0.0}
    for field in msgspec.structs.fields(kind):
        if field.required and field.name not in given:
            given[field.name] = _SAMPLES.get(str(field.type), "x")
    assert log_line(msgspec.convert({**given, "event": kind.__struct_config__.tag}, kind)).text != kind.__name__


def test_parts_of_a_tree_show_their_status() -> None:
    live = LiveRun("r1")
    for seq, status in enumerate(("running", "success"), 1):
        live.apply(StatusChanged(seq=seq, time_s=float(seq), path="root/tree/sequence", status=status))
    node = live.state.nodes["root/tree/sequence"]
    assert (node.status, node.visits, node.duration_s) == ("done", 1, 1.0)


def test_a_leaf_that_has_ended_stands_as_it_did_until_the_tree_reads_that() -> None:
    """A tick that has not come to it is no further visit."""
    live = folded(entered(1, "root/tree/a"), exited(2, "root/tree/a"))
    before = live.state.nodes["root/tree/a"]
    for seq, status in enumerate(("running", "success"), 3):
        live.apply(StatusChanged(seq=seq, time_s=float(seq), path="root/tree/a", status=status))
        assert live.state.nodes["root/tree/a"] == before


def test_what_a_step_back_undoes_is_active_and_then_as_if_it_had_not_been_entered() -> None:
    """Counters go on; the container's arrow into it is dark again; a neighbour stays as it was."""
    live = folded(
        entered(1, "root"),
        entered(2, "root/a"),
        exited(3, "root/a"),
        TransitionTaken(seq=4, time_s=0.0, path="root", source="a", outcome="done", target="b"),
        entered(5, "root/b"),
        exited(6, "root/b"),
        TransitionTaken(seq=7, time_s=0.0, path="root", source="b", outcome="done", target="c"),
        UndoStarted(seq=8, time_s=3.0, path="root/b", visit=2, undoes=1),
    )
    assert live.state.nodes["root/b"] == NodeLive(status="active", visits=2, entered_s=3.0)
    live.apply(UndoEnded(seq=9, time_s=4.0, path="root/b", visit=2, undoes=1))
    live.apply(RunSteppedBack(seq=10, time_s=4.0, path="root/b", source="root/c"))
    assert live.state.nodes["root/b"] == NodeLive(visits=2)
    assert live.state.nodes["root"].last_transition == ""
    assert live.state.nodes["root/a"].status == "done"


def test_an_undo_that_failed_is_shown_so_with_its_reason() -> None:
    """The node has done what it did, and it was not undone."""
    cause = Cause(message="the tray is gone")
    live = folded(
        UndoStarted(seq=1, time_s=3.0, path="root/b", visit=2, undoes=1),
        UndoEnded(seq=2, time_s=4.0, path="root/b", visit=2, undoes=1, cause=cause),
        RunSteppedBack(seq=3, time_s=4.0, path="root/c", source="root/c", cause=cause),
    )
    assert (live.state.nodes["root/b"].status, live.state.nodes["root/b"].cause) == ("failed", "the tray is gone")
