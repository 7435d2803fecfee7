"""The possible statuses of a part of a behavior tree, derived from those of its children."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from engine.document.nodes.decorator_spec import DecoratorSpec
from engine.document.nodes.node_spec import GUARD_TARGETS, NodeSpec
from engine.document.nodes.tree_composites import ParallelSpec

Status = Literal["success", "failure", "skipped"]
Statuses = frozenset[Status]

BOTH: Statuses = frozenset(("success", "failure"))
SUCCESS: Statuses = frozenset(("success",))
FAILURE: Statuses = frozenset(("failure",))
SKIPPED: Statuses = frozenset(("skipped",))
NEVER: Statuses = frozenset()


def end_statuses(node: NodeSpec, children: Sequence[tuple[str, Statuses]]) -> Statuses:
    """Return the statuses with which a composite or decorator can end; empty if it never ends.

    Args:
        node: The composite or decorator.
        children: Name and statuses of each child, in order.
    """
    ends = [statuses for _, statuses in children]
    if node.sequence is not None:
        return _until(ends, "success")
    if node.selector is not None:
        return _until(ends, "failure")
    if node.parallel is not None:
        return _parallel(node.parallel, children)
    if node.behaviour is not None:
        return BOTH
    if node.if_then_else is not None or node.while_do_else is not None:
        return _branched(ends)
    return _decorated(node.decorator, ends[0]) if node.decorator is not None else NEVER


def closed_statuses(node: NodeSpec) -> Statuses:
    """Return the status with which a node ends at once when its guard is closed."""
    return frozenset(status for status in GUARD_TARGETS if node.guard is not None and node.guard.to == status)


def _decorated(decorator: DecoratorSpec, child: Statuses) -> Statuses:
    """Return the ends of a decorator, which may also end while its child is RUNNING."""
    found: set[Status] = set()
    for status in (*child, "running"):
        found.update(shown for shown in decorator.statuses(status) if shown != "running")
    return frozenset(found)


def _until(ends: Sequence[Statuses], onward: Status) -> Statuses:
    """Return the ends of a sequence, which continues after success, or a selector, after failure; both after a skip."""
    found: set[Status] = set()
    for statuses in ends:
        found |= statuses - {onward, "skipped"}
        if onward not in statuses and "skipped" not in statuses:
            return frozenset(found)
    found |= {onward} if any(onward in statuses for statuses in ends) else set()
    return frozenset(found) | _all_skipped(ends)


def _all_skipped(ends: Sequence[Statuses]) -> Statuses:
    return SKIPPED if all("skipped" in statuses for statuses in ends) else NEVER


def _branched(ends: Sequence[Statuses]) -> Statuses:
    """Return the ends of a part whose first child selects which of the others runs; without a third, it fails."""
    condition, then, *otherwise = ends
    found: Statuses = then if "success" in condition else NEVER
    return found | ((otherwise[0] if otherwise else FAILURE) if condition - SUCCESS else NEVER)


def _parallel(
    group: tuple[NodeSpec, ...] | ParallelSpec[NodeSpec], children: Sequence[tuple[str, Statuses]]
) -> Statuses:
    if isinstance(group, ParallelSpec) and group.counts:
        return _counted(group, [statuses for _, statuses in children])
    policy = "all" if isinstance(group, tuple) else group.policy
    failing: Statuses = FAILURE if any("failure" in statuses for _, statuses in children) else NEVER
    due = children if isinstance(policy, str) else [child for child in children if child[0] in policy]
    can = ["success" in statuses for _, statuses in due]
    passed = ["success" in statuses or "skipped" in statuses for _, statuses in due]
    succeeds = any(can) if policy == "one" else all(passed) and any("success" in ends for _, ends in children)
    return failing | (SUCCESS if succeeds else NEVER) | _all_skipped([ends for _, ends in children])


def _counted(group: ParallelSpec[NodeSpec], ends: Sequence[Statuses]) -> Statuses:
    needed = group.success_count or len(ends)
    able = sum("success" in statuses for statuses in ends)
    failing = sum("failure" in statuses for statuses in ends)
    fails = failing >= min(group.failure_count or 1, len(ends) - needed + 1)
    skipped = sum("skipped" in statuses for statuses in ends)
    if group.success_count is None:
        succeeds = able > 0 and all(statuses & {"success", "skipped"} for statuses in ends)
    else:
        succeeds = able >= needed
        fails = fails or (skipped > 0 and failing + skipped > len(ends) - needed and able + failing > 0)
    return (SUCCESS if succeeds else NEVER) | (FAILURE if fails else NEVER) | _all_skipped(ends)
