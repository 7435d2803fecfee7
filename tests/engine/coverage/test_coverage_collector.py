"""What runs have covered of a behavior, for every kind of node and way out."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from engine.coverage import CoverageCollector
from engine.coverage.coverage_item import ItemKind
from engine.errors import FlexcellError
from engine.event import BranchesPreempted, NodeDiverted, NodeEntered, NodeExited, TransitionTaken
from engine.runtime.plan import new_plan
from tests.engine.coverage.covered import behavior_of, covered, events_of, missing, seen, written
from tests.engine.fake_states import CATALOGUE
from tests.engine.reference.act import CATALOGUE as ACTS
from tests.engine.reference.interpreter import Interpreter, TooLong
from tests.engine.reference.random_behaviors import STOPS, Case, cases, preempting_cases
from tests.tiers import examples

MACHINE = """
userdata: {outcome: a}
root:
  machine:
    initial: first
    states:
      first: {state: test.Give, with: {outcome: "${outcome}"}, transitions: {a: second, b: good, c: bad}}
      second: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
"""


def test_nodes_and_transitions_of_a_machine() -> None:
    """One run goes one way; the others are missing, each at its own place."""
    coverage = covered(behavior_of(MACHINE))
    assert seen(coverage) == {
        "root: entered": 1,
        "root: outcome good": 1,
        "root/first: entered": 1,
        "root/first: a → second": 1,
        "root/second: entered": 1,
        "root/second: a → good": 1,
    }
    assert [(item.label, item.line, item.column) for item in coverage.missing] == [
        ("outcome bad", 3, 18),
        ("b → good", 11, 89),
        ("c → bad", 11, 98),
        ("b → bad", 12, 57),
        ("c → bad", 12, 65),
    ]


def test_runs_add_up() -> None:
    """Two runs that go different ways cover both."""
    coverage = covered(behavior_of(MACHINE), {"outcome": "b"}, {"outcome": "c"}, {"outcome": "c"})
    assert (coverage.runs, seen(coverage)["root/first: c → bad"], "root/second: entered" in seen(coverage)) == (
        3, 2, False,
    )  # fmt: skip


CONCURRENCY = """
userdata: {outcome: a, after_s: 1.0}
root:
  concurrency:
    states:
      left: {state: test.Give, with: {outcome: "${outcome}", after_s: "${after_s}"}}
      right: {state: test.Give, with: {after_s: 2.0}, timeout: {after: 9 s, to: late}}
    conditions:
      - {good: {left: a, right: a}}
      - {good: {left: b}}
      - {bad: {right: late}}
    otherwise: bad
"""


@pytest.mark.parametrize(
    ("outcome", "after_s", "decided"),
    [
        ("a", 1.0, "condition 1: good ← left: a, right: a"),
        ("b", 1.0, "condition 2: good ← left: b"),
        ("b", 2.0, "condition 2: good ← left: b"),
        ("c", 1.0, "condition otherwise"),
    ],
)
def test_the_condition_that_decided_is_found_out(outcome: str, after_s: float, decided: str) -> None:
    """Though two of them have the same outcome, and nobody records which one it was."""
    coverage = covered(behavior_of(CONCURRENCY), {"outcome": outcome, "after_s": after_s})
    assert [label for label in seen(coverage) if "condition" in label] == [f"root: {decided}"]


def test_a_child_that_is_preempted_has_no_outcome() -> None:
    """It was entered, no more."""
    coverage = covered(behavior_of(CONCURRENCY), {"outcome": "b", "after_s": 1.0})
    assert [label for label in seen(coverage) if label.startswith("root/right")] == ["root/right: entered"]


def test_a_condition_that_preempts_some_branches_is_covered_when_it_fires() -> None:
    """Each time once, and not where the container ended before."""
    text = CONCURRENCY.replace("- {good: {left: b}}", "- {preempt: [right], when: {left: b}}")
    fired = "root: condition 2: preempt right ← left: b"
    coverage = covered(behavior_of(text), {"outcome": "b", "after_s": 1.0})
    assert [label for label in seen(coverage) if "condition" in label] == [fired, "root: condition otherwise"]
    assert "root/right: outcome a" not in seen(coverage)
    assert fired not in seen(covered(behavior_of(text), {"outcome": "a", "after_s": 1.0}))


def test_timeout_guard_and_on_error_are_ways_out() -> None:
    """A guard leaves a node without entering it; the root's timeout gives the behavior its outcome."""
    coverage = covered(
        behavior_of("""
        root:
          timeout: {after: 10 s, to: bad}
          machine:
            initial: guarded
            states:
              guarded: {state: test.Raise, guard: {when: "${false}", to: slow}, transitions: {done: bad}}
              slow: {state: test.Give, with: {after_s: 5.0}, timeout: {after: 1 s, to: raising},
                     transitions: {a: bad, b: bad, c: bad}}
              raising: {state: test.Raise, on_error: hanging, transitions: {done: bad}}
              hanging: {state: test.Hang, transitions: {never: bad}}
        """)
    )
    assert seen(coverage) == {
        "root: entered": 1,
        "root: outcome bad": 1,
        "root: timeout → bad": 1,
        "root/guarded: guard → slow": 1,
        "root/slow: entered": 1,
        "root/slow: timeout → raising": 1,
        "root/raising: entered": 1,
        "root/raising: on_error → hanging": 1,
        "root/hanging: entered": 1,
    }


def test_rounds_of_a_foreach_and_their_ends() -> None:
    """Exhausted in one run, broken in the other."""
    behavior = behavior_of("""
        userdata: {outcomes: [a, b]}
        root:
          machine:
            initial: each
            states:
              each:
                foreach:
                  items: "${outcomes}"
                  as: outcome
                  child: {state: test.Give, with: {outcome: "${outcome}"}}
                transitions: {exhausted: good, broken: bad}
    """)
    assert missing(covered(behavior)) == [
        "root: outcome bad", "root/each: broken → bad", "root/each/child: outcome c",
    ]  # fmt: skip
    both = covered(behavior, {}, {"outcomes": ["a", "c", "a"]})
    assert (missing(both), seen(both)["root/each/child: entered"]) == ([], 4)


def test_a_retried_outcome_is_not_taken() -> None:
    """It led nowhere; the one after the last attempt does."""
    coverage = covered(
        behavior_of("""
        root:
          concurrency:
            states:
              again: {state: test.Give, with: {outcome: b}, retry: {times: 2, outcomes: [b]}}
            conditions: [{good: {again: b}}]
        """)
    )
    assert seen(coverage)["root/again: entered"] == 3
    assert seen(coverage)["root: condition 1: good ← again: b"] == 1


def test_a_behavior_used_twice_is_covered_at_each_place(tmp_path: Path) -> None:
    """Its items have the places of its own document."""
    behavior = written(
        tmp_path,
        {
            "main.yaml": """
                root:
                  machine:
                    initial: one
                    states:
                      one: {behavior: sub.yaml, transitions: {good: two, bad: bad}}
                      two: {behavior: sub.yaml, transitions: {good: good, bad: bad}}
            """,
            "sub.yaml": """
                root:
                  machine:
                    initial: give
                    states:
                      give: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
            """,
        },
    )
    coverage = covered(behavior)
    assert {"root/one/root/give: a → good", "root/two/root/give: a → good"} <= set(seen(coverage))
    assert {item.file for item in coverage.items if "/root/" in item.path} == {str(tmp_path / "sub.yaml")}


TREE = """
userdata: {first: c, after_s: 0.0}
root:
  machine:
    initial: tree
    states:
      tree:
        tree:
          selector:
            - sequence:
                - {state: test.Give, with: {outcome: "${first}"}}
                - inverter: {child: {state: test.Give, name: hold, with: {outcome: c}}}
                - {state: test.Give, name: slow, with: {after_s: "${after_s}"}, timeout: {after: 1 s, to: failure}}
            - {state: test.Give, name: again, with: {outcome: b}, success: [b]}
        transitions: {success: good, failure: bad}
"""


def test_parts_of_a_tree_are_covered_by_their_statuses() -> None:
    """Leaves by what their outcomes mean there, composites and decorators by themselves."""
    coverage = covered(behavior_of(TREE), {"first": "c"}, {"first": "a"})
    part = "root/tree/selector"
    assert {label: count for label, count in seen(coverage).items() if label.startswith(part)} == {
        f"{part}: entered": 2,
        f"{part}: status success": 2,
        f"{part}/sequence: entered": 2,
        f"{part}/sequence: status success": 1,
        f"{part}/sequence: status failure": 1,
        f"{part}/sequence/Give: entered": 2,
        f"{part}/sequence/Give: status success": 1,
        f"{part}/sequence/Give: status failure": 1,
        f"{part}/sequence/inverter: entered": 1,
        f"{part}/sequence/inverter: status success": 1,
        f"{part}/sequence/inverter/hold: entered": 1,
        f"{part}/sequence/inverter/hold: status failure": 1,
        f"{part}/sequence/slow: entered": 1,
        f"{part}/sequence/slow: status success": 1,
        f"{part}/again: entered": 1,
        f"{part}/again: status success": 1,
    }


def test_a_leaf_of_a_tree_that_times_out_has_its_status_from_there() -> None:
    """Both the timeout and the FAILURE it means were seen."""
    labels = seen(covered(behavior_of(TREE), {"first": "a", "after_s": 5.0}))
    slow = "root/tree/selector/sequence/slow"
    assert {f"{slow}: timeout → failure", f"{slow}: status failure"} <= set(labels)


def test_a_run_that_is_stopped_covers_what_it_did() -> None:
    """No outcome is invented."""
    coverage = covered(behavior_of(CONCURRENCY), {"after_s": 5.0}, stop_at_s=3.0)
    assert set(seen(coverage)) == {
        "root: entered", "root/left: entered", "root/right: entered", "root/right: outcome a",
    }  # fmt: skip


def test_the_log_of_another_version_is_refused() -> None:
    """Its nodes may mean something else."""
    other = behavior_of(MACHINE.replace("c: bad", "c: good"))
    with pytest.raises(FlexcellError, match=r"this is a run of test, document .*, not of test, document"):
        covered(behavior_of(MACHINE)).add(events_of(other))


@settings(
    deadline=None,
    max_examples=examples(20, nightly=160),
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)
@given(cases() | preempting_cases(), STOPS)
def test_nothing_that_happens_is_missed(case: Case, stop_at_s: float) -> None:
    """In any behavior: every entry, transition and diversion counts once, and every decision has its condition.

    So does whatever a condition has preempted.
    """
    try:
        Interpreter(case.behavior).run(stop_at_s)
    except TooLong:
        assume(False)
    events = events_of(case.behavior, catalogue=ACTS, stop_at_s=stop_at_s)
    coverage = CoverageCollector(case.behavior, ACTS)
    coverage.add(events)
    kinds = {kind: sum(item.count for item in coverage.items if item.kind == kind) for kind in get_args(ItemKind)}
    work = {path: node.work.kind for path, node in new_plan(case.behavior, ACTS).nodes.items()}
    taken = [e for e in events if isinstance(e, TransitionTaken) and e.outcome and work[e.path] != "foreach"]
    taken = [e for e in taken if work[f"{e.path}/{e.source}"] != "disabled"]
    decided = [e for e in events if isinstance(e, NodeExited) and e.outcome and not e.preempted]
    assert kinds["node"] == sum(isinstance(e, NodeEntered) for e in events)
    assert kinds["transition"] == len(taken)
    assert kinds["timeout"] + kinds["guard"] + kinds["on_error"] == sum(isinstance(e, NodeDiverted) for e in events)
    fired = [e for e in events if isinstance(e, BranchesPreempted)]
    assert kinds["condition"] == sum(work[e.path] == "concurrency" for e in decided) + len(fired)


@settings(deadline=None, max_examples=20)
@given(st.lists(st.sampled_from("abc"), min_size=1, max_size=5), st.integers(0, 5))
def test_two_coverages_merged_are_that_of_all_runs(outcomes: list[str], cut: int) -> None:
    """However the runs are divided; and more runs never cover less."""
    behavior = behavior_of(MACHINE)
    logs = [events_of(behavior, inputs={"outcome": outcome}) for outcome in outcomes]
    whole, first, second = (CoverageCollector(behavior, CATALOGUE) for _ in range(3))
    for index, log in enumerate(logs):
        whole.add(log)
        (first if index < cut else second).add(log)
    assert first.record().merged(second.record()) == whole.record()
    assert whole.percent >= max(first.percent, second.percent)
