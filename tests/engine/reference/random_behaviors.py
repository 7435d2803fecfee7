"""Random behaviors in which things happen at the same instants, end in all ways, and are stopped at any time."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from engine.authoring import (
    Guard,
    Param,
    Preempt,
    Retry,
    Step,
    Timeout,
    behavior,
    concurrency,
    expr,
    foreach,
    machine,
    parameter,
    reference,
    state,
    to_yaml,
)
from engine.document import Behavior
from engine.document.nodes.node_spec import shared_keys
from tests.engine.reference.act import Act

KEYS = st.sampled_from(["n", "n", "m", "n", "m", "xs"])
TIMES = st.sampled_from([0.0, 0.0, 1.0, 1.0, 2.0, 3.0, 30.0])
CONDITIONS = st.sampled_from(["n < 2", "n > 0", "n < 9", "m == 1", "true", "false", "n", "limit == 1"])
DEPTH = 3
OUTS = ("x", "y")
ACT_OUTCOMES = ("a", "b", "c")
LATE = st.sampled_from(["a", "b", "x", "late"])
USERDATA = st.dictionaries(st.sampled_from(["n", "m"]), st.integers(0, 2), max_size=2)
STOPS = st.sampled_from([0.05, 0.5, 1.05, 2.05, 3.05, 5.05, 12.05, 12.05, 12.05])
"""Never the instant of anything else; late enough for most."""
_KINDS = ("concurrency", "machine", "foreach", "concurrency", "reference", "machine", "state")
Drawn = dict[str, Any]


@st.composite
def _acts(draw: st.DrawFn, keys: Drawn) -> Step:
    act = Act(
        after_s=draw(TIMES),
        ends=draw(st.sampled_from(["a", "a", "a", "a", "a", "b", "b", "c", "raise"])),
        add=draw(st.sampled_from([1, 2, 0])),
        cleanup_s=draw(st.sampled_from([0.0, 0.0, 0.0, 1.0, 2.0])),
        when_preempted=draw(st.sampled_from(["rest", "rest", "rest", "refuse", "raise"])),
    )
    inputs = {"seen": draw(KEYS)}
    outputs = {"sum": draw(KEYS)} if draw(st.integers(0, 3)) else {}
    return state(act, inputs=inputs, outputs=outputs, **keys)


@st.composite
def _keys(draw: st.DrawFn, targets: st.SearchStrategy[str], outcomes: tuple[str, ...]) -> Drawn:
    """Draw guard, timeout, retry and on_error, each now and then."""
    keys: Drawn = {}
    chance = st.integers(0, 5)
    if draw(chance) == 5:
        keys["guard"] = Guard(when=expr(draw(CONDITIONS)), to=draw(targets))
    if draw(chance) >= 4:
        keys["timeout"] = Timeout(after=draw(st.sampled_from([1.0, 2.0, 3.0])), to=draw(targets))
    if draw(chance) == 5:
        again = tuple(draw(st.lists(st.sampled_from(outcomes), max_size=2, unique=True)))
        backoff = draw(st.sampled_from([0.0, 1.0]))
        keys["retry"] = Retry(
            times=draw(st.integers(1, 2)), backoff=backoff, outcomes=again, errors=draw(st.booleans())
        )
    if draw(chance) == 5:
        keys["on_error"] = draw(targets)
    return keys


@st.composite
def _steps(
    draw: st.DrawFn, depth: int, targets: st.SearchStrategy[str], *, wired: bool = False, root: bool = False
) -> Step:
    """Draw a step whose guard, timeout and on_error lead to `targets`, and in a machine its outcomes as well.

    Now and then it is disabled, unless it is the root of a behavior.
    """
    kind = draw(st.sampled_from(_KINDS[:-1] if depth == DEPTH else _KINDS)) if depth else "state"
    outcomes = {"state": ACT_OUTCOMES, "foreach": ("exhausted", "broken")}.get(kind, OUTS)
    keys = draw(_keys(targets, outcomes))
    if not root and draw(st.integers(0, 9)) == 9:
        keys["disabled"] = draw(st.sampled_from(outcomes))
    if wired:
        keys["transitions"] = {
            outcome: draw(targets) for outcome in (*outcomes, "late") if draw(st.integers(0, 20)) or outcome in "ax"
        }
    match kind:
        case "state":
            return draw(_acts(keys))
        case "machine":
            return draw(_machines(depth, keys))
        case "concurrency":
            return draw(_concurrencies(depth, keys))
        case "foreach":
            return draw(_rounds(depth, keys))
        case _:
            return draw(_references(depth, keys))


@st.composite
def _machines(draw: st.DrawFn, depth: int, keys: Drawn) -> Step:
    names = [f"s{index}" for index in range(draw(st.sampled_from([2, 3, 2, 1])))]
    states: dict[str, Step] = {}
    for index, name in enumerate(names):
        # Mostly onward, or most behaviors would go round in circles.
        targets = st.sampled_from([*names[index + 1 :] * 3, *OUTS, draw(st.sampled_from(names))])
        states[name] = draw(_steps(depth - 1, targets, wired=True))
    return machine(initial=names[0], states=states, userdata=draw(USERDATA), **keys)


@st.composite
def _concurrencies(draw: st.DrawFn, depth: int, keys: Drawn) -> Step:
    names = ["p", "q", "r"][: draw(st.sampled_from([2, 3, 2, 1]))]
    states = {name: draw(_steps(depth - 1, LATE)) for name in names}
    due = st.sampled_from(["a", "a", "b", "x", "y", "late", "exhausted"])
    whens = st.dictionaries(st.sampled_from(names), due, min_size=1, max_size=2)
    rules: list[tuple[str, Drawn] | Preempt] = []
    for outcome, when in draw(st.lists(st.tuples(st.sampled_from(OUTS), whens), max_size=4)):
        counted = {**when, **({"at_least": draw(st.integers(1, len(when)))} if draw(st.booleans()) else {})}
        rules.append((outcome, counted) if draw(st.booleans()) else Preempt(draw(_some(names)), counted))
    return concurrency(
        states=states,
        conditions=rules,
        otherwise=draw(st.sampled_from(["x", "y", "y", None])),
        shared=draw(st.sampled_from([None, None, ["n"], ["n", "m"], ["xs"]])),
        userdata=draw(USERDATA),
        **keys,
    )


@st.composite
def _preempting(draw: st.DrawFn) -> Step:
    """Draw branches of which conditions preempt some, mostly with others left that go on."""
    first, *others = names = ["p", "q", "r"]
    # The first ends when others may still be at work, and mostly as some condition asks.
    starter = state(
        Act(after_s=draw(st.sampled_from([0.0, 1.0, 1.0, 2.0])), ends=draw(st.sampled_from(["a", "a", "a", "b"])))
    )
    states = {first: starter, **{name: draw(_steps(draw(st.integers(0, 2)), LATE)) for name in others}}
    entries: list[tuple[str, Drawn] | Preempt] = [Preempt(draw(_some(others)), {first: "a"})]
    for _ in range(draw(st.integers(0, 3))):
        when: Drawn = {name: draw(st.sampled_from("aaabxy")) for name in draw(_some(names))}
        count = {"at_least": draw(st.integers(1, len(when)))} if draw(st.booleans()) else {}
        preempts = draw(st.booleans())
        entries.append(
            Preempt(draw(_some(names)), when | count) if preempts else (draw(st.sampled_from(OUTS)), when | count)
        )
    return concurrency(
        states=dict(draw(st.permutations(list(states.items())))),
        conditions=draw(st.permutations(entries)),
        otherwise=draw(st.sampled_from(["x", "y", "y", None])),
        shared=draw(st.sampled_from([None, None, None, ["n"]])),
        userdata=draw(USERDATA),
    )


def _some(names: list[str]) -> st.SearchStrategy[list[str]]:
    return st.lists(st.sampled_from(names), min_size=1, max_size=2, unique=True)


@st.composite
def _rounds(draw: st.DrawFn, depth: int, keys: Drawn) -> Step:
    amount: Drawn = draw(
        st.sampled_from([{"times": 2}, {"items": [1, 0]}, {"times": 0}, {"times": expr("n")}, {"items": expr("xs")}])
    )
    child = draw(_steps(depth - 1, LATE))
    nominal = ["a", "x", "late", "exhausted"]
    return foreach(
        child,
        **amount,
        item=draw(KEYS),
        index=draw(st.none() | st.just("i")),
        next=None if "state" in child.keys and draw(st.booleans()) else nominal,
        collect={draw(KEYS): draw(st.sampled_from(["all", "xs", "n"]))} if draw(st.booleans()) else None,
        userdata=draw(USERDATA),
        **keys,
    )


@st.composite
def _references(draw: st.DrawFn, depth: int, keys: Drawn) -> Step:
    limit = parameter("limit", int, default=1, maximum=2)
    inner = _named_by_meaning([limit], {"k": 0, **draw(USERDATA)}, draw(_steps(depth - 1, LATE, root=True)))
    given = draw(st.sampled_from([{}, {"limit": 2}, {"limit": expr("n")}, {"limit": expr("n + 5")}]))
    inputs = {"n": draw(KEYS)} if draw(st.booleans()) else {}
    outputs = {draw(st.sampled_from(["k", "n", "sum"])): draw(KEYS)} if draw(st.booleans()) else {}
    return reference(inner, parameters=given, inputs=inputs, outputs=outputs, **keys)


def _named_by_meaning(parameters: list[Param[int]], userdata: dict[str, int], root: Step) -> Behavior:
    """Make a behavior whose file is another one for each that means something else."""
    outcomes = [*OUTS, *ACT_OUTCOMES, "late", "exhausted", "broken"]
    draft = behavior("inner", outcomes=outcomes, parameters=parameters, userdata=userdata, root=root)
    file = f"inner_{draft.meaning[:12]}.yaml"
    return behavior("inner", outcomes=outcomes, parameters=parameters, userdata=userdata, root=root, file=file)


class Case:
    """A behavior that shows itself as YAML when a property fails."""

    def __init__(self, behavior: Behavior) -> None:
        self.behavior = behavior

    @property
    def shares(self) -> bool:
        """Whether branches see one another write somewhere in it."""
        return any(shared_keys(node) for behavior in _all(self.behavior) for _, node in behavior.nodes())

    def __repr__(self) -> str:
        return "\n".join(to_yaml(behavior) for behavior in _all(self.behavior))


def _all(behavior: Behavior) -> list[Behavior]:
    return [behavior, *(inner for target in behavior.references.values() for inner in _all(target))]


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Draw a behavior."""
    userdata = {"n": draw(st.integers(0, 2)), "xs": [1, 2], **draw(USERDATA)}
    root = draw(_steps(DEPTH, st.sampled_from(OUTS), root=True))
    return Case(behavior("random", outcomes=["x"], userdata=userdata, root=root))


@st.composite
def preempting_cases(draw: st.DrawFn) -> Case:
    """Draw a behavior with a container whose conditions preempt some of its branches."""
    userdata = {"n": draw(st.integers(0, 2)), "xs": [1, 2], **draw(USERDATA)}
    return Case(behavior("random", outcomes=["x"], userdata=userdata, root=draw(_preempting())))
