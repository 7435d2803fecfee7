"""Replacing the behavior of a run while it is paused: what changes, and why it may be impossible.

Running states keep the parameters they were entered with; transitions, conditions and autonomy are
those of the new version at once, everything else when a node is entered again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from engine.concurrency import Concurrency
from engine.leaf import Leaf
from engine.machine import Machine
from engine.nearness import near_names
from engine.node import Node
from engine.plan import Plan
from engine.priority import Priority


@dataclass(frozen=True, kw_only=True)
class ChangeReport:
    """What a hot change does; with `refusals` it does nothing."""

    changes: tuple[str, ...]
    refusals: tuple[str, ...]


def plan_change(
    old: Plan, new: Plan, *, active: Mapping[str, Node], waiting: Mapping[str, str], still: bool
) -> ChangeReport:
    """Compare two versions of a behavior for a run that is in the middle of the old one.

    Args:
        old: What runs.
        new: What is to run.
        active: The nodes that were entered and not left, by path.
        waiting: The nodes at the gate with the outcome they wait with, empty before their entry.
        still: Whether the run is paused or locked.
    """
    refusals = list(_refusals(old, new, active, waiting))
    if not still:
        refusals.insert(0, "the run is neither paused nor locked")
    return ChangeReport(changes=tuple(_changes(old, new, active)), refusals=tuple(refusals))


def definitions(plan: Plan) -> Iterator[tuple[str, object]]:
    """Go through the nodes of a plan by path, and through its containers by `path/`."""
    for path, node in plan.nodes.items():
        yield path, node
        if node.work.children:
            yield f"{path}/", node.work.machine if isinstance(node.work, Priority) else node.work


def _refusals(old: Plan, new: Plan, active: Mapping[str, Node], waiting: Mapping[str, str]) -> Iterator[str]:
    for path in dict.fromkeys((*active, *waiting)):
        present = new.nodes.get(path)
        if present is None:
            yield f"{path} is active and not in the new version ({near_names(path, new.nodes)})"
            continue
        yield from _refuses(path, old.nodes[path], present)
    for path, outcome in waiting.items():
        yield from _leads_nowhere(new, path, outcome)
    for name, parameter in new.parameters.items():
        if parameter.required and name not in old.parameters:
            yield f"the new parameter {name} has no default"


def _refuses(path: str, before: Node, after: Node) -> Iterator[str]:
    if before.work.kind != after.work.kind:
        yield f"{path} is active and was a {before.work.kind}, now it is a {after.work.kind}"
        return
    if isinstance(before.work, Leaf) and isinstance(after.work, Leaf) and before.work.state is not after.work.state:
        yield f"{path} is active as {before.work.signature.name}, now it is {after.work.signature.name}"
    if isinstance(before.work, Concurrency) and list(before.work.children) != list(after.work.children):
        yield f"{path} is active and has other branches now"
    if before.work.kind == "tree" and _shape(before) != _shape(after):
        yield f"{path} is active and its tree has another shape now"


def _leads_nowhere(new: Plan, path: str, outcome: str) -> Iterator[str]:
    node = new.nodes.get(path)
    container = new.nodes.get(path.rpartition("/")[0])
    if not outcome or node is None or container is None:
        return
    if isinstance(container.work, Machine | Priority) and outcome not in node.transitions:
        yield f"{path} waits with the outcome {outcome}, which leads nowhere in the new version"


def _changes(old: Plan, new: Plan, active: Mapping[str, Node]) -> Iterator[str]:
    for path in new.nodes:
        if path not in old.nodes:
            yield f"{path} is new"
    for path, before in old.nodes.items():
        after = new.nodes.get(path)
        if after is None:
            yield f"{path} is gone"
            continue
        if before.transitions != after.transitions:
            yield f"{path} has other transitions"
        if _parameters(before) != _parameters(after):
            yield f"{path} has other parameters{_when(path, active)}"
        if _conditions(before) != _conditions(after):
            yield f"{path} has other conditions"
        if _shared(before) != _shared(after):
            yield f"{path} shares other keys{_when(path, active)}"
        if _measures(before) != _measures(after):
            yield f"{path} has another timeout, retry, guard or on_error{_when(path, active)}"
    for key in new.userdata:
        if key not in old.userdata:
            yield f"the userdata key {key} is new"


def _parameters(node: Node) -> object:
    return node.work.parameters.value if isinstance(node.work, Leaf) else None


def _conditions(node: Node) -> object:
    return node.work.conditions if isinstance(node.work, Concurrency) else None


def _shared(node: Node) -> object:
    return node.work.shared if isinstance(node.work, Concurrency) else None


def _measures(node: Node) -> tuple[object, ...]:
    guard = (node.guard.when.value, node.guard.target) if node.guard is not None else None
    return (node.timeout, node.retry, node.on_error, guard)


def _when(path: str, active: Mapping[str, Node]) -> str:
    return ", from its next entry on" if path in active else ""


def _shape(node: Node) -> tuple[str, str, tuple[object, ...]]:
    return (node.name, node.work.kind, tuple(_shape(child) for child in node.work.children.values()))
