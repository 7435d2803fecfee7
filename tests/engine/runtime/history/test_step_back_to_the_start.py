"""Whatever a run has done: taken back step by step there is nothing left of it, and it does the same once more."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from typing import Any, ClassVar

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from engine.bus import SkillBus
from engine.errors import ControlError, SkillFailed
from engine.event import RunSteppedBack
from engine.runtime.run import Run
from engine.skill import Service
from engine.state import ActivationRecord, Context, Outcome, State
from tests.engine.at_once import at_once
from tests.engine.fake_states import WITH_FLOW
from tests.engine.run_document import ObservedRun
from tests.engine.runtime.control.operate import Act, operate, pause, resume
from tests.tiers import examples

Node = dict[str, Any]
KEYS = ("x", "y")
BEGINNING = "the run is at its beginning"
BESIDE = "and the parallel branch "
"""What is said of the other branches where a loop in one of them is in a later round."""
ROUNDS = "completed rounds cannot be undone one by one"


class PutToken(Service[int], frozen=True, kw_only=True):
    """Put a token onto the table."""

    token: str


class TakeToken(Service[int], frozen=True, kw_only=True):
    """Take a token from the table."""

    token: str


class Table:
    """The tokens that lie there."""

    def __init__(self, bus: SkillBus) -> None:
        self.tokens: Counter[str] = Counter()
        bus.advertise_service(PutToken, self.put, namespace="table")
        bus.advertise_service(TakeToken, self.take, namespace="table")

    async def put(self, request: PutToken) -> int:
        self.tokens[request.token] += 1
        return self.tokens[request.token]

    async def take(self, request: TakeToken) -> int:
        if not self.tokens[request.token]:
            raise SkillFailed(f"there is no {request.token} here", where="table")
        self.tokens[request.token] -= 1
        return self.tokens[request.token]


class Put(State, frozen=True, kw_only=True):
    """Put a token that names its path, count it, and take some time before and after."""

    state_name: ClassVar[str] = "test.Put"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b")
    success: ClassVar[tuple[str, ...]] = ("a",)
    outputs: ClassVar[Mapping[str, Any]] = {"count": int}
    before_s: float = 0.0
    after_s: float = 0.0

    async def run(self, ctx: Context, *, count: int = 0) -> Outcome:
        await ctx.clock.sleep(self.before_s)
        await ctx.call(PutToken(token=ctx.path), to="table")
        await ctx.clock.sleep(self.after_s)
        return Outcome("a", {"count": count + 1})

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        await ctx.clock.sleep(0.125)
        for _ in done.requests:
            await ctx.call(TakeToken(token=ctx.path), to="table")


def _leaf(key: str, before_s: float, after_s: float) -> Node:
    given = {"before_s": before_s, "after_s": after_s}
    return {"state": "test.Put", "with": given, "in": {"count": key}, "out": {"count": key}}


def _outs(node: Node) -> tuple[str, ...]:
    if "state" in node:
        return ("a", "b")
    if "tree" in node:
        return ("success", "failure")
    return ("exhausted", "broken") if "foreach" in node else ("a",)


def _machine(children: list[Node], kind: str) -> Node:
    states: Node = {}
    for index, child in enumerate(children):
        following = f"s{index + 1}" if index + 1 < len(children) else "a"
        states[f"s{index}"] = {**child, "transitions": dict.fromkeys(_outs(child), following)}
    return {kind: {"initial": "s0", "states": states}}


def _concurrency(children: list[Node]) -> Node:
    states = {f"c{index}": child for index, child in enumerate(children)}
    return {
        "concurrency": {
            "states": states,
            "conditions": [{"a": {name: _outs(child)[0] for name, child in states.items()}}],
        }
    }


def _tree(children: list[Node]) -> Node:
    leaves = [{**child, "name": f"t{index}"} for index, child in enumerate(children)]
    return {"tree": {"sequence": {"memory": True, "children": leaves}}}


def _foreach(child: Node) -> Node:
    return {"foreach": {"times": 2, "child": child, "next": [*_outs(child)]}}


TIMES = st.sampled_from([0.0, 0.25, 0.5])
LEAVES = st.builds(_leaf, st.sampled_from(KEYS), TIMES, TIMES)
TREES = st.recursive(
    LEAVES,
    lambda inner: (
        st.builds(_machine, st.lists(inner, min_size=1, max_size=3), st.sampled_from(["machine", "priority"]))
        | st.lists(inner, min_size=1, max_size=3).map(_concurrency)
        | st.lists(LEAVES, min_size=1, max_size=3).map(_tree)
        | inner.map(_foreach)
    ),
    max_leaves=6,
)

BESIDE_A_PRIORITY = _concurrency([_leaf("x", 0.0, 0.0), _machine([_leaf("x", 0.0, 0.25)], "priority")])


def _document(children: list[Node]) -> str:
    root = _machine([*children, {"state": "flow.Wait", "with": {"duration_s": 1.0}}], "machine")
    last = root["machine"]["states"][f"s{len(children)}"]
    last["transitions"] = {"done": "end"}
    head = {"flexcell": 1, "name": "back", "outcomes": ["end"], "userdata": dict.fromkeys(KEYS, 0)}
    return json.dumps({**head, "root": root})


def _kind(message: str) -> str:
    return next((kind for kind in (BEGINNING, BESIDE, ROUNDS) if kind in message), message)


class BackAgain:
    """Goes back until nothing is left to take back, looks, and lets the run go on."""

    def __init__(self) -> None:
        self.table: Table | None = None
        self.refusals: list[str] = []
        self.left: list[Mapping[str, int]] = []

    def connect(self, bus: SkillBus) -> None:
        self.table = Table(bus)

    def back(self, run: Run) -> None:
        try:
            at_once(run.step_back())
        except ControlError as error:
            self.refusals.append(error.message)

    def look(self, run: Run) -> None:
        assert self.table is not None
        self.left.append(+self.table.tokens)

    def run(self, text: str, acts: Mapping[float, Act]) -> ObservedRun:
        return operate(text, acts, prepare=self.connect, states={**WITH_FLOW, "test.Put": Put})


@settings(max_examples=examples(30, nightly=240), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@example(children=[BESIDE_A_PRIORITY], paused_s=0.125).via("what is undone is not held by the priority beside it")
@given(children=st.lists(TREES, min_size=1, max_size=2), paused_s=st.integers(0, 16).map(lambda n: n / 8))
def test_going_back_to_the_beginning_leaves_nothing_and_going_on_does_the_same(
    children: list[Node], paused_s: float
) -> None:
    text = _document(children)
    plain = BackAgain()
    due = plain.run(text, {})
    again = BackAgain()
    acts: dict[float, Act] = {paused_s: pause}
    acts |= {100.0 + 10.0 * number: again.back for number in range(40)}
    told = again.run(text, {**acts, 600.0: again.look, 601.0: resume})
    if due.result.duration_s <= paused_s:
        return
    assert {_kind(message) for message in again.refusals} <= {BEGINNING, BESIDE, ROUNDS}
    assert told.result.status == due.result.status == "finished"
    assert told.result.userdata == due.result.userdata
    assert again.table is not None
    assert plain.table is not None
    assert +again.table.tokens == +plain.table.tokens
    assert all(event.cause is None for event in told.events if isinstance(event, RunSteppedBack))
    if set(map(_kind, again.refusals)) <= {BEGINNING}:
        assert again.left == [Counter()]
