"""Trees stand wherever a state can, and any node stands in a tree; one log and one chain for all."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import load_behavior, parse_behavior
from engine.event import NodeEntered
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from tests.engine.runtime.tree.run_tree import HEAD, ObservedRun, run_plan, run_tree, tree_plan
from tests.engine.runtime.tree.scripted_states import CATALOGUE

ACT = "{state: test.Act, with: {script: [[1, true]]}}"


def _run(text: str) -> ObservedRun:
    return run_plan(new_plan(parse_behavior(HEAD + text, file="test.yaml"), CATALOGUE))


def test_a_tree_in_a_machine() -> None:
    """Its outcomes are success and failure; the cause goes up through both."""
    told = _run("""
root:
  machine:
    initial: grasp
    states:
      grasp:
        tree: {sequence: [{state: test.Act, with: {script: [[1, false]]}}]}
        transitions: {success: success, failure: failure}
""")
    assert told.result.outcome == "failure"
    assert told.why == ["root ended with failure", "grasp ended with failure", "Act ended with no"]


def test_a_tree_in_a_loop_of_a_machine_is_fresh_each_time() -> None:
    """One-shots, cooldowns and the blackboard begin anew."""
    told = _run("""
root:
  machine:
    initial: tree
    states:
      tree:
        tree: {one_shot: {child: {state: test.Check, name: once}}}
        transitions: {success: count, failure: failure}
      count: {state: test.Count, transitions: {more: tree, full: success}}
""")
    assert len(told.entered("once")) == 3


def test_a_machine_that_loops_through_an_instant_tree_is_found() -> None:
    """By the machine, as the tree itself ends."""
    told = _run("""
root:
  machine:
    initial: tree
    states:
      tree: {tree: {sequence: [{state: test.Check}]}, transitions: {success: again, failure: failure}}
      again: {state: test.Check, transitions: {yes: tree, no: failure}}
""")
    assert "transitions in a row without waiting" in told.why[0]


def test_a_machine_a_concurrency_a_foreach_and_a_tree_in_a_tree() -> None:
    """Their success is what they call nominal."""
    no = "{state: test.Check, with: {script: [[0, false]]}, transitions: {yes: done, no: broken}}"
    told = run_tree(f"""
        sequence:
          - machine: {{initial: a, states: {{a: {{state: test.Act, transitions: {{yes: done, no: broken}}}}}}}}
          - concurrency:
              states: {{a: {ACT}, b: {ACT}}}
              conditions: [{{both: {{a: yes, b: yes}}}}]
              otherwise: neither
          - foreach: {{times: 3, child: {ACT}}}
          - tree: {{selector: [{ACT}]}}
          - machine: {{initial: a, states: {{a: {no}}}}}
    """)
    assert told.result.duration_s == pytest.approx(5.0)
    assert told.why[1:] == ["machine_2 ended with broken", "a ended with no"]


def test_success_names_the_outcomes_that_count() -> None:
    """For any leaf, whatever its class or container says."""
    told = run_tree("sequence: [{state: test.Give, with: {outcome: c}, success: [c]}, {state: test.Check}]")
    assert told.result.outcome == "success"


INNER = """
flexcell: 1
name: inner
parameters: {good: {type: boolean}}
outcomes: [success, failure]
success: [success]
root: {tree: {guard: {when: "${good}", child: {state: test.Act}}}}
"""
OUTER = f"""{HEAD}
root:
  tree:
    selector:
      - {{behavior: inner.yaml, with: {{good: false}}}}
      - {{behavior: inner.yaml, with: {{good: true}}}}
"""


def test_a_behavior_in_a_tree_and_a_tree_in_that(tmp_path: Path) -> None:
    """Its success is what its document says."""
    (tmp_path / "inner.yaml").write_text(INNER, encoding="utf-8")
    (tmp_path / "outer.yaml").write_text(OUTER, encoding="utf-8")
    plan = new_plan(load_behavior(tmp_path / "outer.yaml"), CATALOGUE)
    told = run_plan(plan)
    assert [e.path for e in told.events if isinstance(e, NodeEntered)] == [
        "root", "root/selector/inner", "root/selector/inner/root", "root/selector/inner_2",
        "root/selector/inner_2/root", "root/selector/inner_2/root/guard/Act",
    ]  # fmt: skip
    assert told.result.outcome == "success"


def test_two_trees_side_by_side() -> None:
    """Each wakes for its own leaves; a stop reaches both."""
    text = """
root:
  concurrency:
    states:
      left: {tree: {sequence: [{state: test.Act, with: {script: [[1, true]]}}, {state: test.Hang}]}}
      right: {tree: {repeat: {times: 3, child: {state: test.Act, with: {script: [[1, true]]}}}}}
    conditions: [{success: {right: success}}]
    otherwise: failure
"""
    told = _run(text)
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(3.0))
    assert told.lines[-2:] == ["3 -left/sequence/Hang preempted", "3 -left preempted"]


def test_hundreds_of_nodes() -> None:
    """Forty branches with a line of twenty leaves each."""
    line = ", ".join("{state: test.Act, with: {script: [[0.5, true]]}}" for _ in range(20))
    told = run_tree(f"parallel: [{', '.join(f'{{sequence: [{line}]}}' for _ in range(40))}]")
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(10.0))
    assert sum(isinstance(event, NodeEntered) for event in told.events) == 801


def test_a_plan_is_shared_by_runs_at_the_same_time() -> None:
    """It holds no state of a run."""
    plan = tree_plan(f"repeat: {{times: 3, child: {{sequence: [{ACT}, {{state: test.Check}}]}}}}")

    async def both() -> list[float]:
        bus = SkillBus(new_clock())
        runs = [Run(plan, run=name, bus=bus).execute() for name in ("a", "b")]
        return [result.duration_s for result in await asyncio.gather(*runs)]

    assert run_virtual(both()) == [3.0, 3.0]
