"""Compares two versions of a behavior for a hot change: what changes, and why the change may be refused.

Running states keep the parameters they were entered with. Transitions, conditions and autonomy of the new version
apply at once, everything else at the next entry of a node. An active concurrency container starts its new branches at
once and preempts removed ones. With `preempt`, active nodes that cannot continue, or whose parameters or keys changed,
are preempted and entered again.
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
from engine.wording.suggestions import did_you_mean


@dataclass(frozen=True, kw_only=True)
class ChangeReport:
    """Effects of a hot change; with `refusals` it has none."""

    changes: tuple[str, ...]
    refusals: tuple[str, ...]
    restarted: tuple[str, ...] = ()
    """The active nodes that are preempted and entered again."""
    removed: tuple[str, ...] = ()
    """The removed branches of active concurrency containers."""
    replaced: tuple[str, ...] = ()
    """The nodes whose class or kind changes."""


@dataclass(frozen=True, kw_only=True)
class VersionSnapshot:
    """The source texts of a version, for replays, and the name of the behavior among them; empty for none."""

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
    """Compare two versions of a behavior for a run that executes the old one.

    Args:
        old: The current version.
        new: The new version.
        active: The nodes that were entered and not exited, by path.
        waiting: The outcomes of the nodes that wait at the gate, by path; empty before their entry.
        still: Whether the run is paused or locked.
        preempt: Whether active nodes that cannot continue may be preempted: a node is entered again, a removed branch
            ends.
    """
    removed = tuple(_removed(old, new, active))
    staying = {path: node for path, node in active.items() if not _in_any(removed, path)}
    restarted: tuple[str, ...] = ()
    if preempt:
        restarted = tuple(_outermost(path for path in staying if _is_other(path, old, new)))
        staying = {path: node for path, node in staying.items() if not _in_any(restarted, path)}
    still_waiting = {path: outcome for path, outcome in waiting.items() if not _in_any((*removed, *restarted), path)}
    refusals = list(_refusals(old, new, staying, still_waiting))
    if not preempt:
        active_removed = [path for path in removed if any(is_inside(path, each) for each in (*active, *waiting))]
        refusals += [f"the branch {path} is active and not in the new version" for path in active_removed]
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
    """Yield the branches of active concurrency containers that the new version does not contain."""
    for path in active:
        before, after = old.nodes[path].work, new.nodes.get(path)
        if isinstance(before, Concurrency) and after is not None and isinstance(after.work, Concurrency):
            yield from (child.path for name, child in before.children.items() if name not in after.work.children)


def _is_other(path: str, old: Plan, new: Plan) -> bool:
    """Return whether an active node must be entered again to match the new version."""
    before, after = old.nodes[path], new.nodes.get(path)
    if after is None:
        return False
    return any(_refuses(path, before, after)) or _key_mapping(before) != _key_mapping(after)


def _outermost(paths: Iterable[str]) -> Iterator[str]:
    all_paths = tuple(paths)
    yield from (path for path in all_paths if not any(other != path and is_inside(other, path) for other in all_paths))


def _in_any(outer: Iterable[str], path: str) -> bool:
    return any(is_inside(each, path) for each in outer)


def definitions(plan: Plan) -> Iterator[tuple[str, object]]:
    """Yield the nodes of a plan with their paths, and its containers with `path/`."""
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
            # A node that only waits has not begun, or has ended: it may change freely.
            yield from _refuses(path, old.nodes[path], present)
    for path, outcome in waiting.items():
        yield from _has_no_transition(new, path, outcome)
    for name, parameter in new.parameters.items():
        if parameter.required and name not in old.parameters:
            yield f"the new parameter {name} has no default"


def _refuses(path: str, before: Node, after: Node) -> Iterator[str]:
    if after.disabled is not None:
        yield f"{path} is active and disabled in the new version"
        return
    if before.work.kind != after.work.kind:
        yield f"{path} is active and changes from a {before.work.kind} to a {after.work.kind}"
        return
    if isinstance(before.work, Leaf) and isinstance(after.work, Leaf) and before.work.state is not after.work.state:
        yield f"{path} is active as {before.work.signature.name} and becomes {after.work.signature.name}"
    if before.work.kind == "tree" and _shape(before) != _shape(after):
        yield f"{path} is active and the structure of its tree changes"


def _has_no_transition(new: Plan, path: str, outcome: str) -> Iterator[str]:
    node = new.nodes.get(path)
    container = new.nodes.get(path.rpartition("/")[0])
    if not outcome or node is None or container is None:
        return
    if isinstance(container.work, Machine | Priority) and outcome not in node.transitions:
        yield f"{path} waits with the outcome {outcome}, which has no transition in the new version"


def _changes(old: Plan, new: Plan, active: Mapping[str, Node]) -> Iterator[str]:
    for path in new.nodes:
        if path not in old.nodes:
            yield f"{path} is added"
    for path, before in old.nodes.items():
        after = new.nodes.get(path)
        if after is None:
            yield f"{path} is removed"
            continue
        if (before.disabled is None) != (after.disabled is None):
            yield f"{path} is {'enabled' if after.disabled is None else 'disabled'}"
            continue
        if before.transitions != after.transitions:
            yield f"{path} has changed transitions"
        if _parameters(before) != _parameters(after):
            yield f"{path} has changed parameters{_at_next_entry(path, active)}"
        if isinstance(before.work, Leaf) and isinstance(after.work, Leaf) and before.work.state != after.work.state:
            yield f"{path} becomes {after.work.signature.name}"
        if _parameters(before) == _parameters(after) and _key_mapping(before) != _key_mapping(after):
            yield f"{path} reads or writes different keys{_at_next_entry(path, active)}"
        if _conditions(before) != _conditions(after):
            yield f"{path} has changed conditions"
        if _shared(before) != _shared(after):
            yield f"{path} shares different keys{_at_next_entry(path, active)}"
        if _policies(before) != _policies(after):
            yield f"{path} has a changed timeout, retry, guard or on_error{_at_next_entry(path, active)}"
    for key in new.userdata:
        if key not in old.userdata:
            yield f"the userdata key {key} is added"


def _key_mapping(node: Node) -> object:
    """Return the parameters and the key mapping of a state."""
    if not isinstance(node.work, Leaf):
        return None
    return node.work.parameters.value, node.work.inputs, node.work.outputs


def _parameters(node: Node) -> object:
    return node.work.parameters.value if isinstance(node.work, Leaf) else None


def _conditions(node: Node) -> object:
    return node.work.conditions if isinstance(node.work, Concurrency) else None


def _shared(node: Node) -> object:
    return node.work.shared if isinstance(node.work, Concurrency) else None


def _policies(node: Node) -> tuple[object, ...]:
    guard = (node.guard.when.value, node.guard.target) if node.guard is not None else None
    return (node.timeout, node.retry, node.on_error, guard)


def _at_next_entry(path: str, active: Mapping[str, Node]) -> str:
    return ", effective at its next entry" if path in active else ""


def _shape(node: Node) -> tuple[str, str, tuple[object, ...]]:
    return (node.name, node.work.kind, tuple(_shape(child) for child in node.work.children.values()))
