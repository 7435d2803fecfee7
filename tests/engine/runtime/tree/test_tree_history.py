"""A tree that was cut goes on from its events as if nothing had happened."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import cast

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from engine.event import Event, NodeEntered, NodeExited, StatusChanged
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node_entry import NodeEntry
from engine.runtime.plan import Plan
from engine.runtime.record.tree_event import TreeEvent
from engine.runtime.tree import Tree, TreeRunner
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome
from tests.engine.runtime.tree.run_tree import ObservedRun, run_plan, tree_plan
from tests.engine.runtime.tree.scripted_states import REMAINING
from tests.engine.runtime.tree.skipping import Guarded, guarded_trees
from tests.engine.runtime.tree.specimen import Specimen, conditional_trees, trees
from tests.tiers import examples

END_S = 6.125


@dataclass(frozen=True, kw_only=True)
class _GoingOn(Tree):
    """A tree that begins where the marks end."""

    history: tuple[TreeEvent, ...] = ()
    branches: Mapping[str, Mapping[str, object]] | None = None

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Tick it to its end."""
        runner = TreeRunner(
            self.root, path=path, scope=scope, execution=execution, history=self.history, branches=self.branches
        )
        return await runner.run()


def _cut(
    plan: Plan, told: ObservedRun, at_s: float, branches: Mapping[str, Mapping[str, object]] | None = None
) -> ObservedRun:
    """Run what is left of a run that was cut between two instants."""
    before = [event for event in told.events if event.time_s <= at_s]
    done = ResumableState(plan, run="r").read(before).checkpoint().points["root"].done
    marks = [TreeEvent(path, what, since_s - at_s) for path, what, since_s in done]
    counts: dict[str, int] = {}
    opened: dict[str, float] = {}
    for event in before:
        if isinstance(event, NodeEntered) and event.kind == "state":
            counts[event.path] = event.visit
            opened[event.path] = event.time_s
        elif isinstance(event, NodeExited):
            opened.pop(event.path, None)
    REMAINING.clear()
    REMAINING.update({path: _due(plan, path, counts[path], since_s) - at_s for path, since_s in opened.items()})
    work = plan.root.work
    assert isinstance(work, Tree)
    root = replace(plan.root, work=_GoingOn(root=work.root, history=tuple(marks), branches=branches))
    return run_plan(replace(plan, root=root), stop_at_s=(END_S - at_s,), instant_limit=100, counts=counts)


def _due(plan: Plan, path: str, count: int, since_s: float) -> float:
    work = plan.nodes[path].work
    assert isinstance(work, Leaf)
    script = cast("dict[str, list[tuple[float, bool]]]", work.parameters.value)["script"]
    return since_s + script[min(count, len(script)) - 1][0]


def _lines_after(events: Sequence[Event], since_s: float, shift_s: float) -> list[str]:
    """Say what happens after a moment, without what is begun anew at that moment itself."""
    lines: list[str] = []
    for event in events:
        at_s = event.time_s + shift_s
        if at_s <= since_s or at_s >= END_S - 0.125:
            continue
        match event:
            case NodeEntered():
                lines.append(f"{at_s} +{event.path}")
            case NodeExited():
                lines.append(f"{at_s} -{event.path} {event.preempted or event.outcome}")
            case StatusChanged():
                lines.append(f"{at_s} {event.path} {event.status}")
            case _:
                pass
    return lines


_DURATIONS = [0.5, 1.0, 2.0, 0.0]


@given(
    specimen=trees(durations=_DURATIONS, polling=False) | conditional_trees(durations=_DURATIONS),
    data=st.data(),
)
@settings(max_examples=examples(25, nightly=300), deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
def test_a_tree_goes_on_as_if_it_had_not_been_cut(specimen: Specimen, data: st.DataObject) -> None:
    """At any moment between two instants: the same leaves at the same times, the same statuses, the same end."""
    plan = tree_plan(json.dumps(specimen.document()))
    whole = run_plan(plan, stop_at_s=(END_S,), instant_limit=100)
    moments = [at * 0.25 + 0.125 for at in range(24) if at * 0.25 + 0.125 < whole.result.duration_s]
    assume(whole.result.status != "errored" and moments)
    at_s = data.draw(st.sampled_from(moments))
    rest = _compared(plan, whole, at_s)
    if whole.result.outcome is not None:
        assert rest.result.duration_s + at_s == pytest.approx(whole.result.duration_s)


def _goes_on(
    tree: str, at_s: float, head: str = "", branches: Mapping[str, Mapping[str, object]] | None = None
) -> ObservedRun:
    """Cut a tree and compare what comes after with the whole; return the rest."""
    plan = tree_plan(tree, head=head)
    return _compared(plan, run_plan(plan, stop_at_s=(END_S,), instant_limit=100), at_s, branches)


def _compared(
    plan: Plan, whole: ObservedRun, at_s: float, branches: Mapping[str, Mapping[str, object]] | None = None
) -> ObservedRun:
    """Cut a run and compare what comes after with the whole; return the rest."""
    rest = _cut(plan, whole, at_s, branches)
    # What coincides may come in another order: timers were begun in another order after the cut.
    assert sorted(_lines_after(rest.events, at_s, at_s)) == sorted(_lines_after(whole.events, at_s, 0.0))
    assert rest.result.outcome == whole.result.outcome
    return rest


@pytest.mark.parametrize("at_s", [0.5, 1.5, 3.5, 4.5])
def test_a_cooldown_goes_on_cooling_down(at_s: float) -> None:
    """It is asked again three seconds after it had ended."""
    _goes_on(
        """
        selector:
          memory: false
          children:
            - cooldown: {after: 3 s, child: {state: test.Act, with: {script: [[1, false], [1, true]]}}}
            - {state: test.Act, with: {script: [[9, true]]}}
        """,
        at_s,
    )


@pytest.mark.parametrize("at_s", [0.5, 1.25, 2.5, 3.5, 5.5])
def test_a_retry_goes_on_waiting_for_its_next_attempt(at_s: float) -> None:
    """With what is left of the wait."""
    _goes_on("retry: {times: 3, backoff: 1 s, child: {state: test.Act, with: {script: [[1, false]]}}}", at_s)


def test_branches_of_a_parallel_keep_what_they_had_written() -> None:
    """Apart from one another, until the parallel ends."""
    rest = _goes_on(
        """
        parallel:
          - sequence: [{state: test.Write, with: {value: 7}}, {state: test.Act, with: {script: [[2, true]]}}]
          - {state: test.Act, with: {script: [[3, true]]}}
        """,
        1.5,
        head="userdata: {value: 0}",
        branches={"root/parallel/sequence": {"value": 7}},
    )
    assert rest.result.userdata == {"value": 7}


def test_a_py_trees_behaviour_begins_anew() -> None:
    """Nobody knows how far it had come: it counts four ticks again, from the cut on."""
    tree = "sequence: [{behaviour: 'py_trees.behaviours:TickCounter', with: {duration: 4, completion_status: SUCCESS}}]"
    plan = tree_plan(tree)
    rest = _cut(plan, run_plan(plan), 0.25)
    assert (rest.result.outcome, rest.result.duration_s) == ("success", pytest.approx(0.4))


def test_an_end_that_no_tick_had_read_is_read_first() -> None:
    """The engine died between the end of the first leaf and the tick; the second is begun at once."""
    plan = tree_plan("sequence: [{state: test.Act, name: a, with: {script: [[1, true]]}}, {state: test.Act, name: b}]")
    told = run_plan(plan)
    seq = next(event.seq for event in told.events if isinstance(event, NodeExited) and event.path.endswith("/a"))
    cut = ObservedRun(told.result, tuple(event for event in told.events if event.seq <= seq))
    rest = _cut(plan, cut, 1.0)
    assert (rest.lines, rest.result.outcome) == (["0 +sequence/b", "0 -sequence/b yes"], "success")


@given(specimen=guarded_trees, data=st.data())
@settings(max_examples=examples(15, nightly=200), deadline=None, suppress_health_check=[HealthCheck.filter_too_much])
def test_a_tree_with_guards_goes_on_as_if_it_had_not_been_cut(specimen: Guarded, data: st.DataObject) -> None:
    """What was skipped stays so."""
    plan = tree_plan(json.dumps(specimen.document()))
    whole = run_plan(plan, stop_at_s=(END_S,), instant_limit=100)
    moments = [at * 0.25 + 0.125 for at in range(24) if at * 0.25 + 0.125 < whole.result.duration_s]
    assume(whole.result.status != "errored" and moments)
    _compared(plan, whole, data.draw(st.sampled_from(moments)))


_BRANCHES = {
    "a leaf": "{state: test.Check, with: {script: [[0.5, false]]}}",
    "a sequence": "{sequence: {memory: false, children: [{state: test.Check, with: {script: [[0.5, false]]}}]}}",
}


@pytest.mark.parametrize("branch", _BRANCHES)
@pytest.mark.parametrize("at_s", [2.125, 2.625, 3.125, 4.125])
def test_a_branch_that_ended_before_its_condition_was_asked_anew_asks_it_no_more(at_s: float, branch: str) -> None:
    """The condition is a `while_do_else` too, which another tick would begin to ask from its own condition."""
    tree = """
        while_do_else:
          while:
            while_do_else:
              while: {state: test.Check, with: {script: [[0.5, true]]}}
              do: {state: test.Check, with: {script: [[1.0, true]]}}
          do: BRANCH
        """
    _goes_on(tree.replace("BRANCH", _BRANCHES[branch]), at_s)


@pytest.mark.parametrize("at_s", [0.125, 0.375])
def test_an_end_that_no_tick_has_come_to_is_read_when_the_condition_has_ended(at_s: float) -> None:
    """The condition is asked anew when the first branch ends, and takes time."""
    tree = """
        while_do_else:
          while: {repeat: {times: 1, child: {state: test.Check, with: {script: [[0, true], [0.5, true]]}}}}
          do:
            parallel:
              policy: all
              synchronise: false
              children:
                - {state: test.Act, name: a, with: {script: [[0, true]]}}
                - {state: test.Act, name: b, with: {script: [[0.5, false]]}}
        """
    told = run_plan(tree_plan(tree)).statuses
    assert [line for line in told if "/a " in line] == [
        "0 while_do_else/parallel/a running",
        "0.5 while_do_else/parallel/a success",
    ]
    _goes_on(tree, at_s)


def test_a_part_that_was_skipped_is_not_read_once_more() -> None:
    """A tick has come to it, though it was not entered."""
    _goes_on(
        """
        while_do_else:
          while:
            while_do_else:
              while: {state: test.Act, with: {script: [[0, false]]}}
              do: {state: test.Check, name: never}
              else: {state: test.Check, name: slow, with: {script: [[0.5, false]]}}
          do: {state: test.Check, name: never}
          else:
            sequence:
              - {state: test.Act, name: first}
              - {state: test.Check, name: closed, guard: {when: "${false}", to: skipped}}
              - {state: test.Act, name: last, with: {script: [[0, false]]}}
        """,
        1.125,
    )


def test_what_a_tick_has_read_is_not_kept_though_a_nested_condition_is_asked_anew() -> None:
    """Of the sequence the second check has ended unread; the one before it was read at once."""
    _goes_on(
        """
        while_do_else:
          while:
            while_do_else: {while: SLOW, do: {state: test.Check, name: never}}
          do: {state: test.Check, name: never}
          else:
            while_do_else:
              while: SLOW
              do: {state: test.Check, name: never}
              else: {sequence: {memory: false, children: [{state: test.Check, name: at_once}, SLOW]}}
        """.replace("SLOW", "{state: test.Check, with: {script: [[0.5, false]]}}"),
        2.625,
    )
