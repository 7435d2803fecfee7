"""Random behaviors made with the functions of `engine.authoring`, of every kind and with every key."""

from __future__ import annotations

from typing import Any, Literal

from hypothesis import strategies as st

from engine.authoring import (
    Guard,
    Param,
    Post,
    Preempt,
    Retry,
    Step,
    Timeout,
    TreePart,
    behavior,
    behaviour,
    concurrency,
    condition,
    cooldown,
    foreach,
    guard,
    if_then_else,
    inverter,
    machine,
    one_shot,
    parallel,
    parameter,
    priority,
    remap,
    repeat,
    retry,
    selector,
    sequence,
    state,
    timeout,
    tree,
    while_do_else,
)
from engine.document import Behavior
from tests.engine.document.example_documents import DURATIONS, KEYS, TEXTS, VALUES
from tests.engine.fake_states import Give, Write

NAMES = st.sampled_from(["go", "look", "on", "no", "null", "0x10", "1e3", "A-b"])
OUTCOMES = st.sampled_from(["a", "b", "done", "failed"])
WIDE_TEXTS = TEXTS | st.text(st.characters(exclude_categories=["Cs"]), max_size=6)
EXPRESSIONS = st.sampled_from(["${x}", "${x > 1 ? 'a' : \"b\"}", "${{'k': 1}.k}"])
USERDATA = st.dictionaries(KEYS, VALUES, max_size=2)
Kinds = st.SearchStrategy[Any]


def _optional(**keys: Kinds) -> st.SearchStrategy[dict[str, Any]]:
    return st.fixed_dictionaries({}, optional=keys)


_COMMON: dict[str, Kinds] = {
    "retry": st.builds(
        Retry,
        times=st.integers(1, 9),
        backoff=DURATIONS,
        outcomes=st.lists(OUTCOMES, max_size=2).map(tuple),
        errors=st.booleans(),
    ),
    "autonomy": st.dictionaries(OUTCOMES, st.sampled_from(["off", "low", "high", "full"]), max_size=2),
    "resume": st.sampled_from(["rerun", "ask", "a"]),
    "description": WIDE_TEXTS,
}
_ALONE = _optional(
    **_COMMON,
    guard=st.builds(Guard, when=EXPRESSIONS, to=OUTCOMES),
    timeout=st.builds(Timeout, after=DURATIONS, to=OUTCOMES),
    on_error=OUTCOMES,
)
_STATUS = st.sampled_from(["success", "failure"])
_GUARD_TO: st.SearchStrategy[Literal["success", "failure", "skipped"]] = st.sampled_from(
    ["success", "failure", "skipped"]
)
_IN_TREE = _optional(
    **_COMMON,
    guard=st.builds(Guard, when=EXPRESSIONS, to=_GUARD_TO),
    timeout=st.builds(Timeout, after=DURATIONS, to=_STATUS),
    on_error=_STATUS,
    name=NAMES,
    success=st.lists(OUTCOMES, max_size=2, unique=True),
)
_PART = _optional(name=NAMES, description=WIDE_TEXTS)


@st.composite
def _states(draw: st.DrawFn, keys: st.SearchStrategy[dict[str, Any]]) -> Step:
    more = draw(keys)
    match draw(st.integers(0, 2)):
        case 0:
            return state(Give(outcome=draw(st.sampled_from("abc")), after_s=draw(st.floats(0, 9))), **more)
        case 1:
            return state(Write(value=draw(VALUES | EXPRESSIONS)), outputs=draw(_keyed()), **more)
        case _:
            values = draw(st.dictionaries(KEYS, VALUES | EXPRESSIONS, max_size=3))
            return state(
                draw(st.sampled_from(["flow.Wait", "a.b:C"])), parameters=values, inputs=draw(_keyed()), **more
            )


def _keyed() -> st.SearchStrategy[dict[str, str]]:
    return st.dictionaries(KEYS, KEYS, max_size=2)


@st.composite
def _steps(draw: st.DrawFn, depth: int, keys: st.SearchStrategy[dict[str, Any]], *, wired: bool = False) -> Step:
    """Draw a step of at most a depth; `keys` are those that hold where it stands."""
    kind = (
        draw(st.sampled_from(["state", "machine", "priority", "concurrency", "foreach", "tree"])) if depth else "state"
    )
    if wired:
        transitions = st.dictionaries(OUTCOMES, OUTCOMES | NAMES, max_size=3)
        keys = st.tuples(keys, transitions).map(lambda both: {**both[0], "transitions": both[1]})
    if kind == "state":
        return draw(_states(keys))
    more = draw(keys)
    if kind in ("machine", "priority"):
        states = draw(st.dictionaries(NAMES, _steps(depth - 1, _ALONE, wired=True), min_size=1, max_size=3))
        make = machine if kind == "machine" else priority
        return make(initial=draw(NAMES), states=states, userdata=draw(st.none() | USERDATA), **more)
    if kind == "concurrency":
        states = draw(st.dictionaries(NAMES, _steps(depth - 1, _ALONE), min_size=1, max_size=3))
        asked = st.dictionaries(NAMES, OUTCOMES, min_size=1)
        some = st.builds(Preempt, st.lists(NAMES, min_size=1, max_size=2, unique=True), asked)
        rules = draw(st.lists(st.tuples(OUTCOMES, asked) | some, max_size=3))
        otherwise = draw(st.none() | OUTCOMES)
        return concurrency(states=states, conditions=rules, otherwise=otherwise, userdata=draw(USERDATA), **more)
    if kind == "tree":
        return tree(draw(_parts(depth - 1)), **more)
    return foreach(draw(_steps(depth - 1, _ALONE)), **draw(_rounds()), **more)


@st.composite
def _rounds(draw: st.DrawFn) -> dict[str, Any]:
    amount = draw(
        st.fixed_dictionaries({"items": st.lists(VALUES, max_size=3) | EXPRESSIONS})
        | st.fixed_dictionaries({"times": st.integers(0, 9) | EXPRESSIONS})
    )
    more = draw(
        _optional(item=KEYS, index=KEYS, next=st.lists(OUTCOMES, max_size=2), collect=_keyed(), userdata=USERDATA)
    )
    return {**amount, **more}


@st.composite
def _parts(draw: st.DrawFn, depth: int) -> TreePart:
    """Draw a part of a tree: a leaf of any kind, a composite or a decorator."""
    if depth <= 0:
        return draw(_states(_IN_TREE))
    inner = _parts(depth - 1)
    children = st.lists(inner, min_size=1, max_size=3)
    named = {**draw(_PART), **draw(_optional(post=st.builds(Post, on_success=USERDATA, always=USERDATA)))}
    more = {**named, **draw(_optional(guard=st.builds(Guard, when=EXPRESSIONS, to=_GUARD_TO)))}
    makers: list[Any] = [
        lambda: draw(_steps(depth - 1, _IN_TREE)),
        lambda: sequence(*draw(children), memory=draw(st.none() | st.booleans()), **more),
        lambda: selector(*draw(children), memory=draw(st.none() | st.booleans()), **more),
        lambda: parallel(
            *draw(children),
            state(Give(), name="chosen"),
            policy=draw(st.sampled_from([None, "all", "one", ["chosen"]])),
            synchronise=draw(st.none() | st.booleans()),
            **more,
        ),
        lambda: parallel(*draw(children), success_count=1, failure_count=draw(st.none() | st.just(1)), **more),
        lambda: inverter(draw(inner), **more),
        lambda: one_shot(draw(inner), policy=draw(st.sampled_from([None, "completion", "success"])), **more),
        lambda: repeat(draw(inner), times=draw(st.integers(1, 5)), **more),
        lambda: cooldown(draw(inner), after=draw(DURATIONS), **more),
        lambda: remap(draw(inner), failure=draw(st.sampled_from([None, "success", "running"])), **more),
        lambda: condition(draw(inner), status=draw(st.sampled_from(["success", "failure", "running"])), **more),
        lambda: retry(draw(inner), times=draw(st.integers(1, 5)), backoff=draw(st.none() | DURATIONS), **more),
        lambda: timeout(draw(inner), after=draw(DURATIONS), **more),
        lambda: guard(draw(inner), when=draw(EXPRESSIONS), to=draw(st.none() | _GUARD_TO), **named),
        lambda: if_then_else(draw(inner), draw(inner), draw(st.none() | inner), **more),
        lambda: while_do_else(draw(inner), draw(inner), draw(st.none() | inner), **more),
        lambda: behaviour("py_trees.behaviours:Success", parameters=draw(USERDATA), **more),
    ]
    return makers[draw(st.integers(0, len(makers) - 1))]()


def _parameters() -> st.SearchStrategy[list[Param[Any]]]:
    numbers = st.builds(
        parameter, st.just("speed"), st.just(float), default=st.floats(0, 1), maximum=st.none() | st.floats(1, 2)
    )
    texts = st.builds(
        parameter, st.just("arm"), st.just(str), choices=st.lists(TEXTS, max_size=2), description=WIDE_TEXTS, unit=TEXTS
    )
    return st.tuples(st.none() | numbers, st.none() | texts).map(lambda both: [p for p in both if p is not None])


BEHAVIORS: st.SearchStrategy[Behavior] = st.builds(
    behavior,
    st.sampled_from(["transfer", "on", "Zwei Arme", "1e3"]),
    outcomes=st.lists(OUTCOMES, min_size=1, unique=True),
    success=st.lists(OUTCOMES, max_size=2, unique=True),
    parameters=_parameters(),
    userdata=st.none() | st.dictionaries(st.sampled_from(["tries", "_k"]), VALUES, max_size=2),
    description=WIDE_TEXTS,
    view=st.none() | st.dictionaries(st.just("root/go"), st.tuples(st.floats(0, 99), st.floats(0, 99))),
    root=_steps(3, _ALONE),
)
