"""Finds an example path through a behavior by which a key reaches a reader, for messages."""

from __future__ import annotations

from collections import deque

from engine.check.analyzed_behavior import NodeAt
from engine.check.flow.flow_graph import FlowGraph
from engine.check.flow.userdata_flow import DataFlow

_SHOWN = 7


def witness_path(flow: DataFlow, path: str, bit: int) -> tuple[str, ...]:
    """Return the sequence of node paths that leads to the node at `path` with `bit` set at its entry.

    The first one is the origin of the bit, or the first node of the behavior.
    """
    placed = flow.subject.nodes[path]
    inside: tuple[str, ...] = (path,)
    while placed.parent is not None:
        around = flow.subject.nodes[placed.parent]
        graph = flow.graphs.get(around.path)
        if graph is not None:
            within, complete = _within(flow, around, graph, placed, bit)
            inside = (*within[:-1], *inside)
            if complete:
                return inside
        if not flow.before.get(around.path, 0) & bit:
            return inside  # the container itself declares it
        placed = around
    return inside


def format_witness_path(steps: tuple[str, ...]) -> str:
    """Format a path as `a → b → c`; nodes of inner containers are relative to the common container."""
    common = 0
    parts = [step.split("/") for step in steps]
    while all(len(part) > common + 1 for part in parts) and len({part[common] for part in parts}) == 1:
        common += 1
    names = ["/".join(part[common:]) for part in parts]
    if len(names) > _SHOWN:
        names = [*names[:3], "…", *names[-3:]]
    return " → ".join(names)


def _within(flow: DataFlow, around: NodeAt, graph: FlowGraph, placed: NodeAt, bit: int) -> tuple[tuple[str, ...], bool]:
    """Search backwards through one container; return the path, and whether the bit comes from its first node."""
    children = flow.subject.children(around)
    numbers = {child.path: number for number, child in enumerate(children)}
    goal = numbers[placed.path]
    came_from: dict[int, int | None] = {goal: None}
    due = deque([goal])
    while due:
        here = due.popleft()
        if here in graph.entries and flow.inside.get(around.path, 0) & bit:
            return _unrolled(here, came_from, children), False
        for source in graph.backward.get(here, ()):
            if source in came_from or source == here:
                continue
            fact = flow.before.get(children[source].path, 0)
            effects = [effect for effect, to in graph.arrows[source] if to == here]
            if any(effect.after(fact & ~bit, flow.sites) & bit for effect in effects):
                came_from[source] = here
                return _unrolled(source, came_from, children), True
            if any(effect.after(fact, flow.sites) & bit for effect in effects):
                came_from[source] = here
                due.append(source)
    return (placed.path,), False


def _unrolled(start: int, came_from: dict[int, int | None], children: tuple[NodeAt, ...]) -> tuple[str, ...]:
    steps: list[str] = []
    here: int | None = start
    while here is not None:
        steps.append(children[here].path)
        here = came_from[here]
    return tuple(steps)
