"""How a part of a behavior tree can end, worked out from how its children can."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from engine.document.node import Node, Parallel, Remap

Status = Literal["success", "failure"]
Statuses = frozenset[Status]

BOTH: Statuses = frozenset(("success", "failure"))
SUCCESS: Statuses = frozenset(("success",))
FAILURE: Statuses = frozenset(("failure",))
NEVER: Statuses = frozenset()


def end_statuses(node: Node, children: Sequence[tuple[str, Statuses]]) -> Statuses:
    """Return with which statuses a composite or decorator can end; empty when it cannot end at all.

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
    child = ends[0]
    if node.inverter is not None:
        return frozenset(_OPPOSITE[status] for status in child)
    if node.remap is not None:
        return _remapped(node.remap, child)
    if node.condition is not None:
        waited = node.condition.status
        return SUCCESS if waited == "running" or waited in child else NEVER
    if node.retry is not None or node.repeat is not None or node.one_shot is not None:
        return child
    # What is left can fail by itself: timeout, guard, cooldown.
    return child | FAILURE


_OPPOSITE: dict[Status, Status] = {"success": "failure", "failure": "success"}


def _until(ends: Sequence[Statuses], onward: Status) -> Statuses:
    """A sequence goes on after success, a selector after failure."""
    found: set[Status] = set()
    for statuses in ends:
        found |= statuses - {onward}
        if onward not in statuses:
            return frozenset(found)
    return frozenset({*found, onward})


def _branched(ends: Sequence[Statuses]) -> Statuses:
    """The first says which of the others is run; where there is no third, it fails."""
    condition, then, *otherwise = ends
    found: Statuses = then if "success" in condition else NEVER
    return found | ((otherwise[0] if otherwise else FAILURE) if "failure" in condition else NEVER)


def _parallel(group: tuple[Node, ...] | Parallel, children: Sequence[tuple[str, Statuses]]) -> Statuses:
    if isinstance(group, Parallel) and group.counts:
        return _counted(group, [statuses for _, statuses in children])
    policy = "all" if isinstance(group, tuple) else group.policy
    failing: Statuses = FAILURE if any("failure" in statuses for _, statuses in children) else NEVER
    due = children if isinstance(policy, str) else [child for child in children if child[0] in policy]
    can = ["success" in statuses for _, statuses in due]
    succeeds = any(can) if policy == "one" else all(can)
    return failing | (SUCCESS if succeeds else NEVER)


def _counted(group: Parallel, ends: Sequence[Statuses]) -> Statuses:
    needed = group.success_count or len(ends)
    able = sum("success" in statuses for statuses in ends)
    failing = sum("failure" in statuses for statuses in ends)
    fails = failing >= min(group.failure_count or 1, len(ends) - needed + 1)
    return (SUCCESS if able >= needed else NEVER) | (FAILURE if fails else NEVER)


def _remapped(remap: Remap, child: Statuses) -> Statuses:
    shown = {remap.success if status == "success" else remap.failure for status in child} | {remap.running}
    return frozenset(status for status in BOTH if status in shown)
