"""Replacing the behavior of a run while it is paused: what changes, and why it may be impossible.

Running states keep the parameters they were entered with; transitions, conditions and autonomy are
those of the new version at once, everything else when a node is entered again. An active concurrency container gets
its new branches at once and loses those that are gone. Where the operator says so, active nodes that cannot go on as
they are, or that were given other parameters or keys, are preempted and entered anew.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from engine.node_path import is_inside
from engine.runtime.nodes.concurrency import Concurrency
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.machine import Machine
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.priority import Priority
from engine.runtime.plan import Plan
from engine.suggestions import did_you_mean


@dataclass(frozen=True, kw_only=True)
class ChangeReport:
    """What a hot change does; with `refusals` it does nothing."""

    changes: tuple[str, ...]
    refusals: tuple[str, ...]
    restarted: tuple[str, ...] = ()
    """The active nodes that are preempted and entered anew."""
    removed: tuple[str, ...] = ()
    """The branches of active concurrency containers that are gone."""
    replaced: tuple[str, ...] = ()
    """The nodes that are of another class or kind now."""


@dataclass(frozen=True, kw_only=True)
class VersionSnapshot:
    """The texts of a version, for whoever replays the run, and the name of the behavior among them; empty for none."""

    behavior: str = ""
    documents: Mapping[str, str] = field(default_factory=dict[str, str])


NO_SNAPSHOT = VersionSnapshot()


def plan_change(
    old: Plan,
    new: Plan,
    *,
    active: Mapping[str, Node],
    waiting: Mapping[str, str],
    still: bool,
    preempt: bool = False,
) -> ChangeReport:
    """Compare two versions of a behavior for a run that is in the middle of the old one.

    Args:
        old: What runs.
        new: What is to run.
        active: The nodes that were entered and not left, by path.
        waiting: The nodes at the gate with the outcome they wait with, empty before their entry.
        still: Whether the run is paused or locked.
        preempt: Whether what is active and cannot go on as it is may be preempted: a node is entered anew, a branch
            that is gone ends.
    """
    removed = tuple(_removed(old, new, active))
    staying = {path: node for path, node in active.items() if not _in_any(removed, path)}
    restarted: tuple[str, ...] = ()
    if preempt:
        restarted = tuple(_outermost(path for path in staying if _is_other(path, old, new)))
        staying = {path: node for path, node in staying.items() if not _in_any(restarted, path)}
    left = {path: outcome for path, outcome in waiting.items() if not _in_any((*removed, *restarted), path)}
    refusals = list(_refusals(old, new, staying, left))
    if not preempt:
        under_way = [path for path in removed if any(is_inside(path, each) for each in (*active, *waiting))]
        refusals += [f"{path} is under way and not in the new version" for path in under_way]
    if not still:
        refusals.insert(0, "the run is neither paused nor locked")
    changes = (
        *_changes(old, new, {path: node for path, node in active.items() if path not in restarted}),
        *(f"{path} is preempted and entered anew" for path in restarted),
    )
    return ChangeReport(
        changes=changes, refusals=tuple(refusals), restarted=restarted, removed=removed, replaced=_replaced(old, new)
    )


def _replaced(old: Plan, new: Plan) -> tuple[str, ...]:
    return tuple(
        path for path, node in old.nodes.items() if path in new.nodes and any(_refuses(path, node, new.nodes[path]))
    )


def _removed(old: Plan, new: Plan, active: Mapping[str, Node]) -> Iterator[str]:
    """Go through the branches of active concurrency containers that the new version does not have."""
    for path in active:
        before, after = old.nodes[path].work, new.nodes.get(path)
        if isinstance(before, Concurrency) and after is not None and isinstance(after.work, Concurrency):
            yield from (child.path for name, child in before.children.items() if name not in after.work.children)


def _is_other(path: str, old: Plan, new: Plan) -> bool:
    """Tell whether an active node has to be entered anew to be what the new version says."""
    before, after = old.nodes[path], new.nodes.get(path)
    if after is None:
        return False
    return any(_refuses(path, before, after)) or _wiring(before) != _wiring(after)


def _outermost(paths: Iterable[str]) -> Iterator[str]:
    found = tuple(paths)
    yield from (path for path in found if not any(other != path and is_inside(other, path) for other in found))


def _in_any(outer: Iterable[str], path: str) -> bool:
    return any(is_inside(each, path) for each in outer)


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
            yield f"{path} is active and not in the new version ({did_you_mean(path, new.nodes)})"
        elif path in active:
            # What only waits has not begun, or has ended: it may be anything else.
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
        if isinstance(before.work, Leaf) and isinstance(after.work, Leaf) and before.work.state != after.work.state:
            yield f"{path} is {after.work.signature.name} now"
        if _parameters(before) == _parameters(after) and _wiring(before) != _wiring(after):
            yield f"{path} reads or writes other keys{_when(path, active)}"
        if _conditions(before) != _conditions(after):
            yield f"{path} has other conditions"
        if _shared(before) != _shared(after):
            yield f"{path} shares other keys{_when(path, active)}"
        if _measures(before) != _measures(after):
            yield f"{path} has another timeout, retry, guard or on_error{_when(path, active)}"
    for key in new.userdata:
        if key not in old.userdata:
            yield f"the userdata key {key} is new"


def _wiring(node: Node) -> object:
    """Return what a state is given and where it writes."""
    if not isinstance(node.work, Leaf):
        return None
    return node.work.parameters.value, node.work.inputs, node.work.outputs


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
