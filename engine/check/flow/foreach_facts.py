"""The facts in the rounds of a foreach: each round has its own scope, and `collect` appends outside."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from engine.check.analyzed_behavior import NodeAt
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.effect import NO_EFFECT, Effect, combine_effects, join_effects, write_effect
from engine.check.flow.flow_graph import FlowEdge
from engine.document.nodes.node_spec import FOREACH_OUTCOMES, ForEachSpec

EXHAUSTED, BROKEN = FOREACH_OUTCOMES


@dataclass(frozen=True)
class ForEachFacts:
    """The facts of a foreach: in each round, after a round with a successor, and at its outcomes."""

    before: int | None
    """None if there is certainly no round."""
    behind: int
    ends: dict[str, int]


def foreach_facts(
    rounds: ForEachSpec,
    child: Sequence[FlowEdge],
    entry: int,
    *,
    onward: frozenset[str],
    collecting: Effect,
    enter: Callable[[int], int],
    seen: Callable[[Effect], Effect],
    sites: DefinitionSites,
) -> ForEachFacts:
    """Return the facts of a foreach, given the fact `entry` before it.

    Args:
        rounds: The container.
        child: The outgoing edges of its child.
        entry: The fact outside.
        onward: The outcomes of the child after which the next round begins.
        collecting: The effect of `collect`.
        enter: Returns the fact at the start of a round from the fact outside.
        seen: Returns an effect as visible outside the round.
        sites: The definition sites.
    """
    if not rounds.items and not rounds.times:
        return ForEachFacts(None, 0, {EXHAUSTED: entry})
    again = [edge.effect for edge in child if edge.label in onward]
    inside = join_effects(again)
    outside = seen(inside)
    loop, after = entry, 0
    while again:
        after = collecting.after(outside.after(loop, sites), sites)
        if after | loop == loop:
            break
        loop |= after
    broken = 0
    for edge in child:
        if edge.label not in onward:
            broken |= seen(edge.effect).after(loop, sites)
    before = enter(loop)
    exhausted = after if again and has_round(rounds) else entry | after
    ends = {EXHAUSTED: exhausted, BROKEN: broken} if broken else {EXHAUSTED: exhausted}
    return ForEachFacts(before, inside.after(before, sites) if again else 0, ends)


def collect_effect(placed: NodeAt, sites: DefinitionSites) -> Effect:
    """Return the effect of `collect`, NOTHING for other nodes."""
    rounds = placed.node.foreach
    if rounds is None:
        return NO_EFFECT
    return combine_effects(
        write_effect(key, sites.add(key, "collect", placed.path, source), sites)
        for source, key in rounds.collect.items()
    )


def has_round(rounds: ForEachSpec) -> bool:
    """Return whether there is certainly a round."""
    if isinstance(rounds.items, list):
        return bool(rounds.items)
    return isinstance(rounds.times, int) and rounds.times > 0
