"""Whatever a behavior does and whatever is done to it, its recording replays the same, event by event.

What was in flight when its state was told to stop leaves no event, and yet it may decide in which
turn of the loop the state hears of it. So in these runs either nothing is told to stop, and
everything comes together on a coarse grid of times; or it is, and the device's times lie off the
grid of the behavior's.
"""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import msgspec
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import ControlError
from engine.event import Event
from engine.replay import replay
from engine.replay.plain_event import plain_event
from engine.runtime.control import Breakpoint
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from tests.engine.at_once import at_once
from tests.engine.replay.rig import CATALOGUE, Act, recorded
from tests.tiers import examples

GRID = st.integers(0, 12).map(lambda n: n / 8)
OFF_GRID = st.integers(0, 2047).map(lambda n: (2 * n + 1) / 4096)
HOW = st.sampled_from(["done", "done", "fail", "reject", "crash"])
Node = dict[str, object]
OUTS = ("a", "b", "c")


def _leaf(state: str, **given: object) -> Node:
    return {"state": state, "with": given, "on_error": "c"}


def _leaves(device_s: st.SearchStrategy[float], turns: st.SearchStrategy[int]) -> st.SearchStrategy[Node]:
    """States whose device takes such times, and whose services take so many turns of the loop."""
    work = partial(_leaf, "bench.Work")
    look = partial(_leaf, "bench.Look")
    return (
        st.builds(partial(_leaf, "test.Give"), after_s=GRID, outcome=st.sampled_from(OUTS))
        | st.builds(work, for_s=device_s, rest_s=device_s, how=HOW, to=st.sampled_from(["bench", "nobody"]))
        | st.builds(look, delay_s=st.just(0.0) | device_s, turns=turns, how=HOW, times=st.integers(1, 3))
        | st.builds(partial(_leaf, "bench.Listen"), messages=st.integers(0, 3))
    )


def _limited(node: Node, after_s: float, retries: int) -> Node:
    timeout: Node = {"timeout": {"after": after_s, "to": "b"}} if after_s else {}
    again: Node = {"retry": {"times": retries, "backoff": 0.125, "outcomes": ["c"]}} if retries else {}
    return {**node, **timeout, **again}


def _passed_over(node: Node) -> Node:
    return {**node, "disabled": _outs(node)[0]}


def _machine(children: list[Node], *, kind: str) -> Node:
    """One child after the other; every way out of the last one is `a`."""
    states: Node = {}
    for index, child in enumerate(children):
        following = f"s{index + 1}" if index + 1 < len(children) else "a"
        diverted: Node = {"timeout": {"after": _timeout_s(child), "to": following}} if "timeout" in child else {}
        transitions = dict.fromkeys(_outs(child), following)
        states[f"s{index}"] = {**child, **diverted, "transitions": transitions, "on_error": following}
    return {kind: {"initial": "s0", "states": states}}


def _timeout_s(node: Node) -> float:
    return msgspec.convert(node["timeout"], dict[str, Any])["after"]


def _first(children: list[Node]) -> Node:
    """All at once; the first one to end ends the others."""
    states = {f"c{index}": child for index, child in enumerate(children)}
    conditions = [{"a": {"c0": out}} for out in _outs(children[0])]
    return {"concurrency": {"states": states, "conditions": conditions, "otherwise": "a"}}


def _some(children: list[Node]) -> Node:
    """All at once; the first one to end ends the second."""
    states = {f"c{index}": child for index, child in enumerate(children)}
    conditions = [{"preempt": ["c1"], "when": {"c0": out}} for out in _outs(children[0])] if len(children) > 1 else []
    return {"concurrency": {"states": states, "conditions": conditions, "otherwise": "a"}}


def _all(children: list[Node]) -> Node:
    """All at once; over when all are."""
    states = {f"c{index}": child for index, child in enumerate(children)}
    never = [{"a": {name: "never" if "state" in child else _outs(child)[0] for name, child in states.items()}}]
    return {"concurrency": {"states": states, "conditions": never, "otherwise": "a"}}


def _foreach(child: Node) -> Node:
    return {"foreach": {"times": 2, "child": child, "next": [*_outs(child)]}}


def _outs(node: Node) -> tuple[str, ...]:
    if "state" in node:
        return OUTS
    return ("exhausted", "broken") if "foreach" in node else ("a",)


def _trees(
    leaves: st.SearchStrategy[Node], concurrency: Callable[[list[Node]], Node], *, priority: bool
) -> st.SearchStrategy[Node]:
    kinds = ["machine", "priority"] if priority else ["machine"]
    return st.recursive(
        leaves,
        lambda inner: (
            st.builds(_machine, st.lists(inner, min_size=1, max_size=3), kind=st.sampled_from(kinds))
            | st.lists(inner, min_size=1, max_size=3).map(concurrency)
            | inner.map(_foreach)
            | inner.map(_passed_over)
        ),
        max_leaves=6,
    )


UNDISTURBED = _trees(_leaves(GRID, st.integers(0, 4)), _all, priority=False)
DISTURBED = _trees(
    st.builds(_limited, _leaves(OFF_GRID, st.just(0)), st.just(0.0) | GRID, st.integers(0, 1)), _first, priority=True
)
PARTLY_PREEMPTED = _trees(
    st.builds(_limited, _leaves(OFF_GRID, st.just(0)), st.just(0.0) | GRID, st.integers(0, 1)), _some, priority=True
)


def _document(tree: Node) -> str:
    only: Node = {**tree, "on_error": "bad", "transitions": dict.fromkeys(_outs(tree), "good")}
    only.pop("timeout", None)
    root: Node = {"machine": {"initial": "only", "states": {"only": only}}}
    head: Node = {"flexcell": 1, "name": "random", "outcomes": ["good", "bad"], "success": ["good"]}
    return json.dumps({**head, "root": root})


def _careful(act: Act) -> Act:
    def do(run: Run) -> None:
        try:
            act(run)
        except ControlError:
            return  # the run was not there; the operator is told and nothing happens

    return do


ACTS: list[Act] = [
    lambda run: run.stop("enough"),
    lambda run: run.control.pause(),
    lambda run: run.control.resume(),
    lambda run: run.control.step(),
    lambda run: run.control.lock("root/only", "look first"),
    lambda run: run.control.unlock("root/only"),
    lambda run: run.control.set_breakpoints([Breakpoint(path="*/s1"), Breakpoint(path="*/c1", when="after")]),
    lambda run: run.control.attach_operator(),
    lambda run: run.control.lose_operator(),
    lambda run: (run.control.pause(), run.control.resume()),
    lambda run: at_once(run.step_back()),
    lambda run: (run.control.pause(), at_once(run.step_back())),
]
PLANS = st.dictionaries(st.integers(0, 24).map(lambda n: n / 8), st.sampled_from(ACTS).map(_careful), max_size=4)
OVER: dict[float, Act] = {50.0: _careful(lambda run: run.stop("over"))}
"""Whatever is held must go on, or nothing would ever happen again."""
SUPERVISIONS = st.builds(
    RunOptions,
    start_paused=st.booleans(),
    loss_policy=st.sampled_from(["hold", "continue", "stop"]),
    loss_timeout_s=st.sampled_from([0.5, 5.0]),
)


def _same(text: str, **options: object) -> None:
    with tempfile.TemporaryDirectory() as folder:
        recording = recorded(text, Path(folder) / "run.mcap", **options)
        report = replay(recording, CATALOGUE)
    assert report.difference is None, report.difference.explained()
    assert [_comparable(event) for event in report.events] == [_comparable(each.event) for each in recording.events]


def _comparable(event: Event) -> tuple[int, float, dict[str, object]]:
    return event.seq, event.time_s, plain_event(event)


@settings(max_examples=examples(30, nightly=240), deadline=None)
@given(tree=UNDISTURBED, seed=st.integers(0, 9))
def test_a_run_in_which_much_comes_at_once_replays_the_same(tree: Node, seed: int) -> None:
    _same(_document(tree), seed=seed)


@settings(max_examples=examples(30, nightly=240), deadline=None)
@given(tree=DISTURBED, acts=PLANS, seed=st.integers(0, 9))
def test_a_run_that_was_stopped_paused_and_stepped_replays_the_same(
    tree: Node, acts: dict[float, Act], seed: int
) -> None:
    _same(_document(tree), acts={**acts, **OVER}, seed=seed)


@settings(max_examples=examples(20, nightly=160), deadline=None)
@given(tree=DISTURBED, acts=PLANS, supervision=SUPERVISIONS)
def test_a_run_under_supervision_replays_the_same(tree: Node, acts: dict[float, Act], supervision: RunOptions) -> None:
    _same(_document(tree), acts={**acts, **OVER}, supervision=supervision)


@settings(max_examples=examples(30, nightly=240), deadline=None)
@given(tree=PARTLY_PREEMPTED, acts=PLANS, seed=st.integers(0, 9))
def test_a_run_in_which_conditions_preempt_some_branches_replays_the_same(
    tree: Node, acts: dict[float, Act], seed: int
) -> None:
    _same(_document(tree), acts={**acts, **OVER}, seed=seed)
