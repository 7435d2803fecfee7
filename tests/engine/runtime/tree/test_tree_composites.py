"""Sequence, selector and parallel in virtual time, with and without memory."""

from __future__ import annotations

import pytest

from tests.engine.runtime.tree.run_tree import run_tree

YES = "{state: test.Check}"
NO = "{state: test.Check, with: {script: [[0, false]]}}"


def _act(name: str, *script: tuple[float, bool]) -> str:
    said = ", ".join(f"[{duration}, {str(good).lower()}]" for duration, good in script)
    return f"{{state: test.Act, name: {name}, with: {{script: [{said}]}}}}"


def _check(name: str, *script: tuple[float, bool]) -> str:
    return _act(name, *script).replace("test.Act", "test.Check")


def test_a_sequence_runs_its_children_one_after_the_other() -> None:
    """A plain list is a sequence with memory; each begins when the one before has succeeded."""
    told = run_tree(f"sequence: [{_act('grasp', (1, True))}, {_act('lift', (2, True))}]")
    assert told.lines == ["0 +sequence/grasp", "1 -sequence/grasp yes", "1 +sequence/lift", "3 -sequence/lift yes"]
    assert (told.result.outcome, told.result.success) == ("success", True)
    assert told.statuses == ["0 sequence running", "3 sequence success"]


def test_a_sequence_ends_with_the_first_failure_and_says_why() -> None:
    """The chain names the leaf and its outcome."""
    told = run_tree(f"sequence: [{_act('grasp', (1, False))}, {_act('lift', (2, True))}]")
    assert told.lines[-1] == "1 -sequence/grasp no"
    assert (told.result.outcome, told.why) == ("failure", ["root ended with failure", "grasp ended with no"])


def test_a_selector_runs_alternatives_until_one_succeeds() -> None:
    """The second alternative is tried when the first has failed."""
    told = run_tree(f"selector: [{_act('suction', (1, False))}, {_act('gripper', (1, True))}]")
    assert [line for line in told.lines if "+" in line] == ["0 +selector/suction", "1 +selector/gripper"]
    assert told.result.outcome == "success"


def test_a_selector_without_success_says_so() -> None:
    """The chain says how many alternatives there were, and how the last one failed."""
    told = run_tree(f"selector: [{_act('suction', (1, False))}, {_act('gripper', (1, False))}]")
    assert told.why[1:] == ["none of 2 alternatives succeeded; the last one", "gripper ended with no"]


def test_without_memory_a_check_is_asked_at_every_tick() -> None:
    """A sequence that watches a condition: the motion is stopped when the condition is gone."""
    told = run_tree(
        f"""
        parallel:
          policy: one
          children:
            - sequence:
                memory: false
                children: [{_check("clear", (0, True), (0, True), (0, False))}, {_act("move", (10, True))}]
            - {_act("a", (1, True))}
            - {_act("b", (2, True))}
    """.replace("policy: one", "policy: [a, b]")
    )
    assert told.entered("clear") == [0, 1, 2]
    assert told.lines[-4:] == [
        "2 +parallel/sequence/clear",
        "2 -parallel/sequence/clear no",
        "2 !parallel/sequence/move clean",
        "2 -parallel/sequence/move preempted",
    ]
    assert (told.result.outcome, told.result.duration_s) == ("failure", pytest.approx(2.0))


def test_without_memory_a_better_alternative_takes_over() -> None:
    """The selector stops what it had chosen; the new choice begins when that is at rest."""
    lower = _act("lower", (10, True)).replace("with: {", "with: {cleanup_s: 0.5, ")
    told = run_tree(f"""
        parallel:
          policy: [selector]
          children:
            - selector:
                memory: false
                children:
                  - sequence: [{_check("better", (0, False), (0, True))}, {_act("upper", (1, True))}]
                  - {lower}
            - {_act("tick", (3, True))}
    """)
    assert told.lines[4:] == [
        "3 -parallel/tick yes",
        "3 +parallel/selector/sequence/better",
        "3 -parallel/selector/sequence/better yes",
        "3.5 !parallel/selector/lower clean",
        "3.5 -parallel/selector/lower preempted",
        "3.5 +parallel/selector/sequence/upper",
        "4.5 -parallel/selector/sequence/upper yes",
    ]
    assert told.result.outcome == "success"


def test_a_parallel_waits_for_all_and_runs_none_of_them_twice() -> None:
    """`synchronise` is on unless switched off: what has succeeded is not run again."""
    told = run_tree(f"parallel: [{_act('left', (1, True))}, {_act('right', (2, True))}]")
    assert told.lines == [
        "0 +parallel/left", "0 +parallel/right", "1 -parallel/left yes", "2 -parallel/right yes",
    ]  # fmt: skip
    assert told.result.outcome == "success"


def test_a_parallel_fails_at_once_and_its_other_children_clean_up() -> None:
    """The tree ends when the clean-up is done."""
    slow = _act("right", (9, True)).replace("with: {", "with: {cleanup_s: 2, ")
    told = run_tree(f"parallel: [{_act('left', (1, False))}, {slow}]")
    assert told.lines[2:] == ["1 -parallel/left no", "3 !parallel/right clean", "3 -parallel/right preempted"]
    assert (told.result.outcome, told.result.duration_s) == ("failure", pytest.approx(3.0))


def test_children_of_a_parallel_that_end_at_one_instant_are_seen_together() -> None:
    """Both succeed at t=1, also without `synchronise`, as one tick sees the whole instant."""
    told = run_tree(f"""
        parallel: {{children: [{_act("left", (1, True))}, {_act("right", (1, True))}], synchronise: false}}
    """)
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(1.0))


def test_a_tree_may_be_a_single_leaf() -> None:
    """Its outcome is mapped like that of any other."""
    assert run_tree("state: test.Check").result.outcome == "success"
    assert run_tree("state: test.Check\nsuccess: [no]").result.outcome == "failure"


def test_checks_that_end_at_once_need_no_tick_of_their_own() -> None:
    """Three checks and the first action belong to one tick: nothing lies between them in the log."""
    told = run_tree(f"sequence: [{YES}, {YES}, {YES}, {_act('move', (1, True))}]")
    assert told.statuses == ["0 sequence running", "1 sequence success"]
    assert [line for line in told.lines if line.startswith("0 +")] == [
        "0 +sequence/Check", "0 +sequence/Check_2", "0 +sequence/Check_3", "0 +sequence/move",
    ]  # fmt: skip
