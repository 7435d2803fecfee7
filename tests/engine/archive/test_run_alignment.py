"""Two runs meet visit by visit: equal ones everywhere, one more or less as exactly that gap."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

from hypothesis import assume, given
from hypothesis import strategies as st

from engine.archive import align_runs
from engine.archive.run_alignment import visits_of
from engine.event import Event, NodeEntered, NodeExited, RunEnded, RunResumed, RunStarted
from tests.editor_web.past.events import STEPS, made_up
from tests.engine.archive.runs_of_events import VISITS, MadeVisit, distinct, run_of, without

APPROACH, LIFT = MadeVisit("approach"), MadeVisit("lift")
GRASP, MISS = MadeVisit("grasp"), MadeVisit("grasp", "failed", cause="31.2 N of 30 N")


@given(steps=STEPS, ended=st.booleans())
def test_a_run_meets_itself_everywhere(steps: list[tuple[str, str, float]], ended: bool) -> None:
    """Whatever happened in it."""
    events = made_up(steps, ended=ended)
    alignment = align_runs(events, events)
    assert alignment.divergence is None
    assert [pair.left for pair in alignment.visits] == [pair.right for pair in alignment.visits]
    assert Counter(pair.left for pair in alignment.visits) == Counter(visits_of(events))


@given(visits=VISITS.map(distinct), data=st.data())
def test_one_visit_less_is_exactly_that_gap(visits: tuple[MadeVisit, ...], data: st.DataObject) -> None:
    """With the visits inside; all others meet, whichever of the runs has it. Of two in a row it could be either."""
    count = sum(made.count() for made in visits)
    assume(count)
    fewer, taken = without(visits, data.draw(st.integers(0, count - 1)))
    left, right = run_of(*visits), run_of(*fewer)
    gaps = [pair for pair in align_runs(left, right).visits if pair.left is None or pair.right is None]
    other = [pair for pair in align_runs(right, left).visits if pair.left is None or pair.right is None]
    assert [pair.left and pair.left.seq for pair in gaps] == [pair.right and pair.right.seq for pair in other]
    assert len(gaps) == taken.count()
    assert gaps[0].path.rpartition("/")[2] == taken.name


@given(visits=VISITS, data=st.data())
def test_each_visit_of_both_runs_is_aligned_once(visits: tuple[MadeVisit, ...], data: st.DataObject) -> None:
    """With one of the same path, or with none."""
    left, right = run_of(*visits), run_of(*data.draw(VISITS))
    pairs = align_runs(left, right).visits
    assert Counter(pair.left for pair in pairs if pair.left) == Counter(visits_of(left))
    assert Counter(pair.right for pair in pairs if pair.right) == Counter(visits_of(right))
    assert {pair.path for pair in pairs if pair.left and pair.left.path != pair.path} == set()
    assert {pair.path for pair in pairs if pair.right and pair.right.path != pair.path} == set()


def test_the_first_divergence_is_the_innermost_end_that_differs() -> None:
    """And not the retry after it, nor how the container or the run ended."""
    good = run_of(MadeVisit("pick", inside=(APPROACH, GRASP)), LIFT)
    bad = run_of(MadeVisit("pick", "failed", inside=(APPROACH, MISS, APPROACH, MISS)), outcome="bad")
    divergence = align_runs(good, bad).divergence
    assert divergence is not None
    assert (divergence.kind, divergence.path, divergence.left_s, divergence.right_s) == (
        "outcome",
        "root/pick/grasp",
        3.0,
        3.0,
    )
    assert divergence.text == "root/pick/grasp ended with done in the left run, and ended with failed in the right run"


def test_a_visit_that_only_one_run_has_is_named_with_its_number() -> None:
    """Where both went the same way before."""
    divergence = align_runs(run_of(APPROACH, GRASP, APPROACH), run_of(APPROACH, GRASP)).divergence
    assert divergence is not None
    assert (divergence.kind, divergence.left_s, divergence.right_s) == ("visit", 2.0, None)
    assert divergence.text == "root/approach, visit 2, was entered in the left run only"


def test_another_measurement_is_no_other_cause() -> None:
    """Another reason is."""
    again, other = replace(MISS, cause="30.8 N of 30 N"), replace(MISS, cause="no path")
    assert align_runs(run_of(MISS), run_of(again)).divergence is None
    divergence = align_runs(run_of(MISS), run_of(other)).divergence
    assert divergence is not None
    assert divergence.text == "root/grasp failed for another reason: left “31.2 N of 30 N”, right “no path”"


def side_by_side(first: str, ends: dict[str, str]) -> list[Event]:
    """A run with two branches, of which one starts first; they end in the order of `ends`."""
    events: list[Event] = [RunStarted(1, 0.0, behavior="b", document="d", parameters={}, seed=1, clock="real")]

    def publish(kind_of: type[Event], time_s: float, /, **fields: object) -> None:
        events.append(kind_of(seq=len(events) + 1, time_s=time_s, **fields))

    publish(NodeEntered, 0.0, path="root", visit=1, kind="concurrency", inputs={})
    for name in (first, *({"a", "b"} - {first})):
        publish(NodeEntered, 0.0, path=f"root/{name}", visit=1, kind="state", inputs={})
    for time_s, (name, outcome) in enumerate(ends.items(), 1):
        publish(NodeExited, float(time_s), path=f"root/{name}", visit=1, outcome=outcome)
    publish(NodeExited, 3.0, path="root", visit=1, outcome="good")
    publish(RunEnded, 3.0, status="finished", outcome="good")
    return events


def test_branches_meet_in_whatever_order_they_start_and_end() -> None:
    """Their order is chance, in real time."""
    alignment = align_runs(side_by_side("a", {"a": "done", "b": "done"}), side_by_side("b", {"b": "done", "a": "done"}))
    assert alignment.divergence is None
    assert all(pair.left and pair.right for pair in alignment.visits)


def test_of_two_branches_that_differ_the_earlier_one_is_first() -> None:
    """Whatever their order in the document."""
    left, right = side_by_side("a", {"b": "done", "a": "done"}), side_by_side("a", {"b": "failed", "a": "failed"})
    divergence = align_runs(left, right).divergence
    assert divergence is not None
    assert divergence.path == "root/b"


def test_a_run_that_was_resumed_has_the_visits_that_count() -> None:
    """What a resume has taken back was never visited."""
    events = run_of(APPROACH, GRASP)
    # The engine died in `grasp`, which is entered again.
    before = events[:5]
    again: list[Event] = [
        RunResumed(6, 9.0, after_seq=4, epoch=2, rerun=("root/grasp",)),
        NodeEntered(7, 9.0, path="root/grasp", visit=1, kind="state", inputs={}),
        NodeExited(8, 10.0, path="root/grasp", visit=1, outcome="done"),
        NodeExited(9, 10.0, path="root", visit=1, outcome="good"),
        RunEnded(10, 10.0, status="finished", outcome="good"),
    ]
    alignment = align_runs(events, [*before, *again])
    assert alignment.divergence is None
    assert all(pair.left and pair.right for pair in alignment.visits)
