"""Structural rules of behavior documents that types cannot express; each violation is an error with its position."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import cast

from engine.document.behavior import Behavior
from engine.document.duration import seconds
from engine.document.expression.cel_expression import RESERVED
from engine.document.nodes.concurrency_condition import AT_LEAST, PREEMPT, WHEN
from engine.document.nodes.node_kind import KINDS, WRAPPERS
from engine.document.nodes.node_kinds import NODE_KINDS
from engine.document.nodes.node_spec import (
    GUARD_TARGETS,
    TREE_KINDS,
    TREE_OUTCOMES,
    ConcurrencySpec,
    ForEachSpec,
    NodeSpec,
)
from engine.document.nodes.tree_composites import ParallelSpec
from engine.document.text.decoding import combine_mistakes
from engine.document.text.mistakes import MAX_MISTAKES
from engine.errors import DocumentError
from engine.wording.suggestions import did_you_mean

_SHORTEST_EVERY_S = 1e-3
_PARTS = frozenset((*TREE_KINDS, *WRAPPERS))
"""Kinds that are only allowed inside a tree."""
_STATUS_TARGETS = WRAPPERS[1:]
"""The wrappers that have a target."""
_RULES_OF_TREES, _RULES_OUTSIDE = "rules inside trees", "rules outside trees"
_CONTAINER_KEYS = {
    "with": "only states and behavior references have parameters",
    "in": "the children of a container read the keys around it directly",
    "out": "the children of a container write the keys around it directly",
}


@dataclass(frozen=True, kw_only=True)
class RuleViolation:
    """A violated rule at the node `path`; the empty path is the behavior itself.

    Removing the value at `excess`, keys from the node inward, satisfies the rule; None if the node cannot be
    interpreted. Violations are reported in list order, outer ones first.
    """

    path: str
    error: DocumentError
    excess: tuple[str | int, ...] | None = ()


def require_structural_rules(behavior: Behavior) -> None:
    """Check kinds, positions of keys, and names.

    Raises:
        DocumentError: the first violation; `where` is its position, `others` are the others.
    """
    errors = [violation.error for violation in rule_violations(behavior)]
    if errors:
        raise combine_mistakes(errors[:MAX_MISTAKES])


def rule_violations(behavior: Behavior) -> Iterator[RuleViolation]:
    """Yield all violations; the content of a node that cannot be interpreted is skipped."""
    yield from _names(behavior)
    if behavior.root.transitions:
        where = behavior.key_position("root", "transitions")
        error = DocumentError("the root has no transitions", where=where, hint="its outcomes are those of the behavior")
        yield RuleViolation(path="root", error=error, excess=("transitions",))
    if behavior.root.is_disabled:
        where = behavior.key_position("root", "disabled")
        error = DocumentError("the root cannot be disabled", where=where, hint="disable nodes inside it")
        yield RuleViolation(path="root", error=error, excess=("disabled",))
    due = [("root", behavior.root, False)]
    while due:
        path, node, in_tree = due.pop()
        rules = _RULES_OF_TREES if in_tree else _RULES_OUTSIDE
        if rules not in node.clear_of:
            kinds = _one_kind(behavior, path, node)
            found = [kinds] if kinds is not None else list(_of_node(behavior, path, node, in_tree=in_tree))
            yield from found
            if not found:
                node.clear_of.add(rules)
            if any(violation.excess is None for violation in found):
                continue
        # Inside a machine that is a leaf of a tree, machine rules apply again.
        inside = node.tree is not None or (in_tree and node.kind in _PARTS)
        rules = _RULES_OF_TREES if inside else _RULES_OUTSIDE
        due += [
            (f"{path}/{name}", child, inside)
            for name, child in reversed(list(node.children.items()))
            if child.state is None or rules not in child.clear_of
        ]


def _of_node(behavior: Behavior, path: str, node: NodeSpec, *, in_tree: bool) -> Iterator[RuleViolation]:
    if node.children:
        yield from _container_keys(behavior, path, node)
    if node.concurrency is not None or node.foreach is not None:
        yield from _no_transitions(behavior, path, node)
    if node.concurrency is not None:
        yield from _conditions(behavior, path, node.concurrency)
    yield from _tree_part(behavior, path, node) if in_tree else _no_tree_part(behavior, path, node)
    if node.is_disabled and in_tree == isinstance(node.disabled, str) and path != "root":
        yield _misplaced_outcome(behavior, path, in_tree=in_tree)
    if node.foreach is not None:
        yield from _rounds(behavior, path, node.foreach)
    if node.every is not None:
        yield from _every(behavior, path, node, node.every, in_tree=in_tree)


def _misplaced_outcome(behavior: Behavior, path: str, *, in_tree: bool) -> RuleViolation:
    """Inside a tree a disabled node is skipped; elsewhere an outcome leads on."""
    where = behavior.position(path, "disabled")
    message = "a disabled part of a tree has no outcome" if in_tree else "a disabled node needs an outcome"
    hint = "write `disabled: true`: its parent passes over it" if in_tree else "write `disabled: OUTCOME`"
    return RuleViolation(path=path, error=DocumentError(message, where=where, hint=hint), excess=("disabled",))


def _every(
    behavior: Behavior, path: str, node: NodeSpec, every: float | str, *, in_tree: bool
) -> Iterator[RuleViolation]:
    where = behavior.key_position(path, "every")
    if not in_tree or (node.behaviour is None and node.kind not in KINDS):
        own = [f"`{kind.kind}`" for kind in NODE_KINDS.values() if kind.is_decorator and kind.has("every")]
        hint = f"a {' or '.join(own)} has its own inside it"
        error = DocumentError("`every` goes with a check or a `behaviour` in a tree", where=where, hint=hint)
        yield RuleViolation(path=path, error=error, excess=("every",))
    elif seconds(every) < _SHORTEST_EVERY_S:
        error = DocumentError("`every` is at least 1 ms", where=where, hint="100 ms is typical")
        yield RuleViolation(path=path, error=error, excess=("every",))


def _names(behavior: Behavior) -> Iterator[RuleViolation]:
    document = behavior.document
    for key in ("parameters", "userdata"):
        for name in getattr(document, key):
            if name in RESERVED:
                where = behavior.source.position((key, name), of_key=True)
                error = DocumentError(
                    f"`{name}` is a reserved word of the expression language", where=where, hint="rename it"
                )
                yield RuleViolation(path="", error=error, excess=(key, name))
    for name in document.userdata:
        if name in document.parameters:
            where = behavior.source.position(("userdata", name), of_key=True)
            error = DocumentError(
                f"`{name}` is both a parameter and a userdata key", where=where, hint="rename one of them"
            )
            yield RuleViolation(path="", error=error, excess=("userdata", name))
    for key in ("outcomes", "success"):
        names: tuple[str, ...] = getattr(document, key)
        known: set[str] = set()
        for index, name in enumerate(names):
            if name in known:
                where = behavior.source.position((key, index))
                error = DocumentError(f"`{name}` is repeated in `{key}`", where=where, hint="remove it")
                yield RuleViolation(path="", error=error)
            known.add(name)


def _one_kind(behavior: Behavior, path: str, node: NodeSpec) -> RuleViolation | None:
    kinds = node.kinds
    if len(kinds) == 1:
        return None
    if kinds:
        where = behavior.key_position(path, kinds[1])
        error = DocumentError(f"this node has several kinds: {_list(kinds)}", where=where, hint="keep one of them")
    else:
        where = behavior.key_position(path)
        error = DocumentError("this node has no kind", where=where, hint=f"add one of {_list(KINDS)}")
    return RuleViolation(path=path, error=error, excess=None)


def _tree_part(behavior: Behavior, path: str, node: NodeSpec) -> Iterator[RuleViolation]:
    """Inside a tree nothing has transitions, and a target is a status."""
    for key in ("transitions", "autonomy"):
        if getattr(node, key) and (key == "transitions" or node.kind in TREE_KINDS):
            where = behavior.key_position(path, key)
            hint = "trees have success and failure"
            error = DocumentError(f"a part of a tree has no `{key}`", where=where, hint=hint)
            yield RuleViolation(path=path, error=error, excess=(key,))
    for key in _STATUS_TARGETS:
        wrapper = getattr(node, key)
        if wrapper is None:
            continue
        statuses = GUARD_TARGETS if key == "guard" else TREE_OUTCOMES
        if wrapper.child is not None and wrapper.to is not None and key != "guard":
            where = behavior.key_position(path, key, "to")
            error = DocumentError(f"`{key}` with a `child` has no `to`", where=where, hint="it fails; remove `to`")
            yield RuleViolation(path=path, error=error, excess=(key, "to"))
        if wrapper.to not in statuses and not (wrapper.child is not None and wrapper.to is None):
            where = behavior.position(path, key)
            hint = f"add `to: failure`, or add a `child` to make it a decorator; `to` may be {_list(statuses)}"
            error = DocumentError(f"`{key}` inside a tree needs a `to` that is a status", where=where, hint=hint)
            yield RuleViolation(path=path, error=error, excess=(key,))
    if node.on_error is not None and node.on_error not in TREE_OUTCOMES:
        where = behavior.position(path, "on_error")
        error = DocumentError(
            f"`on_error` inside a tree cannot be `{node.on_error}`", where=where, hint=f"use {_list(TREE_OUTCOMES)}"
        )
        yield RuleViolation(path=path, error=error, excess=("on_error",))
    if node.kind in _PARTS:
        yield from _bare(behavior, path, node)
    if isinstance(node.parallel, ParallelSpec):
        yield from _policy(behavior, path, node, node.parallel)


def _policy(behavior: Behavior, path: str, node: NodeSpec, group: ParallelSpec[NodeSpec]) -> Iterator[RuleViolation]:
    """Require that a policy of a parallel names its children."""
    if group.counts:
        yield from _thresholds(behavior, path, group)
    for index, name in enumerate(() if isinstance(group.policy, str) else group.policy):
        if name not in node.children:
            where = behavior.position(path, "parallel", "policy", index)
            error = DocumentError(
                f"there is no child `{name}` here", where=where, hint=did_you_mean(name, node.children)
            )
            yield RuleViolation(path=path, error=error, excess=("parallel", "policy"))


def _thresholds(behavior: Behavior, path: str, group: ParallelSpec[NodeSpec]) -> Iterator[RuleViolation]:
    """Thresholds are reachable, and exclude a policy."""
    for key in ("success_count", "failure_count"):
        count: int | None = getattr(group, key)
        if count is not None and count > len(group.children):
            where = behavior.position(path, "parallel", key)
            hint = f"lower `{key}`"
            error = DocumentError(f"there are only {len(group.children)} children", where=where, hint=hint)
            yield RuleViolation(path=path, error=error, excess=("parallel", key))
    if group.policy != "all" or not group.synchronise:
        key = "synchronise" if group.policy == "all" else "policy"
        where = behavior.key_position(path, "parallel", key)
        hint = "with thresholds, ended children do not restart, and the counts replace the policy"
        error = DocumentError(f"`{key}` cannot be combined with thresholds", where=where, hint=hint)
        yield RuleViolation(path=path, error=error, excess=("parallel", key))


def _conditions(behavior: Behavior, path: str, container: ConcurrencySpec) -> Iterator[RuleViolation]:
    """Require one outcome in a condition, or `preempt` and `when`; a number in it is `at_least`."""
    for index, entry in enumerate(container.conditions):
        keys = ("concurrency", "conditions", index)
        found = _misshapen(entry)
        if found is None:
            yield from _counts(behavior, path, keys, entry)
        else:
            key, message, hint = found
            error = DocumentError(message, where=behavior.key_position(path, *keys, key), hint=hint)
            yield RuleViolation(path=path, error=error, excess=keys)


def _misshapen(entry: Mapping[str, object]) -> tuple[str, str, str] | None:
    """Return the key that makes an entry invalid, the message and the hint."""
    preempted = entry.get(PREEMPT)
    if isinstance(preempted, tuple):
        named = cast("tuple[str, ...]", preempted)
        if len(entry) == 1:
            return PREEMPT, f"a condition with `{PREEMPT}` requires `{WHEN}`", f"add `{WHEN}: {{child: outcome}}`"
        other = next(key for key in entry if key != PREEMPT)
        if other != WHEN:
            hint = f"write `{WHEN}` here, and `{other}` in a separate condition"
            return other, f"a condition decides an outcome or has `{PREEMPT}`, not both", hint
        repeated = next((name for name in named if named.count(name) > 1), None)
        if repeated is not None:
            return PREEMPT, f"`{repeated}` is repeated in `{PREEMPT}`", "remove it"
    elif len(entry) > 1:
        outcome = list(entry)[1]
        return outcome, "a condition has one outcome", f"put `{outcome}` in a separate condition"
    no_mapping = next((key for key, value in entry.items() if isinstance(value, tuple) and key != PREEMPT), None)
    if no_mapping is None:
        return None
    return no_mapping, f"`{no_mapping}`: expected a mapping, got a list", "write `{child: outcome}`"


def _counts(
    behavior: Behavior, path: str, keys: tuple[str | int, ...], entry: Mapping[str, object]
) -> Iterator[RuleViolation]:
    """Require that a number in a condition is `at_least`, and at most the number of children in the condition."""
    for key, written in entry.items():
        if not isinstance(written, dict):
            continue
        when = cast("dict[str, str | int]", written)
        children = sum(isinstance(due, str) for due in when.values())
        excess = keys if not children else None
        for name, due in when.items():
            if isinstance(due, str) or (name == AT_LEAST and due <= children):
                continue
            where = behavior.position(path, *keys, key, name)
            if name == AT_LEAST:
                message, hint = f"there are only {children} children in this condition", f"lower `{AT_LEAST}`"
            else:
                message, hint = f"`{name}`: {due} is not an outcome", f"write an outcome; only `{AT_LEAST}` is a number"
            # A condition without valid children is removed with its first violation.
            error = DocumentError(message, where=where, hint=hint)
            yield RuleViolation(path=path, error=error, excess=excess or (*keys, key, name))
            excess = None


def _bare(behavior: Behavior, path: str, node: NodeSpec) -> Iterator[RuleViolation]:
    """Require that a composite or decorator has no key except its kind and a guard."""
    for key in (*WRAPPERS, "on_error", "resume", "success"):
        if key not in (node.kind, "guard") and getattr(node, key):
            where = behavior.key_position(path, key)
            hint = f"wrap it: `{key}: {{…, child: …}}`" if key in WRAPPERS else "remove it"
            error = DocumentError(f"a `{node.kind}` of a tree has no `{key}`", where=where, hint=hint)
            yield RuleViolation(path=path, error=error, excess=(key,))
    if node.kind == "retry" and node.retry is not None and node.retry.outcomes:
        where = behavior.key_position(path, "retry", "outcomes")
        hint = "it retries after FAILURE"
        error = DocumentError("`retry` with a `child` has no `outcomes`", where=where, hint=hint)
        yield RuleViolation(path=path, error=error, excess=("retry", "outcomes"))


def _no_tree_part(behavior: Behavior, path: str, node: NodeSpec) -> Iterator[RuleViolation]:
    if node.kind in _PARTS:
        where = behavior.key_position(path, node.kind)
        hint = f"put it inside `tree:`, or use one of {_list(KINDS)}"
        error = DocumentError(f"`{node.kind}` is only allowed inside a tree", where=where, hint=hint)
        yield RuleViolation(path=path, error=error, excess=None)
        return
    for key in ("name", "success", "post"):
        if getattr(node, key):
            where = behavior.key_position(path, key)
            error = DocumentError(f"`{key}` of a node is only allowed inside a tree", where=where, hint="remove it")
            yield RuleViolation(path=path, error=error, excess=(key,))
    for key in _STATUS_TARGETS:
        wrapper = getattr(node, key)
        if wrapper is not None and wrapper.to is None:
            where = behavior.position(path, key)
            error = DocumentError("the key `to` is missing", where=where, hint=f"add the target of `{key}`")
            yield RuleViolation(path=path, error=error, excess=(key,))


def _rounds(behavior: Behavior, path: str, rounds: ForEachSpec) -> Iterator[RuleViolation]:
    if (rounds.items is None) == (rounds.times is None):
        where = behavior.key_position(path, "foreach")
        error = DocumentError("a foreach has either `items` or `times`", where=where, hint="set one of them")
        yield RuleViolation(path=path, error=error, excess=("foreach", "times") if rounds.times is not None else ())


def _container_keys(behavior: Behavior, path: str, node: NodeSpec) -> Iterator[RuleViolation]:
    for key, value in (("with", node.parameters), ("in", node.inputs), ("out", node.outputs)):
        if value:
            where = behavior.key_position(path, key)
            error = DocumentError(f"a {node.kind} container has no `{key}`", where=where, hint=_CONTAINER_KEYS[key])
            yield RuleViolation(path=path, error=error, excess=(key,))


def _no_transitions(behavior: Behavior, path: str, node: NodeSpec) -> Iterator[RuleViolation]:
    for name, child in node.children.items():
        if child.transitions:
            where = behavior.key_position(f"{path}/{name}", "transitions")
            rounds = node.foreach is not None
            hint = "its outcomes are used in `next`" if rounds else "its outcomes are used in `conditions`"
            use = "runs in rounds" if rounds else "runs concurrently with others"
            error = DocumentError(f"`{name}` {use} and has no transitions", where=where, hint=hint)
            yield RuleViolation(path=f"{path}/{name}", error=error, excess=("transitions",))


def _list(names: Iterable[str]) -> str:
    return ", ".join(f"`{name}`" for name in names)
