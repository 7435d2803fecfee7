"""A guard that leads to `skipped` lets the part around pass over what it guards."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings

from engine.errors import DocumentError
from tests.engine.runtime.tree.course import engine_course
from tests.engine.runtime.tree.run_tree import run_tree, tree_plan
from tests.engine.runtime.tree.skipping import Guarded, guarded_trees, run_guarded
from tests.tiers import examples

UNTIL_S = 6.0
LIMIT = 120
VALUE = "userdata: {value: 0}"


def _act(name: str, *script: tuple[float, bool], more: str = "") -> str:
    return f"{{state: test.Act, name: {name}, with: {{script: {json.dumps(script)}}}{more}}}"


@given(specimen=guarded_trees)
@settings(max_examples=examples(30, nightly=300), deadline=None)
def test_a_random_tree_with_guards_goes_the_way_of_the_reference(specimen: Guarded) -> None:
    """Through every composite, as BehaviorTree.CPP has SKIPPED."""
    expected = run_guarded(specimen, until_s=UNTIL_S, instant_limit=LIMIT)
    assert engine_course(specimen.document(), until_s=UNTIL_S, instant_limit=LIMIT) == expected


SKIP = ", guard: {when: '${false}', to: skipped}"


@pytest.mark.parametrize("kind", ["sequence", "selector", "parallel"])
def test_a_composite_whose_children_are_all_skipped_is_skipped(kind: str) -> None:
    """And the one around it passes over that too; a tree that is skipped as a whole succeeds."""
    inside = f"{{{kind}: [{_act('a', more=SKIP)}, {_act('b', more=SKIP)}]}}"
    told = run_tree(f"selector: [{inside}, {_act('c', (1, False))}]")
    assert (told.result.outcome, told.entered("c")) == ("failure", [0.0])
    assert f"0 selector/{kind} skipped" in told.statuses
    told = run_tree(f"inverter: {{child: {inside}}}")
    assert (told.result.outcome, told.statuses[-1]) == ("success", "0 inverter skipped")


@pytest.mark.parametrize(
    ("decorator", "child"),
    [
        ("repeat: {times: 3, child: <a>}", "a"),
        ("retry: {times: 3, child: <a>}", "a"),
        ("remap: {success: failure, failure: success, child: <a>}", "a"),
        ("condition: {status: failure, child: <a>}", "a"),
        ("timeout: {after: 1 s, child: <a>}", "a"),
        ("cooldown: {after: 1 s, child: <a>}", "a"),
    ],
)
@pytest.mark.parametrize("around", ["sequence", "selector"])
def test_a_decorator_passes_on_that_its_child_is_skipped(decorator: str, child: str, around: str) -> None:
    """It neither counts nor turns it."""
    part = decorator.replace("<a>", _act(child, (1, True), more=SKIP))
    told = run_tree(f"{around}: [{{{part}}}, {_act('b', (1, around == 'sequence'))}]")
    assert told.result.outcome == ("success" if around == "sequence" else "failure")
    assert told.entered("b") == [0.0]
    assert any(line.endswith(" skipped") for line in told.statuses)


def test_a_one_shot_and_a_cooldown_do_not_remember_that_nothing_was_run() -> None:
    """In the second round the guard is open."""
    inner = f"guard: {{when: '${{value == 7}}', to: skipped, child: {_act('a', (1, True))}}}"
    for decorator in ("one_shot", "cooldown"):
        more = "after: 9 s, " if decorator == "cooldown" else ""
        write = "{state: test.Write, with: {value: 7}}"
        told = run_tree(
            f"repeat: {{times: 2, child: {{sequence: [{{{decorator}: {{{more}child: {{{inner}}}}}}}, {write}]}}}}",
            head=VALUE,
        )
        assert (told.result.outcome, told.entered("a")) == ("success", [0.0])


def test_what_runs_is_halted_and_skipped_when_its_guard_closes() -> None:
    """As `_while` of BehaviorTree.CPP: the sequence goes on after the clean-up."""
    told = run_tree(
        """
        parallel:
          - sequence:
              - guard:
                  when: "${value < 5}"
                  to: skipped
                  child:
                    sequence:
                      - {state: test.Write, with: {value: 9, after_s: 1}}
                      - {state: test.Act, name: a, with: {script: [[9, true]], cleanup_s: 1}}
              - {state: test.Act, name: b, with: {script: [[1, true]]}}
        """,
        head=VALUE,
    )
    assert (told.result.outcome, told.entered("a"), told.entered("b")) == ("success", [], [1.0])


def test_the_guard_of_a_part_is_asked_before_it_begins_and_not_again() -> None:
    """Unlike that of a decorator; where it is closed it says why."""
    tree = """
        sequence:
          - sequence:
              - {state: test.Write, with: {value: 9, after_s: 1}}
              - {state: test.Act, name: a, with: {script: [[1, true]]}}
            guard: {when: "${value < 5}", to: failure}
            name: first
          - sequence: [{state: test.Act, name: b}]
            guard: {when: "${value < 5}", to: failure}
            name: second
    """
    told = run_tree(tree, head=VALUE)
    assert (told.result.outcome, told.entered("a"), told.entered("b")) == ("failure", [1.0], [])
    assert told.why[-1] == "${value < 5} is false"


def test_a_part_that_was_skipped_begins_when_its_guard_opens() -> None:
    """In front of what runs in a composite without memory, where it would be asked at every tick."""
    told = run_tree(
        f"""
        selector:
          memory: false
          children:
            - sequence: [{_act("a", (1, True))}]
              guard: {{when: "${{value == 7}}", to: skipped}}
            - machine:
                initial: write
                states:
                  write: {{state: test.Write, with: {{value: 7, after_s: 1}}, transitions: {{done: wait}}}}
                  wait:
                    state: test.Act
                    with: {{script: [[9, true]], cleanup_s: 1}}
                    transitions: {{yes: done, no: done}}
        """,
        head=VALUE,
    )
    assert (told.result.outcome, told.entered("a")) == ("success", [2.0])


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        ("sequence: [{state: test.Act}]\nguard: {when: '${true}', to: never}", "needs a `to` that is a status"),
        ("guard: {when: '${true}', to: never, child: {state: test.Act}}", "needs a `to` that is a status"),
        ("timeout: {after: 1, to: skipped, child: {state: test.Act}}", "`timeout` with a `child` has no `to`"),
        ("{state: test.Act, timeout: {after: 1, to: skipped}}", "needs a `to` that is a status"),
    ],
)
def test_a_guard_leads_to_a_status(tree: str, message: str) -> None:
    """One of three."""
    with pytest.raises(DocumentError, match=message):
        tree_plan(tree)
