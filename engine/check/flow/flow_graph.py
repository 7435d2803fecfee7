"""A container as a graph: its initial child, the edges of each child, and the names of its outcomes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import cast

from engine.check.analyzed_behavior import NodeAt
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.effect import Effect
from engine.check.graph_components import strong_components
from engine.document.nodes.decorator_spec import DecoratorSpec
from engine.document.nodes.node_kind import TreeStatus
from engine.document.nodes.node_spec import NodeSpec

Target = int | str
"""The number of a child, or the name of an outcome."""


@dataclass(frozen=True)
class FlowEdge:
    """One outgoing edge of a child: its label and its effect."""

    label: str
    effect: Effect


@dataclass(frozen=True)
class FlowGraph:
    """Children by number; `arrows` are the targets of the edges of each child."""

    entries: tuple[int, ...]
    arrows: Sequence[Sequence[tuple[Effect, Target]]]

    @cached_property
    def backward(self) -> Mapping[int, Sequence[int]]:
        """The predecessors of each child."""
        found: dict[int, list[int]] = {}
        for source, edges in enumerate(self.arrows):
            for _, to in edges:
                if isinstance(to, int):
                    found.setdefault(to, []).append(source)
        return found

    @cached_property
    def _ranks(self) -> Mapping[int, int]:
        """The index in `order` of each reachable child."""
        return {child: number for number, child in enumerate(self.order())}

    def _kept(self, sites: DefinitionSites) -> Mapping[int, int]:
        """Return the certain facts before each child on a loop: keys that only one child of the loop writes.

        Without them the solver iterates over a chain of loops once for each of its links.
        """
        leads = {child: [to for _, to in self.arrows[child] if isinstance(to, int)] for child in self._ranks}
        found: dict[int, int] = {}
        for part in strong_components(leads):
            if len(part) > 1:
                found.update(dict.fromkeys(part, self._kept_round(frozenset(part), sites)))
        return found

    def _kept_round(self, loop: frozenset[int], sites: DefinitionSites) -> int:
        writers: dict[str, set[int]] = {}
        several: set[str] = set()
        effects: list[Effect] = []
        for child in loop:
            inside = [effect for effect, to in self.arrows[child] if to in loop and effect.keys]
            for effect in inside:
                for key in effect.keys:
                    writers.setdefault(key, set()).add(child)
                several |= set() if effect.plain else effect.keys
            effects += inside
        gen = 0
        for effect in effects:
            gen |= effect.gen
        return gen & sites.all_bits(key for key, by in writers.items() if len(by) == 1 and key not in several)

    def order(self) -> list[int]:
        """Return the reachable children; a child precedes those reachable only through it."""
        seen = set(self.entries)
        finished: list[int] = []
        for start in self.entries:
            due = [(start, iter(self.arrows[start]))]
            while due:
                child, edges = due[-1]
                following = next((to for _, to in edges if isinstance(to, int) and to not in seen), None)
                if following is None:
                    finished.append(child)
                    due.pop()
                else:
                    seen.add(following)
                    due.append((following, iter(self.arrows[following])))
        return finished[::-1]

    def solve(self, entry: int, sites: DefinitionSites) -> tuple[dict[int, int], dict[str, int]]:
        """Return the fact before each reachable child and at each outcome, given the fact `entry`."""
        rank = self._ranks
        kept = self._kept(sites)
        before = {child: entry | kept.get(child, 0) for child in self.entries}
        ends: dict[str, int] = {}
        changed = True
        stale = set(before)
        while changed:
            changed = False
            for child in rank:
                if child not in stale:
                    continue
                stale.discard(child)
                for effect, to in self.arrows[child]:
                    fact = effect.after(before[child], sites)
                    if isinstance(to, str):
                        ends[to] = ends.get(to, 0) | fact
                        continue
                    known = before.get(to)
                    joined = fact | (kept.get(to, 0) if known is None else known)
                    if joined != known:
                        before[to] = joined
                        stale.add(to)
                        changed = changed or rank[to] <= rank[child]
        return before, ends


def machine_graph(children: Sequence[NodeAt], initial: str, edges: Mapping[str, Sequence[FlowEdge]]) -> FlowGraph:
    """Return the graph of a machine; the edges of its children are labelled with their targets."""
    numbers = {child.name: number for number, child in enumerate(children)}
    arrows = [[(edge.effect, numbers.get(edge.label, edge.label)) for edge in edges[child.path]] for child in children]
    return FlowGraph((numbers[initial],) if initial in numbers else (), arrows)


def tree_graph(
    placed: NodeAt, children: Sequence[NodeAt], edges: Mapping[str, Sequence[FlowEdge]], halted: Mapping[str, Effect]
) -> FlowGraph:
    """Return the graph of a tree, composite or decorator; all edges are labelled with statuses.

    `halted` are the possible writes of a halted child, by its path.
    """
    lead = _leads(placed.node, len(children))
    arrows = [
        [(edge.effect, to) for edge in edges[child.path] for to in lead(number, edge.label)]
        for number, child in enumerate(children)
    ]
    if placed.node.while_do_else is not None:
        # The active branch may be halted at any time, when the condition changes; where it has just ended, the
        # condition is ticked before that is seen.
        arrows[1:] = [
            [*found, *((effect, 0) for effect, _ in found), (halted[child.path], 0)]
            for found, child in zip(arrows[1:], children[1:], strict=True)
        ]
    return FlowGraph((0,), arrows)


def _leads(node: NodeSpec, count: int) -> Callable[[int, str], tuple[Target, ...]]:
    """Return the targets of child number i by status; a part that may fail by itself also leads to failure."""
    if node.sequence is not None or node.selector is not None:
        return _line("success" if node.sequence is not None else "failure", count)
    if node.tree is not None:
        return lambda _, status: ("success" if status == "skipped" else status,)
    if node.if_then_else is not None or node.while_do_else is not None:
        return lambda number, status: (status,) if number else (_branch(status, count),)
    decorator = node.decorator
    if decorator is not None:
        return lambda _, status: _decorated(decorator, cast("TreeStatus", status))
    return lambda _, status: (status,)


def _decorated(decorator: DecoratorSpec, status: TreeStatus) -> tuple[Target, ...]:
    """Return where a decorator leads; one that is RUNNING after the end of its child runs it again."""
    return tuple(0 if shown == "running" else shown for shown in decorator.statuses(status))


def _line(onward: str, count: int) -> Callable[[int, str], tuple[Target, ...]]:
    def lead(number: int, status: str) -> tuple[Target, ...]:
        if status in (onward, "skipped") and number + 1 < count:
            return (number + 1,)
        return (onward, status) if status == "skipped" else (status,)

    return lead


def _branch(status: str, count: int) -> Target:
    """Return the target of the condition of an `if_then_else` or `while_do_else`; without `else` failure ends it."""
    if status == "success":
        return 1
    return 2 if count > 2 else "failure"
