"""What a tree halts is preempted once, its clean-up awaited before anything that moves begins."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st

from engine.event import MessageLogged, NodeEntered, NodeExited
from engine.journal import encode_event_log
from tests.engine.runtime.tree.run_tree import ObservedRun, run_tree
from tests.engine.runtime.tree.specimen import SLOTS, Specimen, specimens
from tests.tiers import examples

stops = st.none() | st.sampled_from([0.0, 0.5, 0.75, 1.0, 2.5])


def _with(document: dict[str, Any], more: dict[str, Any]) -> dict[str, Any]:
    """Give every leaf of a document more parameters."""
    if "state" in document:
        own = more if document["state"] == "test.Act" else {key: more[key] for key in more if key != "robot"}
        return {**document, "with": {**document["with"], **own}}
    kind = next(key for key in document if key != "name")
    inner = document[kind]
    if "child" in inner:
        return {**document, kind: {**inner, "child": _with(inner["child"], more)}}
    if kind in SLOTS:
        return {**document, kind: {key: _with(child, more) for key, child in inner.items()}}
    return {**document, kind: {**inner, "children": [_with(child, more) for child in inner["children"]]}}


def _run(specimen: Specimen, stop_at_s: float | None, **more: object) -> ObservedRun:
    document = _with(specimen.document(), dict(more))
    return run_tree(json.dumps(document), stop_at_s=8.0 if stop_at_s is None else stop_at_s, instant_limit=100)


def _without_parallels(specimen: Specimen) -> Specimen:
    children = tuple(_without_parallels(child) for child in specimen.children)
    if specimen.kind == "while_do_else":
        # Its condition is asked beside what it runs, so it is none that commands.
        return replace(specimen, children=(_only_checks(children[0]), *children[1:]))
    if specimen.kind == "parallel":
        return replace(specimen, kind="sequence", children=children, arguments={"memory": False})
    return replace(specimen, children=children)


def _only_checks(specimen: Specimen) -> Specimen:
    leaf = replace(specimen.leaf, commands=False) if specimen.leaf is not None else None
    return replace(specimen, leaf=leaf, children=tuple(map(_only_checks, specimen.children)))


@given(specimen=specimens, stop_at_s=stops, cleanup_s=st.sampled_from([0.0, 0.25, 0.5, 3.0]))
@settings(max_examples=examples(25, nightly=300), deadline=None)
def test_every_leaf_that_was_entered_is_left_once(
    specimen: Specimen, stop_at_s: float | None, cleanup_s: float
) -> None:
    """And cleans up once when it was preempted, whatever the times are; nothing is left behind."""
    told = _run(specimen, stop_at_s, cleanup_s=cleanup_s)
    entered = [(event.path, event.visit) for event in told.events if isinstance(event, NodeEntered)]
    left = [(event.path, event.visit) for event in told.events if isinstance(event, NodeExited)]
    assert sorted(entered) == sorted(left)
    assert len(set(entered)) == len(entered)
    preempted = Counter(e.path for e in told.events if isinstance(e, NodeExited) and e.preempted and e.path != "root")
    clean = Counter(e.path for e in told.events if isinstance(e, MessageLogged) and e.message == "clean")
    assert clean <= preempted
    assert told.result.status != "errored" or "without waiting" in told.why[0]


@given(specimen=specimens, stop_at_s=stops, cleanup_s=st.sampled_from([0.0, 0.25, 3.0]))
@settings(max_examples=examples(25, nightly=300), deadline=None)
def test_without_a_parallel_one_device_is_never_commanded_twice(
    specimen: Specimen, stop_at_s: float | None, cleanup_s: float
) -> None:
    """The next leaf begins when the one before has cleaned up: its lease is never refused."""
    told = _run(_without_parallels(specimen), stop_at_s, cleanup_s=cleanup_s, robot="arm")
    assert told.result.status != "errored" or "without waiting" in told.why[0]


@given(specimen=specimens, stop_at_s=stops, cleanup_s=st.sampled_from([0.0, 0.25]))
@settings(max_examples=examples(15, nightly=100), deadline=None)
def test_twice_the_same_tree_gives_the_same_bytes(
    specimen: Specimen, stop_at_s: float | None, cleanup_s: float
) -> None:
    """Also when ends, timers and stops coincide."""
    first, second = (_run(specimen, stop_at_s, cleanup_s=cleanup_s) for _ in range(2))
    assert encode_event_log(first.events) == encode_event_log(second.events)


def test_a_stop_preempts_all_leaves_in_document_order() -> None:
    """The tree ends when the slowest has cleaned up."""
    told = run_tree(
        """
        parallel:
          - {state: test.Hang, name: a, with: {cleanup_s: 2}}
          - sequence: [{state: test.Check}, {state: test.Hang, name: b, with: {cleanup_s: 2}}]
          - {state: test.Hang, name: c, with: {cleanup_s: 1}}
        """,
        stop_at_s=1.0,
    )
    assert told.lines[5:] == [
        "2 !parallel/c cleaned up", "2 -parallel/c preempted",
        "3 !parallel/a cleaned up", "3 -parallel/a preempted",
        "3 !parallel/sequence/b cleaned up", "3 -parallel/sequence/b preempted",
    ]  # fmt: skip
    assert told.result.status == "stopped"
    assert told.statuses[-2:] == ["1 parallel/sequence invalid", "1 parallel invalid"]


def test_a_leaf_that_commands_a_device_and_is_halted_in_the_same_tick_never_begins() -> None:
    """`running: failure` gives it no time at all."""
    told = run_tree("remap: {running: failure, child: {state: test.Act}}")
    assert (told.lines, told.why[1:]) == ([], ["RUNNING counts as FAILURE"])


def test_a_check_under_the_same_decorator_has_this_instant() -> None:
    """It commands nothing, so it may be tried."""
    told = run_tree("remap: {running: failure, child: {state: test.Check}}")
    assert told.result.outcome == "success"
    told = run_tree("remap: {running: failure, child: {state: test.Check, with: {script: [[1, true]]}}}")
    assert told.lines == ["0 +remap/Check", "0 !remap/Check clean", "0 -remap/Check preempted"]


def test_a_clean_up_that_fails_is_an_error_of_the_tree() -> None:
    """The tree had decided otherwise; what went wrong while stopping is not lost."""
    told = run_tree(
        "parallel: {policy: one, children: [{state: test.Act, with: {script: [[1, true]]}}, {state: test.Messy}]}"
    )
    assert told.result.status == "errored"
    assert "test.Messy raised ZeroDivisionError: in the clean-up" in told.why[0]
