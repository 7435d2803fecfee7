"""What holds in the rounds of a foreach: each has a scope of its own, and `collect` appends outside."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from engine.check.flow.effect import NOTHING, Effect, either, together, writing
from engine.check.flow.graph import Way
from engine.check.flow.site import Sites
from engine.check.subject import Placed
from engine.document.node import FOREACH_OUTCOMES, ForEach

EXHAUSTED, BROKEN = FOREACH_OUTCOMES


@dataclass(frozen=True)
class Rounds:
    """The facts of a foreach: in each round, behind a round that others may follow, and at its ends."""

    before: int | None
    """None where there is certainly no round."""
    behind: int
    ends: dict[str, int]


def foreach_facts(
    rounds: ForEach,
    child: Sequence[Way],
    entry: int,
    *,
    onward: frozenset[str],
    collecting: Effect,
    enter: Callable[[int], int],
    seen: Callable[[Effect], Effect],
    sites: Sites,
) -> Rounds:
    """Return what holds in a foreach when `entry` holds before it.

    Args:
        rounds: The container.
        child: The ways out of its child.
        entry: What holds outside.
        onward: The ends of the child after which the next round begins.
        collecting: The effect of `collect`.
        enter: Gives what holds where a round begins, from what holds outside.
        seen: Gives what is seen of an effect outside the round.
        sites: The places.
    """
    if not rounds.items and not rounds.times:
        return Rounds(None, 0, {EXHAUSTED: entry})
    again = [way.effect for way in child if way.label in onward]
    inside = either(again)
    outside = seen(inside)
    loop, after = entry, 0
    while again:
        after = collecting.after(outside.after(loop, sites), sites)
        if after | loop == loop:
            break
        loop |= after
    broken = 0
    for way in child:
        if way.label not in onward:
            broken |= seen(way.effect).after(loop, sites)
    before = enter(loop)
    exhausted = after if again and at_least_one(rounds) else entry | after
    ends = {EXHAUSTED: exhausted, BROKEN: broken} if broken else {EXHAUSTED: exhausted}
    return Rounds(before, inside.after(before, sites) if again else 0, ends)


def collecting(placed: Placed, sites: Sites) -> Effect:
    """Return the effect of `collect`, NOTHING for other nodes."""
    rounds = placed.node.foreach
    if rounds is None:
        return NOTHING
    return together(
        writing(key, sites.add(key, "collect", placed.path, source), sites) for source, key in rounds.collect.items()
    )


def at_least_one(rounds: ForEach) -> bool:
    """Tell whether there is certainly a round."""
    if isinstance(rounds.items, list):
        return bool(rounds.items)
    return isinstance(rounds.times, int) and rounds.times > 0
