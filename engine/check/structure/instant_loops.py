"""Checks for loops in which no time passes and nothing changes that could end them.

A state class declares that it is `instant`. A container is instant for an outcome that a path through instant
states reaches. A loop of such paths is an error when no state in it writes a value that the loop decides on: it
never ends. A loop that counts is not reported; a run limits it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt
from engine.check.finding import Finding
from engine.check.flow.key_reads import KeyRead, assignments
from engine.check.graph_components import strong_components
from engine.document.nodes.concurrency_condition import deciding
from engine.document.nodes.node_spec import FOREACH_OUTCOMES, ConcurrencySpec, NodeSpec

_SHOWN = 6
_NEVER: frozenset[str] = frozenset()


def check_loops(subject: AnalyzedBehavior, read: Iterable[KeyRead]) -> Iterator[Finding]:
    """Find endless loops of a machine through instant states."""
    instant = InstantOutcomes(subject)
    if not instant.any:
        return
    keys: dict[str, set[str]] = {}
    for each in read:
        keys.setdefault(each.placed.path, set()).add(each.key)
    for placed in subject.due:
        if placed.node.sequential is not None:
            yield from _check_machine(subject, placed, instant, keys)


class InstantOutcomes:
    """The outcomes with which each node can end in the instant in which it is entered."""

    def __init__(self, subject: AnalyzedBehavior, others: dict[int, InstantOutcomes] | None = None) -> None:
        self._subject = subject
        self._others = others if others is not None else {}
        self.ends: dict[str, frozenset[str]] = {}
        self.any = False
        takes_time = {name for name, signature in subject.signatures.items() if not signature.instant}
        for placed in subject.postorder:
            node = placed.node
            found = self.ends[placed.path] = _NEVER if node.state in takes_time else self._own(placed)
            self.any = self.any or bool(found) or node.guard is not None

    def instant_targets(self, placed: NodeAt) -> tuple[str, ...]:
        """Return the targets that a child of a machine can reach in the same instant."""
        node, ends = placed.node, self.ends[placed.path]
        if not ends and node.guard is None:
            return ()
        found = [to for outcome, to in node.transitions.items() if outcome in ends]
        if node.guard is not None and node.guard.to is not None:
            found.append(node.guard.to)
        return tuple(found)

    def _own(self, placed: NodeAt) -> frozenset[str]:
        node = placed.node
        if node.is_disabled:
            return frozenset(("skipped" if placed.in_tree else node.passes_with,))
        signature = self._subject.signature(node)
        if signature is not None:
            return frozenset(signature.outcomes) if signature.instant and not _waits(node) else _NEVER
        children = self._subject.children(placed)
        referred = self._subject.referred(node)
        if referred is not None:
            return self._referred(referred)
        if node.sequential is not None:
            return self._through(children, node.sequential.initial)
        if node.foreach is not None:
            ends = self._seen(children[0])
            onward = frozenset(node.foreach.next) or self._subject.nominal[children[0].path]
            exhausted, broken = FOREACH_OUTCOMES
            if not node.foreach.items and not node.foreach.times:
                return frozenset((exhausted,))
            return frozenset(([exhausted] if ends & onward else []) + ([broken] if ends - onward else []))
        if node.concurrency is not None:
            return self._of_branches(node.concurrency, children)
        return self._of_tree(placed, children)

    def _referred(self, referred: AnalyzedBehavior) -> frozenset[str]:
        known = self._others.get(id(referred))
        if known is None:
            known = self._others[id(referred)] = InstantOutcomes(referred, self._others)
        return known.ends["root"]

    def _through(self, children: Sequence[NodeAt], initial: str) -> frozenset[str]:
        by_name = {child.name: child for child in children}
        reached: set[str] = set()
        due = [initial]
        while due:
            name = due.pop()
            if name not in reached:
                reached.add(name)
                due += self.instant_targets(by_name[name]) if name in by_name else ()
        return frozenset(reached - set(by_name))

    def _of_branches(self, container: ConcurrencySpec, children: Sequence[NodeAt]) -> frozenset[str]:
        seen = {child.name: self._seen(child) for child in children}
        found = {
            rule.outcome
            for rule in deciding(container.rules)
            if rule.holds(lambda name, outcome: outcome in seen.get(name, ()))
        }
        if container.otherwise is not None and all(seen.values()):
            found.add(container.otherwise)
        return frozenset(found)

    def _of_tree(self, placed: NodeAt, children: Sequence[NodeAt]) -> frozenset[str]:
        """Return whether a tree is instant: when each of its leaves is; other trees are not analysed."""
        for child in children:
            by_status = child.is_part or child.node.is_disabled
            due = self._subject.statuses[child.path] if by_status else self._subject.outcomes.get(child.path, ("",))
            if not self.ends[child.path].issuperset(due):
                return frozenset()
        if not children:
            return frozenset()
        found = self._subject.statuses.get(placed.path) or self._subject.statuses[children[0].path]
        if placed.node.decorator is not None:
            found -= placed.node.decorator.late
        return found if placed.is_part else frozenset("success" if end == "skipped" else end for end in found)

    def _seen(self, child: NodeAt) -> frozenset[str]:
        guard = child.node.guard
        closed = [guard.to] if guard is not None and guard.to is not None else []
        return self.ends[child.path].union(closed)


def _waits(node: NodeSpec) -> bool:
    """Return whether a node may wait before a retry."""
    return node.retry is not None and node.retry.child is None and node.retry.backoff_s > 0


def _check_machine(
    subject: AnalyzedBehavior, placed: NodeAt, instant: InstantOutcomes, keys: Mapping[str, set[str]]
) -> Iterator[Finding]:
    children = subject.children(placed)
    if not any(instant.ends[child.path] or child.node.guard is not None for child in children):
        return
    by_name = {child.name: child for child in children}
    ranks = {child.name: rank for rank, child in enumerate(children)}
    leads = {child.name: [to for to in instant.instant_targets(child) if to in by_name] for child in children}
    for loop in _loops(leads):
        inside = [by_name[name] for name in loop]
        if _can_change(subject, inside, keys):
            continue
        first = min(inside, key=lambda child: ranks[child.name])
        start = loop.index(first.name)
        shown = [*loop[start:], *loop[:start]]
        names = shown if len(shown) <= _SHOWN else [*shown[: _SHOWN - 1], "…"]
        message = f"no time passes in the loop {' → '.join([*names, first.name])}, and no state changes its decisions"
        hint = "let one of these states wait, or write a value that the loop decides on"
        yield subject.finding("instant-loop", message, first.path, hint=hint)


def _can_change(subject: AnalyzedBehavior, loop: Sequence[NodeAt], keys: Mapping[str, set[str]]) -> bool:
    """Return whether a node in the loop writes a key that a node in it reads."""
    read: set[str] = set()
    written: set[str] = set()
    due = list(loop)
    while due:
        placed = due.pop()
        due += subject.children(placed)
        read |= keys.get(placed.path, set())
        signature = subject.signature(placed.node)
        written |= set(placed.node.outputs.values())
        if signature is not None:
            written |= {key for key in signature.outputs if key not in placed.node.outputs}
        written |= {key for _, _, key in assignments(placed)}
        if placed.node.foreach is not None:
            written |= set(placed.node.foreach.collect.values())
    return bool(read & written)


def _loops(leads: Mapping[str, Sequence[str]]) -> Iterator[list[str]]:
    """Yield one cycle of each strongly connected component that has one."""
    for part in strong_components(leads):
        members = set(part)
        if len(part) == 1 and part[0] not in leads[part[0]]:
            continue
        yield _cycle(part, members, leads)


def _cycle(part: Sequence[str], members: set[str], leads: Mapping[str, Sequence[str]]) -> list[str]:
    visited = [part[0]]
    while True:
        onward = next((to for to in leads[visited[-1]] if to in members), visited[0])
        if onward in visited:
            return visited[visited.index(onward) :]
        visited.append(onward)
