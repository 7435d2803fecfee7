"""Steps that contain steps: machines, priority, concurrency, foreach and trees."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Unpack

from engine.authoring.plain_data import to_plain_data
from engine.authoring.source_location import calling_position
from engine.authoring.steps import Step, StepKeys, TreePart, given_keys, new_step
from engine.document.nodes.concurrency_condition import PREEMPT, WHEN

Rule = tuple[str, Mapping[str, str | int]]
"""`("finished", {"left": "reached", "right": "reached"})`: outcome and required outcomes, at least `at_least`."""


@dataclass(frozen=True)
class Preempt:
    """A condition that preempts some of the concurrent steps, while the others continue.

    Args:
        steps: Names of the preempted steps.
        when: Required outcomes, as in a rule.
    """

    steps: Sequence[str]
    when: Mapping[str, str | int]


def machine(
    *,
    initial: str,
    states: Mapping[str, Step],
    userdata: Mapping[str, object] | None = None,
    **keys: Unpack[StepKeys],
) -> Step:
    """Run one step at a time, from `initial` along the `transitions` of each.

    Args:
        initial: The step that runs first.
        states: The steps by name, in order.
        userdata: Initial values of the scope of the container.
        **keys: Common keys of steps.
    """
    return new_step("machine", _sequential(initial, states, userdata), **keys)


def priority(
    *,
    initial: str,
    states: Mapping[str, Step],
    userdata: Mapping[str, object] | None = None,
    **keys: Unpack[StepKeys],
) -> Step:
    """Run like a machine, while all concurrent branches are held."""
    return new_step("priority", _sequential(initial, states, userdata), **keys)


def concurrency(
    *,
    states: Mapping[str, Step],
    conditions: Sequence[Rule | Preempt],
    otherwise: str | None = None,
    userdata: Mapping[str, object] | None = None,
    shared: Sequence[str] | None = None,
    **keys: Unpack[StepKeys],
) -> Step:
    """Run steps concurrently until a condition holds.

    Args:
        states: The steps by name, in order.
        conditions: `(outcome, {step: its outcome})` in order of precedence; all entries must hold,
            or the number of entries under `at_least`. A `Preempt(steps, when)` decides no outcome.
        otherwise: The outcome when all have ended and no condition holds.
        userdata: Initial values of the scope of the container.
        shared: Keys of this or an enclosing scope whose writes are immediately visible to all steps.
        **keys: Common keys of steps.
    """
    rules = [_entry(condition) for condition in conditions]
    what = given_keys(
        states=dict(states), conditions=rules, otherwise=otherwise, userdata=_values(userdata), shared=_list(shared)
    )
    return new_step("concurrency", what, **keys)


def _entry(condition: Rule | Preempt) -> dict[str, object]:
    if isinstance(condition, Preempt):
        return {PREEMPT: list(condition.steps), WHEN: dict(condition.when)}
    outcome, when = condition
    return {outcome: dict(when)}


def foreach(
    child: Step,
    *,
    items: Sequence[object] | str | None = None,
    times: int | str | None = None,
    item: str | None = None,
    index: str | None = None,
    next: Sequence[str] | None = None,  # noqa: A002 - the document key
    collect: Mapping[str, str] | None = None,
    userdata: Mapping[str, object] | None = None,
    **keys: Unpack[StepKeys],
) -> Step:
    """Run a step once for each item, or a number of times; ends `exhausted` or `broken`.

    Args:
        child: The step.
        items: A list, or an expression whose value is a list.
        times: Number of rounds instead of items, a number or an expression.
        item: The userdata key of the item of the round; `item` by default.
        index: The userdata key of the number of the round, from 0.
        next: Outcomes after which the next round begins; the success outcomes by default.
        collect: Maps keys written in a round to the keys of outer lists that they are appended to.
        userdata: Initial values of the scope of each round.
        **keys: Common keys of steps.
    """
    place = calling_position()
    shown = to_plain_data(items, what="`items`", where=place)
    what = given_keys(child=child, items=shown, times=times, index=index, next=_list(next), userdata=_values(userdata))
    collected = {"collect": dict(collect)} if collect else {}
    named = {"as": item} if item is not None else {}
    return new_step("foreach", {**what, **named, **collected}, **keys)


def tree(root: TreePart, **keys: Unpack[StepKeys]) -> Step:
    """Run a behavior tree; ends `success` or `failure`."""
    return new_step("tree", root, **keys)


def _sequential(initial: str, states: Mapping[str, Step], userdata: Mapping[str, object] | None) -> dict[str, object]:
    return given_keys(initial=initial, states=dict(states), userdata=_values(userdata))


def _values(userdata: Mapping[str, object] | None) -> object:
    return to_plain_data(userdata, what="`userdata`", where=calling_position()) if userdata else None


def _list(names: Sequence[str] | None) -> list[str] | None:
    return list(names) if names is not None else None
