"""A container as a graph: where it begins, where each child leads, and what its ends are called."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from engine.check.analyzed_behavior import NodeAt
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.effect import Effect
from engine.check.graph_components import strong_components
from engine.document.node_spec import NodeSpec, RemapSpec

Target = int | str
"""The number of a child, or the name of an end."""


@dataclass(frozen=True)
class FlowEdge:
    """One way out of a child: what it is called, and what has been written on it."""

    label: str
    effect: Effect


@dataclass(frozen=True)
class FlowGraph:
    """Children by number; `arrows` says for each where its ways lead."""

    entries: tuple[int, ...]
    arrows: Sequence[Sequence[tuple[Effect, Target]]]

    @cached_property
    def backward(self) -> Mapping[int, Sequence[int]]:
        """The children that lead to each child."""
        found: dict[int, list[int]] = {}
        for source, ways in enumerate(self.arrows):
            for _, to in ways:
                if isinstance(to, int):
                    found.setdefault(to, []).append(source)
        return found

    @cached_property
    def _ranks(self) -> Mapping[int, int]:
        """The place of each child that can be reached in `order`."""
        return {child: number for number, child in enumerate(self.order())}

    def _kept(self, sites: DefinitionSites) -> Mapping[int, int]:
        """Return what is certainly known before each child on a loop: what one child of the loop alone writes.

        Without knowing it beforehand, a chain of loops is gone through once for each of its links.
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
        """Return the children that can be reached, those before others that can only be reached through them."""
        seen = set(self.entries)
        finished: list[int] = []
        for start in self.entries:
            due = [(start, iter(self.arrows[start]))]
            while due:
                child, ways = due[-1]
                following = next((to for _, to in ways if isinstance(to, int) and to not in seen), None)
                if following is None:
                    finished.append(child)
                    due.pop()
                else:
                    seen.add(following)
                    due.append((following, iter(self.arrows[following])))
        return finished[::-1]

    def solve(self, entry: int, sites: DefinitionSites) -> tuple[dict[int, int], dict[str, int]]:
        """Return what holds before each child that can be reached, and at each end, when `entry` holds at the entry."""
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


def machine_graph(children: Sequence[NodeAt], initial: str, ways: Mapping[str, Sequence[FlowEdge]]) -> FlowGraph:
    """Return the graph of a machine; the ways of its children are called by their targets."""
    numbers = {child.name: number for number, child in enumerate(children)}
    arrows = [[(way.effect, numbers.get(way.label, way.label)) for way in ways[child.path]] for child in children]
    return FlowGraph((numbers[initial],) if initial in numbers else (), arrows)


def tree_graph(
    placed: NodeAt, children: Sequence[NodeAt], ways: Mapping[str, Sequence[FlowEdge]], halted: Mapping[str, Effect]
) -> FlowGraph:
    """Return the graph of a tree, composite or decorator; all ways are called by statuses.

    `halted` is what a child may have written that is stopped, by its path.
    """
    lead = _leads(placed.node, len(children))
    arrows = [
        [(way.effect, to) for way in ways[child.path] for to in lead(number, way.label)]
        for number, child in enumerate(children)
    ]
    if placed.node.while_do_else is not None:
        # What it runs may be stopped at any time, when the condition says something else.
        arrows[1:] = [[*found, (halted[child.path], 0)] for found, child in zip(arrows[1:], children[1:], strict=True)]
    return FlowGraph((0,), arrows)


def _leads(node: NodeSpec, count: int) -> Callable[[int, str], tuple[Target, ...]]:
    """Return where child number i leads after a status; a part that may fail by itself leads to failure as well."""
    if node.sequence is not None or node.selector is not None:
        return _line("success" if node.sequence is not None else "failure", count)
    if node.tree is not None:
        return lambda _, status: ("success" if status == "skipped" else status,)
    if node.if_then_else is not None or node.while_do_else is not None:
        return lambda number, status: (status,) if number else (_branch(status, count),)
    if node.inverter is not None:
        opposite = {"success": "failure", "failure": "success"}
        return lambda _, status: (opposite.get(status, status),)
    if node.remap is not None:
        return _remap(node.remap)
    if node.condition is not None:
        waited = node.condition.status
        return lambda _, status: (
            (status,) if status == "skipped" else ("success", 0) if waited in (status, "running") else (0,)
        )
    if node.retry is not None:
        return lambda _, status: (0, "failure") if status == "failure" else (status,)
    if node.repeat is not None:
        return lambda _, status: (0, "success") if status == "success" else (status,)
    if node.timeout is not None or node.guard is not None or node.cooldown is not None:
        closed = node.guard.to if node.guard is not None and node.guard.to is not None else "failure"
        return lambda _, status: (status, closed)
    return lambda _, status: (status,)


def _line(onward: str, count: int) -> Callable[[int, str], tuple[Target, ...]]:
    def lead(number: int, status: str) -> tuple[Target, ...]:
        if status in (onward, "skipped") and number + 1 < count:
            return (number + 1,)
        return (onward, status) if status == "skipped" else (status,)

    return lead


def _branch(status: str, count: int) -> Target:
    """Return where the condition of an `if_then_else` or `while_do_else` leads; without `else` its failure ends it."""
    if status == "success":
        return 1
    return 2 if count > 2 else "failure"


def _remap(remap: RemapSpec) -> Callable[[int, str], tuple[Target, ...]]:
    shown = {"success": remap.success, "failure": remap.failure}

    def lead(_: int, status: str) -> tuple[Target, ...]:
        if status not in shown:
            return (status,)
        # What is shown as RUNNING is ticked again from the start.
        ends = {0 if found == "running" else found for found in (shown[status], remap.running)}
        return tuple(sorted(ends, key=str))

    return lead
