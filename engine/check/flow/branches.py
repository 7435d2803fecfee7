"""Merges the writes of concurrent branches for each outcome of their container.

Each branch writes into its own scope; the scopes are merged in document order. At an outcome whose condition names
branches, those have ended as required; the others may have been preempted anywhere.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property

from engine.check.analyzed_behavior import NodeAt
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.effect import Effect, join_effects
from engine.check.flow.flow_graph import FlowEdge
from engine.document.nodes.concurrency_condition import deciding, preemptable
from engine.document.nodes.node_spec import shared_keys

EdgesByNode = Mapping[str, Sequence[FlowEdge]]


def concurrency_ends(
    placed: NodeAt, children: Sequence[NodeAt], edges: EdgesByNode, entry: int, sites: DefinitionSites
) -> dict[str, int]:
    """Return the fact at each outcome of a concurrency container."""
    container = placed.node.concurrency
    branches = _Branches(children, edges, entry, shared=sites.all_bits(shared_keys(placed.node)) & ~sites.undefined)
    ends: dict[str, int] = {}
    for rule in deciding(container.rules) if container is not None else ():
        ends[rule.outcome] = ends.get(rule.outcome, 0) | branches.merged(rule.when if rule.needs_all else {})
    if container is not None and container.otherwise is not None:
        ends[container.otherwise] = ends.get(container.otherwise, 0) | branches.all_ended(
            sites, preemptable(container.rules)
        )
    return ends


def parallel_ends(placed: NodeAt, children: Sequence[NodeAt], edges: EdgesByNode, entry: int) -> dict[str, int]:
    """Return the fact at success and at failure of a parallel of a tree."""
    group = placed.node.parallel
    policy = "all" if group is None or isinstance(group, tuple) else group.policy
    branches = _Branches(children, edges, entry)
    names = [child.name for child in children if policy in ("all", "one") or child.name in policy]
    skipping = {child.name for child in children if any(edge.label == "skipped" for edge in edges[child.path])}
    if policy == "one":
        succeeded = 0
        for name in names:
            succeeded |= branches.merged({name: "success"})
    else:
        # A skipped child has written nothing.
        succeeded = branches.merged({name: "success" for name in names if name not in skipping})
    ends = {"success": succeeded, "failure": branches.merged({})}
    return {**ends, "skipped": entry} if skipping else ends


class _Branches:
    """The branches with writes, and their possible writes.

    A site belongs to one branch, so the writes of one branch can be subtracted from those of all. `shared` are the bits
    of keys that the branches share: any branch may be the last writer of those.
    """

    def __init__(self, children: Sequence[NodeAt], edges: EdgesByNode, entry: int, *, shared: int = 0) -> None:
        self._entry = entry
        self._shared = shared
        self._edges = {
            child.name: edges[child.path] for child in children if any(edge.effect.keys for edge in edges[child.path])
        }

    def merged(self, ended: Mapping[str, str]) -> int:
        """Return the fact when some branches have ended with the named outcomes."""
        named = [name for name in self._edges if name in ended] if ended else []
        taken_out = 0
        for name in named:
            taken_out |= self._perhaps[name]
        fact = self._entry | self._later[""] & ~taken_out
        for name in named:
            effect = self._ended(name, ended[name])
            # Possible writes of later branches override its certain writes.
            fact = fact & ~((effect.kill | effect.defines) & ~self._later[name] & ~self._shared) | effect.gen
        return fact

    def all_ended(self, sites: DefinitionSites, preempted: Collection[str]) -> int:
        """Return the fact when all branches have ended; those `preempted` may have stopped anywhere."""
        fact = self._entry
        for name, edges in self._edges.items():
            ended = join_effects(edge.effect for edge in edges)
            stopped = (
                join_effects(edge.effect.perhaps() for edge in edges).after(fact, sites) if name in preempted else 0
            )
            fact = ended.after(fact, sites) | stopped
        # The last writer of a shared key is unknown.
        return fact | self._entry & self._shared

    @cached_property
    def _perhaps(self) -> Mapping[str, int]:
        found: dict[str, int] = {}
        for name, edges in self._edges.items():
            gen = 0
            for edge in edges:
                gen |= edge.effect.gen
            found[name] = gen
        return found

    @cached_property
    def _later(self) -> Mapping[str, int]:
        """The possible writes of the branches after each one; under the empty name, those of all."""
        found: dict[str, int] = {}
        together = 0
        for name in reversed(self._edges):
            found[name] = together
            together |= self._perhaps[name]
        found[""] = together
        return found

    def _ended(self, name: str, label: str) -> Effect:
        ended = [edge.effect for edge in self._edges[name] if edge.label == label]
        if ended:
            return join_effects(ended)
        return join_effects(edge.effect.perhaps() for edge in self._edges[name])
