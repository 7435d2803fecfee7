"""Whatever the operator does and when: every clean-up once, no deadlock, always a reported end."""

from __future__ import annotations

import asyncio
import json
from collections import Counter
from collections.abc import Callable
from functools import partial
from typing import Any, ClassVar, cast

import msgspec
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.document import parse_behavior
from engine.errors import ControlError
from engine.event import (
    GatePassed,
    GateReached,
    GoalFinished,
    GoalSent,
    MessageLogged,
    NodeEntered,
    NodeExited,
    OperatorCommanded,
    OutcomeRequested,
    OutcomeWithdrawn,
    RunEnded,
    RunSteppedBack,
    StopRequested,
    UndoEnded,
    UndoStarted,
)
from engine.runtime.control import Breakpoint
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.state import ActivationRecord, Context, Outcome, State
from tests.engine.at_once import at_once
from tests.engine.fake_states import CATALOGUE, Give
from tests.engine.runtime.control.operate import Act, operate
from tests.engine.runtime.control.turntable import Turn, TurnTable, Turntable
from tests.tiers import examples

TIMES = st.sampled_from([0.0, 0.25, 0.5, 1.0, 1.5])
MOMENTS = st.integers(0, 28).map(lambda n: n / 8)
COMPOSITES = ("sequence", "selector", "parallel")
CLEANUP_S = 0.375
BEGUN, DONE = "cleaning up", "cleaned up"
Node = dict[str, Any]


class Tidy(State, frozen=True, kw_only=True):
    """Wait; take a time, and a line in the log, to clean up."""

    state_name: ClassVar[str] = "test.Tidy"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b", "c")
    after_s: float = 1.0

    async def run(self, ctx: Context) -> Outcome:
        try:
            await ctx.clock.sleep(self.after_s)
        except asyncio.CancelledError:
            ctx.log(BEGUN)
            await ctx.clock.sleep(CLEANUP_S)
            ctx.log(DONE)
            raise
        return Outcome("a")

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        await ctx.clock.sleep(CLEANUP_S)


class Lift(TurnTable, frozen=True, kw_only=True):
    """Turn the table, and know how to take that back."""

    state_name: ClassVar[str] = "test.Lift"

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        await ctx.perform(Turn(for_s=self.for_s), to="table")


def _leaf(after_s: float, outcome: str) -> Node:
    return {"state": "test.Give", "with": {"after_s": after_s, "outcome": outcome}}


LEAVES = (
    st.builds(_leaf, TIMES, st.sampled_from("abc"))
    | st.sampled_from(["test.TurnTable", "test.Lift"]).map(
        lambda state: {"state": state, "with": {"for_s": 0.5}, "on_error": "c"}
    )
    | TIMES.map(lambda after_s: {"state": "test.Tidy", "with": {"after_s": after_s}})
)


def _machine(children: list[Node], *, kind: str) -> Node:
    """One child after the other; every way out of the last one is `a`."""
    states: Node = {}
    for index, child in enumerate(children):
        following = f"s{index + 1}" if index + 1 < len(children) else "a"
        outs = ("a", "b", "c", "turned", "failed", "exhausted", "broken", "success", "failure")
        transitions = {out: following for out in outs if out in _outs(child)}
        divert: Node = {"on_error": following} if "on_error" in child else {}
        if "timeout" in child:
            divert["timeout"] = {**child["timeout"], "to": following}
        states[f"s{index}"] = {**child, "transitions": transitions, **divert}
    return {kind: {"initial": "s0", "states": states}}


def _concurrency(children: list[Node]) -> Node:
    states = {f"c{index}": child for index, child in enumerate(children)}
    first = [{"a": {"c0": out}} for out in _outs(children[0])]
    return {"concurrency": {"states": states, "conditions": first, "otherwise": "a"}}


def _partial(children: list[Node]) -> Node:
    """Let the end of the first child end the second one, while the others go on."""
    states = {f"c{index}": child for index, child in enumerate(children)}
    some = [{"preempt": ["c1"], "when": {"c0": out}} for out in _outs(children[0])]
    return {"concurrency": {"states": states, "conditions": some, "otherwise": "a"}}


def _foreach(child: Node) -> Node:
    return {"foreach": {"times": 2, "child": child, "next": [*_outs(child)]}}


def _tree(children: list[Node], kind: str) -> Node:
    """A composite of a behavior tree, in which errors are failures."""
    parts = [{**child, "name": f"t{index}"} for index, child in enumerate(children)]
    return {"tree": {kind: [part | ({"on_error": "failure"} if "on_error" in part else {}) for part in parts]}}


def _measured(child: Node, timeout_s: float, times: int) -> Node:
    """Give a node a timeout, which only a machine can lead on, and a retry."""
    measures: Node = {"timeout": {"after": timeout_s}, **({"retry": {"times": times}} if times else {})}
    return _machine([{**child, **measures}], kind="machine")


def _outs(node: Node) -> tuple[str, ...]:
    if node.get("state") in ("test.TurnTable", "test.Lift"):
        return ("turned", "failed", "c")
    if "state" in node:
        return ("a", "b", "c")
    if "tree" in node:
        return ("success", "failure")
    return ("exhausted", "broken") if "foreach" in node else ("a",)


TREES = st.recursive(
    LEAVES,
    lambda inner: (
        st.lists(inner, min_size=1, max_size=3).map(partial(_machine, kind="machine"))
        | st.lists(inner, min_size=1, max_size=2).map(partial(_machine, kind="priority"))
        | st.lists(inner, min_size=1, max_size=3).map(_concurrency)
        | st.lists(inner, min_size=2, max_size=3).map(_partial)
        | inner.map(_foreach)
        | st.builds(
            _tree, st.lists(inner, min_size=1, max_size=3), st.sampled_from(["sequence", "selector", "parallel"])
        )
        | st.builds(_measured, inner, st.sampled_from([0.25, 1.0, 2.5]), st.integers(0, 2))
    ),
    max_leaves=6,
)


class GiveBack(Give, frozen=True, kw_only=True):
    """End as told, and leave nothing to undo."""

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        ctx.log("nothing to undo")


STATES: dict[str, type[State]] = {
    "test.Tidy": Tidy,
    "test.Lift": Lift,
    "test.Give": GiveBack,
    "test.TurnTable": TurnTable,
}
Order = Callable[[Run, float], object]
ORDERS: list[Order] = [
    lambda run, at: run.control.pause(),
    lambda run, at: run.control.resume(),
    lambda run, at: run.control.step("into"),
    lambda run, at: run.control.step("over"),
    lambda run, at: run.control.step("out"),
    lambda run, at: run.control.lock(_some(run, at)),
    lambda run, at: run.control.unlock(_some(run, at)),
    lambda run, at: run.control.force(_some(run, at), (run.outcomes(_some(run, at)) or ("a",))[0]),
    lambda run, at: run.control.repeat(_some(run, at)),
    lambda run, at: run.control.answer(_some(run, at)),
    lambda run, at: run.control.set_autonomy("off"),
    lambda run, at: run.control.set_autonomy("full"),
    lambda run, at: run.control.attach_operator(),
    lambda run, at: run.control.detach_operator(),
    lambda run, at: run.control.lose_operator(),
    lambda run, at: run.control.set_breakpoints([Breakpoint(path="*", when="after")]),
    lambda run, at: run.control.set_breakpoints([]),
    lambda run, at: run.stop("chance"),
    lambda run, at: run.change(_revised(run, at), preempt=True),
    lambda run, at: (run.control.pause(), run.change(_revised(run, at), preempt=True)),
    lambda run, at: (run.control.pause(), run.change(_revised(run, at))),
    lambda run, at: at_once(run.step_back()),
    lambda run, at: at_once(run.step_back(_some(run, at))),
    lambda run, at: (run.control.pause(), at_once(run.step_back())),
]


def _some(run: Run, at_s: float) -> str:
    """Return one of the nodes that are active or wait, else any."""
    view = run.control.view()
    paths = [*view.active, *(each.path for each in view.waiting)] or list(run.paths())
    return paths[int(at_s * 8) % len(paths)]


def _revised(run: Run, at_s: float) -> Plan:
    """Return the behavior with other classes, and with a branch more or less in each concurrency container."""
    behavior = run.plan.source
    assert behavior is not None
    document = msgspec.json.decode(msgspec.json.encode(behavior.document))
    _revise(document["root"], more=int(at_s * 8) % 2 == 0)
    return new_plan(parse_behavior(json.dumps(document), file="test.yaml"), {**CATALOGUE, **STATES})


REVISED = {"test.Tidy": "test.Give", "test.Lift": "test.TurnTable"}


def _revise(node: Any, *, more: bool) -> None:
    if isinstance(node, list):
        for each in cast("list[Any]", node):
            _revise(each, more=more)
    if not isinstance(node, dict):
        return
    inner = cast("Node", node)
    if isinstance(inner.get("state"), str):
        inner["state"] = REVISED.get(inner["state"], inner["state"])
    if "concurrency" in inner:
        states = inner["concurrency"]["states"]
        # The conditions ask for the first only.
        first = dict([*states.items()][:1])
        inner["concurrency"]["states"] = {**states, "fresh": _leaf(0.25, "a")} if more else first
    for key, each in inner.items():
        if key not in ("with", "fresh"):
            _revise(each, more=more)


def _act(order: Order, at_s: float) -> Act:
    def act(run: Run) -> None:
        try:
            order(run, at_s)
        except ControlError:
            return  # what does not fit the moment is refused, and must change nothing

    return act


def _let_go(run: Run) -> None:
    """Undo whatever holds the run."""
    run.control.set_breakpoints([])
    run.control.detach_operator()
    for path in run.control.view().locks:
        run.control.unlock(path)
    run.control.resume()


@settings(max_examples=examples(40, nightly=300), deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    root=TREES,
    orders=st.lists(st.tuples(MOMENTS, st.sampled_from(range(len(ORDERS)))), max_size=8, unique_by=lambda o: o[0]),
    demanded=st.booleans(),
)
def test_any_commands_at_any_instants(root: Node, orders: list[tuple[float, int]], demanded: bool) -> None:
    document = {
        "flexcell": 1,
        "name": "random",
        "outcomes": ["end"],
        "root": _machine([root], kind="machine"),
    }
    text = json.dumps(_ending(document))
    acts: dict[float, Act] = {at_s: _act(ORDERS[which], at_s) for at_s, which in orders}
    for moment in (100.0, 150.0, 200.0, 250.0):
        acts[moment] = _let_go
    at = RunOptions(autonomy="low", demand_operator=demanded, loss_policy="hold")
    if demanded:
        for moment in range(300, 400):
            acts[float(moment)] = lambda run: run.control.set_autonomy("full")
        acts[401.0] = lambda run: run.stop("it demands an operator and has none")
    told = operate(
        text,
        acts,
        supervision=at,
        prepare=Turntable,
        states=STATES,
    )
    assert told.result.status in {"finished", "stopped", "errored"}
    entered = Counter((e.path, e.visit) for e in told.events if isinstance(e, NodeEntered))
    exited = Counter((e.path, e.visit) for e in told.events if isinstance(e, NodeExited))
    assert entered == exited
    assert set(entered.values()) <= {1}
    assert told.result.status != "stopped" or _count(told.events, StopRequested)
    said = Counter(e.message for e in told.events if isinstance(e, MessageLogged))
    assert said[BEGUN] == said[DONE]
    sent = Counter(e.goal for e in told.events if isinstance(e, GoalSent))
    assert sent == Counter(e.goal for e in told.events if isinstance(e, GoalFinished))
    assert _count(told.events, UndoStarted) == _count(told.events, UndoEnded)
    assert _count(told.events, RunSteppedBack) <= sum(
        e.command == "step_back" for e in told.events if isinstance(e, OperatorCommanded)
    )
    assert _count(told.events, GateReached) >= _count(told.events, GatePassed)
    assert _count(told.events, OutcomeRequested) == _count(told.events, OutcomeWithdrawn)
    assert [e.seq for e in told.events] == list(range(1, len(told.events) + 1))
    assert isinstance(told.events[-1], RunEnded)


def _count(events: tuple[object, ...], kind: type[object]) -> int:
    return sum(isinstance(event, kind) for event in events)


def _ending(document: Node) -> Node:
    for state in document["root"]["machine"]["states"].values():
        state["transitions"] = dict.fromkeys(state["transitions"], "end")
        if "on_error" in state:
            state["on_error"] = "end"
    return document
