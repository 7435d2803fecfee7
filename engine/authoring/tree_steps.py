"""Parts of behavior trees: composites, and decorators with one child. Keys are those of documents."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, Unpack

from engine.authoring.steps import NameKeys, PartKeys, TreePart, given_keys, new_part
from engine.document.nodes.node_kind import SLOTS, Status

__all__ = [
    "condition",
    "cooldown",
    "guard",
    "if_then_else",
    "inverter",
    "one_shot",
    "parallel",
    "remap",
    "repeat",
    "retry",
    "selector",
    "sequence",
    "timeout",
    "while_do_else",
]


def sequence(*children: TreePart, memory: bool | None = None, **keys: Unpack[PartKeys]) -> TreePart:
    """Run children in order until one fails; with `memory` a succeeded child is not ticked again."""
    return _group("sequence", children, memory=memory, keys=keys)


def selector(*children: TreePart, memory: bool | None = None, **keys: Unpack[PartKeys]) -> TreePart:
    """Run children in order until one succeeds; with `memory` a failed child is not ticked again."""
    return _group("selector", children, memory=memory, keys=keys)


def parallel(
    *children: TreePart,
    policy: Literal["all", "one"] | Sequence[str] | None = None,
    synchronise: bool | None = None,
    success_count: int | None = None,
    failure_count: int | None = None,
    **keys: Unpack[PartKeys],
) -> TreePart:
    """Tick children together; success by `policy` (all, one, or named children) or by counts."""
    named = policy if isinstance(policy, str) or policy is None else list(policy)
    more = given_keys(policy=named, synchronise=synchronise, success_count=success_count, failure_count=failure_count)
    if not more:
        return new_part("parallel", list(children), **keys)
    return new_part("parallel", {"children": list(children), **more}, **keys)


def inverter(child: TreePart, **keys: Unpack[PartKeys]) -> TreePart:
    """Turn success into failure and back."""
    return new_part("inverter", {"child": child}, **keys)


def one_shot(
    child: TreePart, *, policy: Literal["completion", "success"] | None = None, **keys: Unpack[PartKeys]
) -> TreePart:
    """Run the child to completion, or to success, once in a run of the tree, and keep its status."""
    return new_part("one_shot", given_keys(child=child, policy=policy), **keys)


def repeat(child: TreePart, *, times: int, **keys: Unpack[PartKeys]) -> TreePart:
    """Run the child until it has succeeded `times` times in a row."""
    return new_part("repeat", {"child": child, "times": times}, **keys)


def cooldown(child: TreePart, *, after: float | str, **keys: Unpack[PartKeys]) -> TreePart:
    """Fail without ticking the child until `after` has passed since it last ended."""
    return new_part("cooldown", {"child": child, "after": after}, **keys)


def remap(
    child: TreePart,
    *,
    success: Status | None = None,
    failure: Status | None = None,
    running: Status | None = None,
    **keys: Unpack[PartKeys],
) -> TreePart:
    """Map the status of the child to another status."""
    return new_part("remap", given_keys(child=child, success=success, failure=failure, running=running), **keys)


def condition(child: TreePart, *, status: Status, **keys: Unpack[PartKeys]) -> TreePart:
    """Return SUCCESS when the child has this status, RUNNING until then."""
    return new_part("condition", {"child": child, "status": status}, **keys)


def if_then_else(
    condition: TreePart, then: TreePart, otherwise: TreePart | None = None, **keys: Unpack[PartKeys]
) -> TreePart:
    """Run the condition once, then `then` after success, else `otherwise`; fail without `otherwise`."""
    slots = zip(SLOTS["if_then_else"], (condition, then, otherwise), strict=True)
    return new_part("if_then_else", given_keys(**dict(slots)), **keys)


def while_do_else(
    condition: TreePart, body: TreePart, otherwise: TreePart | None = None, **keys: Unpack[PartKeys]
) -> TreePart:
    """Run `body` while the condition succeeds, `otherwise` while it fails; fail without `otherwise`."""
    slots = zip(SLOTS["while_do_else"], (condition, body, otherwise), strict=True)
    return new_part("while_do_else", given_keys(**dict(slots)), **keys)


def retry(child: TreePart, *, times: int, backoff: float | str | None = None, **keys: Unpack[PartKeys]) -> TreePart:
    """Retry the child after failure, up to `times` times; for the key of a step see `Retry`."""
    return new_part("retry", given_keys(child=child, times=times, backoff=backoff), **keys)


def timeout(child: TreePart, *, after: float | str, **keys: Unpack[PartKeys]) -> TreePart:
    """Fail when the child takes longer than `after`; for the key of a step see `Timeout`."""
    return new_part("timeout", {"child": child, "after": after}, **keys)


def guard(
    child: TreePart,
    *,
    when: str,
    to: Literal["success", "failure", "skipped"] | None = None,
    **keys: Unpack[NameKeys],
) -> TreePart:
    """Run the child while the expression is true, else fail, or end with `to`; for the key of a step see `Guard`."""
    return new_part("guard", given_keys(child=child, when=when, to=to), **keys)


def _group(kind: str, children: Sequence[TreePart], *, memory: bool | None, keys: PartKeys) -> TreePart:
    what = list(children) if memory is None else {"children": list(children), "memory": memory}
    return new_part(kind, what, **keys)
