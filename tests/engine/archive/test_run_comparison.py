"""Of two runs is told what differs: settings, documents, durations, values, and how they ended."""

from __future__ import annotations

from collections.abc import Mapping

import pytest
from hypothesis import given

from engine.archive import ArchivedRun, PastRun, RunComparison, compare_runs, run_comparison
from engine.event import Event, NodeEntered, NodeExited, RunEnded, RunStarted, UserdataAppended, UserdataWritten
from engine.library import BehaviorView, GraphNode
from tests.editor_web.fake_behaviors import machine, state
from tests.engine.archive.runs_of_events import VISITS, MadeVisit, run_of

TEXT = "flexcell: 1\nname: pick\nspeed: 0.5\n"


def past_run(run: str = "r1", /, **fields: object) -> PastRun:
    """One run of a list."""
    known: dict[str, object] = {
        "behavior": "pick",
        "document": "d",
        "status": "finished",
        "outcome": "good",
        "success": True,
        "cause": "",
        "started_at_s": 1000.0,
        "duration_s": 4.0,
        "events": 9,
    }
    return PastRun(id=run, **{**known, **fields})  # type: ignore[arg-type]


def archived(
    events: list[Event], documents: Mapping[str, str] | None = None, graph: GraphNode | None = None
) -> ArchivedRun:
    """A run of these events."""
    view = BehaviorView(id="pick.yaml", name="pick", description="", graph=graph)
    return ArchivedRun(summary=past_run(), events=tuple(events), behavior=view, plan=None, documents=documents or {})  # type: ignore[arg-type]


def run_with(parameters: dict[str, object], read: object, wrote: object, *, appended: object = 1) -> ArchivedRun:
    """A run of one state that reads a pose and writes another one."""
    return archived(
        [
            RunStarted(1, 0.0, behavior="b", document="d", parameters=parameters, seed=1, clock="virtual"),
            NodeEntered(2, 0.0, path="root", visit=1, kind="machine", inputs={}),
            NodeEntered(3, 0.0, path="root/look", visit=1, kind="state", inputs={"pose": read}),
            UserdataWritten(4, 1.0, path="root/look", scope="root", key="found", value=wrote),
            UserdataAppended(5, 1.0, path="root/look", scope="root", key="all", value=appended),
            NodeExited(6, 1.5, path="root/look", visit=1, outcome="done"),
            NodeExited(7, 1.5, path="root", visit=1, outcome="good"),
            RunEnded(8, 1.5, status="finished", outcome="good"),
        ]
    )


def different_values(comparison: RunComparison) -> list[tuple[str, str, str, str | None, str | None]]:
    """The values that differ."""
    return [(each.path, each.kind, each.at, each.left, each.right) for each in comparison.data]


@given(visits=VISITS)
def test_a_run_does_not_differ_from_itself(visits: tuple[MadeVisit, ...]) -> None:
    """In anything."""
    run = archived(run_of(*visits), {"pick.yaml": TEXT})
    found = compare_runs(run, run)
    assert (found.divergence, found.settings, found.documents, found.data) == (None, (), (), ())
    assert all(each.visits_left == each.visits_right for each in found.nodes)
    assert all(each.duration_left_s == each.duration_right_s for each in found.nodes)


def test_values_are_compared_inside_and_named_with_their_visit() -> None:
    """Those that were read, written, and appended."""
    left = run_with({"speed": 0.5, "part": "a"}, {"xyz_m": [0.0, 1.0, 2.0]}, {"label": "bolt"})
    right = run_with({"speed": 0.7, "part": "a", "new": True}, {"xyz_m": [0.0, 1.5, 2.0]}, {"label": "nut"}, appended=2)
    found = compare_runs(left, right)
    assert different_values(found) == [
        ("root/look", "read", "pose.xyz_m[1]", "1.0", "1.5"),
        ("root/look", "wrote", "found.label", '"bolt"', '"nut"'),
        ("root/look", "wrote", "all (appended)[0]", "1", "2"),
    ]
    assert found.visits[found.data[0].index].path == "root/look"
    assert [(each.at, each.left, each.right) for each in found.settings] == [
        ("parameters.speed", "0.5", "0.7"),
        ("parameters.new", None, "true"),
    ]


def test_durations_are_those_of_all_visits_of_a_node() -> None:
    """With how many there were."""
    slow, fast = MadeVisit("move", takes_s=2.0), MadeVisit("move", takes_s=0.5)
    found = compare_runs(archived(run_of(slow, fast, fast)), archived(run_of(fast)))
    assert [
        (each.path, each.visits_left, each.visits_right, each.duration_left_s, each.duration_right_s)
        for each in found.nodes
    ] == [("root", 1, 1, 3.0, 0.5), ("root/move", 3, 1, 3.0, 0.5)]


def test_documents_that_differ_are_compared_line_by_line() -> None:
    """And those that only one run has."""
    run = run_of(MadeVisit("move"))
    left = archived(run, {"pick.yaml": TEXT, "same.yaml": "a\n"})
    right = archived(run, {"pick.yaml": TEXT.replace("0.5", "0.7"), "same.yaml": "a\n", "new.yaml": "b\n"})
    found = {each.name: each.lines for each in compare_runs(left, right).documents}
    assert found == {
        "pick.yaml": ("@@ -1,3 +1,3 @@", " flexcell: 1", " name: pick", "-speed: 0.5", "+speed: 0.7"),
        "new.yaml": ("@@ -0,0 +1 @@", "+b"),
    }


def test_visited_nodes_have_their_icons() -> None:
    """As far as the graph of one of the runs is known; a node that no run has visited is not among them."""
    run = run_of(MadeVisit("move"), MadeVisit("wait"))
    graph = machine(
        "root", (state("root/move", "x.A", "done"), state("root/rest", "x.A", "done")), "move.done>good", "good"
    )
    assert compare_runs(archived(run), archived(run)).icons == {}
    assert compare_runs(archived(run, graph=graph), archived(run)).icons == {"root": "sitemap", "root/move": "state"}


def test_of_many_visits_those_that_differ_are_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the number of those that are not, and in their order."""
    monkeypatch.setattr(run_comparison, "MAX_VISITS", 4)
    moves = tuple(MadeVisit("move", outcome="failed" if index == 6 else "done") for index in range(9))
    found = compare_runs(archived(run_of(*[MadeVisit("move")] * 9)), archived(run_of(*moves)))
    assert [each.left.visit for each in found.visits if each.left] == [1, 1, 2, 7]
    assert found.left_out == 6
    assert found.divergence is not None
    assert found.visits[found.divergence.index].path == found.divergence.path
    differing = found.visits[found.divergence.index].right
    assert differing is not None
    assert differing.visit == 7
