"""Facts about userdata keys at each node of a behavior: forward data flow over its containers.

The analysis has two passes. From the inside out, it summarises the effect of each container for each of
its outcomes. From the outside in, these effects give the fact before each node. Both passes visit every
node once, and loops of a machine a few times.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence

from engine.check.analyzed_behavior import AnalyzedBehavior, NodeAt, diversions, leaf_success
from engine.check.flow.branches import concurrency_ends, parallel_ends
from engine.check.flow.definition_sites import DefinitionSites, Origin
from engine.check.flow.effect import NO_EFFECT, Effect, combine_effects, container_effect, join_effects, write_effect
from engine.check.flow.flow_graph import FlowEdge, FlowGraph, machine_graph, tree_graph
from engine.check.flow.foreach_facts import collect_effect, foreach_facts
from engine.check.flow.key_reads import KeyRead
from engine.check.flow.post_condition_effects import PostConditionEffects, post_condition_fact
from engine.document.nodes.node_spec import shared_keys

BEHAVIOR = ""
"""The path of the declarations of the behavior itself: its parameters and its initial userdata."""
_STATUSES = ("success", "failure")


class DataFlow:
    """The facts about the keys of one behavior, given the keys that are read."""

    def __init__(self, subject: AnalyzedBehavior, sites: DefinitionSites) -> None:
        self.subject = subject
        self.sites = sites
        self.before: dict[str, int] = {}
        """The fact at the entry of each node, by path; unreachable nodes are absent."""
        self.inside: dict[str, int] = {}
        """The fact at the start of each container, its own keys included."""
        self.behind: dict[str, int] = {}
        """The fact at the end of a round of each foreach, inside the round, by path."""
        self.graphs: dict[str, FlowGraph] = {}
        """The children of each sequential container as a graph."""
        self.anywhere: dict[str, Effect] = {}
        """All possible writes of each node, as visible outside."""
        self.edges: dict[str, list[FlowEdge]] = {}
        """The outgoing edges of each node, labelled as in its container."""
        self._end = 0
        self._posts: dict[str, PostConditionEffects] = {}
        """The writes of the post-conditions of each part of a tree, by path."""
        self._ended: dict[str, list[FlowEdge]] = {}
        """The outgoing edges of parts with post-conditions, before these."""
        self._attempts: dict[str, Effect] = {}
        self._own: dict[str, frozenset[str]] = {}
        self._isolated: dict[str, bool] = {}
        if not sites:
            self.before = dict.fromkeys(subject.nodes, 0)  # no key is read
            return
        self._register()
        for placed in subject.postorder:
            self._sum_up(placed)
        self._spread()

    def own_keys(self, path: str) -> frozenset[str]:
        """Return the keys that a container declares in its own scope, as far as they are read."""
        return self._own.get(path, frozenset())

    def end(self) -> int:
        """Return the fact at the end of the behavior, for any outcome."""
        return self._end

    def enter(self, placed: NodeAt, fact: int) -> int:
        """Return the fact at the start of a container, given the fact before it."""
        own = self.own_keys(placed.path)
        shared = self.sites.all_bits(shared_keys(placed.node))
        if not own and not shared:
            return fact
        found = fact & ~self.sites.all_bits(own)
        for key, origin in _declared(placed):
            found |= self.sites.add(key, origin, placed.path, key)
        for child in self.subject.children(placed) if shared else ():
            # A branch may read it at any time as written by another one.
            effect = self.anywhere[child.path]
            found |= (effect.gen | effect.fresh) & shared
        return found

    def fact_at(self, read: KeyRead) -> int | None:
        """Return the fact where a key is read; None if unreachable."""
        if read.by == "post":
            path = read.placed.path
            before, halted = self.before.get(path), self.anywhere[path]
            return post_condition_fact(read, before, self._ended.get(path, ()), halted, self._posts[path], self.sites)
        facts = {"collect": self.behind, "shared": self.inside}.get(read.by, self.before)
        return facts.get(read.placed.path)

    def solve(self, placed: NodeAt, children: Sequence[NodeAt], entry: int) -> tuple[dict[int, int], dict[str, int]]:
        """Return the fact before each child, by number, and at each outcome, given the fact before a container."""
        if placed.node.foreach is not None:
            return self._rounds(placed, children[0], entry)
        inner = self.enter(placed, entry)
        graph = self.graphs.get(placed.path)
        if graph is not None:
            return graph.solve(inner, self.sites)
        if placed.node.concurrency is not None:
            ends = concurrency_ends(placed, children, self.edges, inner, self.sites)
        else:
            ends = parallel_ends(placed, children, self.edges, inner)
        return dict.fromkeys(range(len(children)), inner), ends

    def _rounds(self, placed: NodeAt, child: NodeAt, entry: int) -> tuple[dict[int, int], dict[str, int]]:
        rounds = placed.node.foreach
        if rounds is None:
            return {}, {}
        found = foreach_facts(
            rounds,
            self.edges[child.path],
            entry,
            onward=frozenset(rounds.next) or self.subject.nominal[child.path],
            collecting=collect_effect(placed, self.sites),
            enter=lambda fact: self.enter(placed, fact),
            seen=lambda effect: self._seen(placed, effect),
            sites=self.sites,
        )
        self.behind[placed.path] = found.behind
        return {0: found.before} if found.before is not None else {}, found.ends

    def _register(self) -> None:
        """Register all sites before the analysis: an effect needs the bits that it replaces."""
        document = self.subject.behavior.document
        for key in document.parameters:
            self.sites.add(key, "parameter", BEHAVIOR, key)
        for key in document.userdata:
            self.sites.add(key, "userdata", BEHAVIOR, key)
        nodes = self.subject.nodes
        for placed in nodes.values():
            around = nodes[placed.parent] if placed.parent is not None else None
            self._isolated[placed.path] = around is not None and (
                around.kind in ("concurrency", "parallel") or self._isolated[around.path]
            )
            if placed.node.post is not None:
                self._posts[placed.path] = PostConditionEffects(placed, self.sites)
            if placed.path in self.subject.inside:
                own = _declared(placed)
                self._own[placed.path] = frozenset(key for key, _ in own if key in self.sites)
                for key, origin in own:
                    self.sites.add(key, origin, placed.path, key)
                collect_effect(placed, self.sites)
            else:
                self._written(placed)

    def _sum_up(self, placed: NodeAt) -> None:
        children = self.subject.children(placed)
        if children:
            inside = combine_effects(self.anywhere[child.path].perhaps() for child in children)
            seen = self._seen(placed, inside)
            if placed.node.foreach is not None:
                seen = combine_effects((seen, collect_effect(placed, self.sites).perhaps()))
            self.anywhere[placed.path] = seen
            graph = self._graph(placed, children)
            if graph is not None:
                self.graphs[placed.path] = graph
            # The root needs no summary: it has no container.
            ends = self._container_ends(placed, children) if placed.parent is not None else {}
        else:
            ends = self._leaf_ends(placed)
            writes = any(effect.keys for effect in ends.values())
            self.anywhere[placed.path] = (
                join_effects(effect.perhaps() for effect in ends.values()) if writes else NO_EFFECT
            )
        edges = self._edges(placed, ends, leaf=not children)
        post = self._posts.get(placed.path)
        if post is not None:
            self._ended[placed.path] = edges
            edges = [FlowEdge(edge.label, edge.effect.then(post.at(edge.label))) for edge in edges]
            self.anywhere[placed.path] = combine_effects((self.anywhere[placed.path], post.anywhere))
        self.edges[placed.path] = edges

    def _leaf_ends(self, placed: NodeAt) -> dict[str, Effect]:
        node = placed.node
        signature = self.subject.signature(node)
        written = self._written(placed)
        if signature is not None:
            if not written:
                return dict.fromkeys(signature.outcomes, NO_EFFECT)
            left_out = signature.unwritten
            return {
                outcome: combine_effects(
                    effect for key, effect in written.items() if key not in left_out.get(outcome, ())
                )
                for outcome in signature.outcomes
            }
        effect = combine_effects(written.values())
        if node.behaviour is not None:
            return dict.fromkeys(_STATUSES, effect.perhaps())
        # The outcomes of a missing state or behavior are unknown; the connected ones are used.
        outcomes = self.subject.outcomes.get(placed.path) or tuple(node.transitions) or _STATUSES
        return dict.fromkeys(outcomes, effect)

    def _written(self, placed: NodeAt) -> dict[str, Effect]:
        """Return the effect of writing each output of a leaf that is read."""
        node = placed.node
        signature = self.subject.signature(node)
        origin: Origin = "reference" if node.behavior is not None else "output"
        names = signature.outputs if signature is not None else node.outputs
        found: dict[str, Effect] = {}
        for name in names:
            key = node.outputs.get(name, name)
            if key in self.sites:
                # An output that repeats a parameter differs between states.
                alike = signature is not None and signature.passed_on(name) is None
                group = f"{placed.parent} {node.state}" if alike else ""
                found[name] = write_effect(key, self.sites.add(key, origin, placed.path, name, group=group), self.sites)
        return found

    def _container_ends(self, placed: NodeAt, children: Sequence[NodeAt]) -> dict[str, Effect]:
        keys = frozenset[str]().union(*(self.anywhere[child.path].keys for child in children))
        keys |= self.anywhere[placed.path].keys
        if not keys:
            labels = self._statuses(placed) if placed.is_part else self.subject.outcomes.get(placed.path, ())
            return dict.fromkeys(labels, NO_EFFECT)
        of_defined = self.solve(placed, children, self.sites.entries)[1]
        of_undefined = self.solve(placed, children, self.sites.undefined)[1]
        whole = {
            label: container_effect(keys, of_defined[label], of_undefined[label], self.sites) for label in of_defined
        }
        if placed.node.foreach is not None:
            return whole  # the scope of each round has already ended
        return {label: self._seen(placed, effect) for label, effect in whole.items()}

    def _statuses(self, placed: NodeAt) -> tuple[str, ...]:
        return (*_STATUSES, "skipped") if "skipped" in self.subject.statuses[placed.path] else _STATUSES

    def _seen(self, placed: NodeAt, effect: Effect) -> Effect:
        """Return an effect as visible outside the scope of a container, if it has one."""
        if placed.is_part:
            return effect
        seen = effect.hidden(self.own_keys(placed.path), self.sites)
        # The scope of a concurrent branch holds all of its writes.
        return seen if self._isolated[placed.path] else seen.scoped()

    def _graph(self, placed: NodeAt, children: Sequence[NodeAt]) -> FlowGraph | None:
        machine = placed.node.sequential
        if machine is not None:
            return machine_graph(children, machine.initial, self.edges)
        if placed.node.concurrency is not None or placed.node.parallel is not None or placed.node.foreach is not None:
            return None
        halted = {path: post.halted for path, post in self._posts.items()}
        halted |= {child.path: self.anywhere[child.path] for child in children if child.path in self.subject.inside}
        return tree_graph(placed, children, self.edges, defaultdict(lambda: NO_EFFECT, halted))

    def _edges(self, placed: NodeAt, ends: dict[str, Effect], *, leaf: bool) -> list[FlowEdge]:
        node = placed.node
        if node.is_disabled and placed.in_tree:
            return [FlowEdge("skipped", NO_EFFECT)]
        before = self._earlier_attempts(placed, ends, leaf=leaf)
        stopped = before.perhaps() if leaf else self.anywhere[placed.path]
        found = [FlowEdge(to, NO_EFFECT if keys[0] == "guard" else stopped) for keys, to in diversions(node).items()]
        leading = placed.container is not None and placed.container.sequential is not None
        good = leaf_success(placed, self.subject) if placed.in_tree and not placed.is_part else None
        for outcome, effect in ends.items():
            label: str | None = outcome
            if good is not None:
                label = "success" if outcome in good else "failure"
            elif leading:
                label = node.transitions.get(outcome)
            if label is not None:
                found.append(FlowEdge(label, effect.repeated(before)))
        return found

    def _earlier_attempts(self, placed: NodeAt, ends: dict[str, Effect], *, leaf: bool) -> Effect:
        retry = placed.node.retry
        if retry is None or retry.child is not None:
            return NO_EFFECT
        effects = [ends[outcome] for outcome in retry.outcomes if outcome in ends]
        if retry.errors and not leaf:
            effects.append(self.anywhere[placed.path])
        attempts = self._attempts[placed.path] = join_effects(effects).perhaps()
        return attempts

    def _spread(self) -> None:
        document = self.subject.behavior.document
        declared = [key for key in (*document.parameters, *document.userdata) if key in self.sites]
        entry = self.sites.undefined & ~self.sites.all_bits(declared)
        for key in document.parameters:
            entry |= self.sites.add(key, "parameter", BEHAVIOR, key)
        for key in document.userdata:
            entry |= self.sites.add(key, "userdata", BEHAVIOR, key)
        self._reach("root", entry)
        for path, placed in self.subject.nodes.items():
            children = self.subject.children(placed)
            fact = self.before.get(path)
            if not children or fact is None:
                continue
            self.inside[path] = self.enter(placed, fact)
            facts, ends = self.solve(placed, children, fact)
            for number, before in facts.items():
                self._reach(children[number].path, before)
            if path == "root":
                self._end = self._joined(placed, fact, ends.values())
        if "root" not in self.subject.inside:
            effects = [edge.effect.after(self.before["root"], self.sites) for edge in self.edges["root"]]
            self._end = self._joined(self.subject.nodes["root"], self.before["root"], effects)

    def _joined(self, placed: NodeAt, before: int, ends: Iterable[int]) -> int:
        """Return the fact after the root: its own keys are removed, and a timeout may have stopped it anywhere."""
        found = self.anywhere[placed.path].after(before, self.sites) if diversions(placed.node) else 0
        for end in ends:
            found |= end
        own = self.sites.all_bits(self.own_keys(placed.path))
        return found & ~own | before & own

    def _reach(self, path: str, fact: int) -> None:
        attempts = self._attempts.get(path)
        self.before[path] = fact | attempts.after(fact, self.sites) if attempts is not None else fact


def _declared(placed: NodeAt) -> list[tuple[str, Origin]]:
    """Return the keys that a container declares in its own scope."""
    found: list[tuple[str, Origin]] = [(key, "userdata") for key in placed.node.userdata]
    rounds = placed.node.foreach
    if rounds is not None:
        found.append((rounds.item, "item"))
        if rounds.index is not None:
            found.append((rounds.index, "index"))
    return found
