"""A disabled node is passed over: by a named outcome, and inside a tree as if it were not there."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from typing import Any, cast

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from engine.errors import DocumentError
from engine.event import Event, NodeEntered, NodeExited, NodeSkipped, StatusChanged, TransitionTaken
from engine.runtime.history import RunReducer
from tests.engine.check.data_runs import events_of
from tests.engine.check.random_behaviors import Plain, behaviors
from tests.engine.run_document import ObservedRun, plan_of, run_document
from tests.tiers import examples

SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.large_base_example, HealthCheck.filter_too_much]
MACHINE = """
    root:
      machine:
        initial: one
        states:
          one: {state: test.Give, transitions: {a: two, b: bad, c: bad}}
          two: <two>
          three: {state: test.Give, with: {after_s: 1}, transitions: {a: good, b: bad, c: bad}}
"""
HANGING = "{state: test.Hang, disabled: never, guard: {when: '${1 < 0}', to: bad}, transitions: {never: three}}"


def line_of(event: Event) -> str:
    """Return an event in short."""
    match event:
        case NodeEntered():
            return f"+{event.path}"
        case NodeExited():
            return f"-{event.path} {event.outcome}"
        case NodeSkipped():
            return f"~{event.path} {event.outcome}"
        case TransitionTaken():
            return f"{event.source} {event.outcome} {event.target}"
        case StatusChanged():
            return f"{event.path} {event.status}"
        case _:
            return ""


def course(run: ObservedRun) -> list[str]:
    """Return what happened inside the root, in short."""
    return [line for line in map(line_of, run.events) if line and line != "+root"]


def test_a_machine_passes_a_disabled_state_by_its_outcome() -> None:
    """Its guard is not asked, and it is not entered."""
    assert course(run_document(MACHINE.replace("<two>", HANGING)))[3:7] == [
        "~root/two never",
        "two never three",
        "+root/three",
        "-root/three a",
    ]


@pytest.mark.parametrize(
    "disabled",
    [
        "{state: nowhere.NoSuchState, disabled: done, transitions: {done: three}}",
        "{state: test.Give, disabled: a, with: {outcome: '${no_such_key}'}, transitions: {a: three, b: bad}}",
        "{machine: {initial: x, states: {x: {state: no.Such}}}, disabled: done, transitions: {done: three}}",
        "{state: test.Give, disabled: a, timeout: {after: 1 s, to: bad}, autonomy: {a: full}, transitions: {a: three}}",
    ],
)
def test_nothing_of_a_disabled_node_is_loaded_or_evaluated(disabled: str) -> None:
    """So what does not work yet, or not in this cell, can be disabled."""
    assert run_document(MACHINE.replace("<two>", disabled)).result.outcome == "good"


def test_a_disabled_initial_state_is_passed_too() -> None:
    """And several in a row."""
    run = run_document(MACHINE.replace("Give, transitions", "Give, disabled: a, transitions").replace("<two>", HANGING))
    assert course(run)[:3] == ["~root/one a", "one a two", "~root/two never"]
    assert run.result.outcome == "good"


def test_a_disabled_branch_has_ended_with_its_outcome() -> None:
    """The conditions of a concurrency container hold as if it had run."""
    run = run_document("""
        root:
          concurrency:
            states:
              left: {state: test.Give, with: {after_s: 2}}
              right: {state: test.Hang, disabled: never}
            conditions: [{good: {left: a, right: never}}]
    """)
    assert (run.result.outcome, run.events[-1].time_s) == ("good", 2.0)


def test_a_disabled_alternative_is_not_counted_in_the_cause() -> None:
    """One that is left is no list of alternatives."""
    run = run_document("""
        root:
          tree:
            selector:
            - {state: test.Give, disabled: true}
            - {state: test.Give, with: {outcome: c}}
    """)
    cause = run.result.cause
    assert cause is not None
    assert [link.message for link in cause.chain() if "alternatives" in link.message] == []


def test_a_disabled_child_of_a_foreach_passes_every_round() -> None:
    """Nothing but the rounds happens."""
    run = run_document("""
        root:
          machine:
            initial: each
            states:
              each:
                foreach: {times: 2, child: {state: test.Give, disabled: a}}
                transitions: {exhausted: good, broken: bad}
    """)
    assert [line for line in course(run) if line.startswith("~")] == ["~root/each/child a"] * 2


@pytest.mark.parametrize(
    ("tree", "outcome", "entered"),
    [
        ("sequence: [<off>, <a>]", "good", ["a"]),
        ("selector: [<off>, <c>]", "bad", ["c"]),
        ("parallel: [<a>, <off>]", "good", ["a"]),
        ("parallel: {policy: one, children: [<c>, <off>]}", "bad", ["c"]),
        ("sequence: {memory: false, children: [<off>, <a>, <off>]}", "good", ["a"]),
        ("sequence: [{inverter: {child: <a>}, disabled: true}, <a>]", "good", ["a"]),
        ("selector: [{inverter: {child: <off>}}, <c>]", "bad", ["c"]),
        ("sequence: [{sequence: [<off>, <off>]}, <a>]", "good", ["a"]),
        ("sequence: [{retry: {times: 3, child: <c>}, disabled: true}, <a>]", "good", ["a"]),
        ("if_then_else: {if: <off>, then: <c>, else: <a>}", "good", ["a"]),
        ("if_then_else: {if: <a>, then: <off>}", "good", ["a"]),
        ("sequence: [<a>], disabled: true", "good", []),
    ],
)
def test_a_tree_leaves_out_what_is_disabled(tree: str, outcome: str, entered: list[str]) -> None:
    """As it passes over what is skipped; a tree without anything to do succeeds."""
    leaves = {
        "<a>": "{state: test.Give, name: a, with: {after_s: 1}}",
        "<c>": "{state: test.Give, name: c, with: {outcome: c, after_s: 1}}",
        "<off>": "{state: no.Such, name: off, disabled: true}",
    }
    for mark, leaf in leaves.items():
        tree = tree.replace(mark, leaf)
    run = run_document(f"""
        root:
          machine:
            initial: t
            states:
              t: {{tree: {{{tree}}}, transitions: {{success: good, failure: bad}}}}
    """)
    names = [each.path.rpartition("/")[2] for each in run.events if isinstance(each, NodeEntered)]
    assert (run.result.outcome, [name for name in names if name in "ac"]) == (outcome, entered)


def test_the_page_shows_what_was_skipped() -> None:
    """The state of the run has a word for it, in machines and trees."""
    run = run_document("""
        root:
          machine:
            initial: one
            states:
              one: {state: test.Give, disabled: a, transitions: {a: two}}
              two: {tree: {sequence: [{state: test.Give, disabled: true}]}, transitions: {success: good, failure: bad}}
    """)
    reducer = RunReducer("r")
    for event in run.events:
        reducer.apply(event)
    nodes = reducer.state.nodes
    assert (nodes["root/one"].status, nodes["root/one"].outcome, nodes["root/one"].visits) == ("skipped", "a", 0)
    assert nodes["root/two/sequence"].status == "skipped"


@pytest.mark.parametrize(
    ("node", "message"),
    [
        ("{state: test.Give, disabled: true, transitions: {a: three}}", "a disabled node needs an outcome"),
        ("{tree: {sequence: [{state: test.Give, disabled: a}]}}", "a disabled part of a tree has no outcome"),
    ],
)
def test_how_a_node_is_disabled_depends_on_what_is_around_it(node: str, message: str) -> None:
    """An outcome leads on in a machine; in a tree the parent does."""
    with pytest.raises(DocumentError, match=message):
        plan_of(MACHINE.replace("<two>", node))


def test_the_root_cannot_be_disabled() -> None:
    """Nothing would be left."""
    with pytest.raises(DocumentError, match="the root cannot be disabled"):
        plan_of("root: {state: test.Give, disabled: a}")


def test_a_node_that_is_enabled_in_words_is_enabled() -> None:
    """`disabled: false` changes nothing."""
    enabled = "{state: test.Give, disabled: false, transitions: {a: three, b: bad, c: bad}}"
    assert "+root/two" in course(run_document(MACHINE.replace("<two>", enabled)))


@given(behaviors(safe=True), st.data())
@settings(max_examples=examples(40, nightly=400), deadline=None, suppress_health_check=SLOW)
def test_a_tree_runs_like_the_one_without_what_is_disabled(document: Plain, data: st.DataObject) -> None:
    """Every node is entered and left at the same time, with the same outcome."""
    off, without = deepcopy(document), deepcopy(document)
    found = [*_groups(off["root"], in_tree=False)]
    assume(found)
    for kept, cut in zip(found, [*_groups(without["root"], in_tree=False)], strict=True):
        for number, child in enumerate(kept):
            child["name"] = cut[number]["name"] = f"n{number}"
        chosen = data.draw(st.sets(st.integers(0, len(kept) - 1), max_size=len(kept) - 1))
        for number in chosen:
            kept[number]["disabled"] = True
        cut[:] = [child for number, child in enumerate(cut) if number not in chosen]
    assume(off != document)
    for seed in range(2):
        run_off, run_without = (
            [each for each in events_of(one, seed) if isinstance(each, NodeEntered | NodeExited)]
            for one in (off, without)
        )
        assert [_without_number(each) for each in run_off] == [_without_number(each) for each in run_without]


def _groups(node: Plain, *, in_tree: bool) -> Iterator[list[Plain]]:
    """Yield the lists of children of sequences, selectors and parallels, outer ones first."""
    for kind, given_body in node.items():
        body: Any = given_body
        if in_tree and kind in ("sequence", "selector", "parallel"):
            yield body["children"]
        if isinstance(body, dict):
            held = cast("Plain", body)
            inside: list[Plain] = [*held.get("states", {}).values(), *held.get("children", ())]
            inside += [held[key] for key in ("child", "if", "then", "else", "while", "do") if key in held]
            parts = in_tree and kind not in ("machine", "priority", "concurrency", "foreach")
            for child in [held] if kind == "tree" else inside:
                yield from _groups(child, in_tree=kind == "tree" or parts)


def _without_number(event: Event) -> Event:
    return replace(event, seq=0)
