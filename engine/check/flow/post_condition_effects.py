"""The writes of the post-conditions of a part of a tree, and the facts where they are evaluated."""

from __future__ import annotations

from collections.abc import Sequence

from engine.check.analyzed_behavior import NodeAt
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.effect import NO_EFFECT, Effect, combine_effects, write_effect
from engine.check.flow.flow_graph import FlowEdge
from engine.check.flow.key_reads import KeyRead, assignments

_AFTER = {"success": ("on_success", "always"), "failure": ("on_failure", "always")}
_HALTED = ("on_halted",)


class PostConditionEffects:
    """The writes of the post-conditions of one part, in order of execution."""

    def __init__(self, placed: NodeAt, sites: DefinitionSites) -> None:
        self.writes: list[tuple[str, str, Effect]] = []
        """Event, key and effect; keys that are not read have none."""
        for _, when, key in assignments(placed):
            site = sites.add(key, "post", placed.path, f"{when} {key}")
            self.writes.append((when, key, write_effect(key, site, sites)))

    def at(self, label: str) -> Effect:
        """Return the effect after the outcome with this label."""
        return self._joined(_AFTER.get(label, ()))

    @property
    def halted(self) -> Effect:
        """The effect of being halted."""
        return self._joined(_HALTED)

    @property
    def anywhere(self) -> Effect:
        """All possible writes."""
        return combine_effects(effect.perhaps() for _, _, effect in self.writes)

    def _joined(self, due: Sequence[str]) -> Effect:
        found = NO_EFFECT
        for when, _, effect in self.writes:
            found = found.then(effect) if when in due else found
        return found


def post_condition_fact(
    read: KeyRead,
    before: int | None,
    edges: Sequence[FlowEdge],
    halted: Effect,
    post: PostConditionEffects,
    sites: DefinitionSites,
) -> int | None:
    """Return the fact where a post-condition is evaluated; None if the part is never entered.

    Args:
        read: The read; its keys identify the post-condition.
        before: The fact before the part.
        edges: The outgoing edges of the part, before its post-conditions.
        halted: The possible writes if it is halted.
        post: All its post-conditions.
        sites: The definition sites.
    """
    if before is None:
        return None
    _, when, key = read.keys
    found = 0
    for label, due in _AFTER.items():
        for edge in edges if when in due else ():
            if edge.label == label:
                found |= _until(edge.effect.after(before, sites), str(when), str(key), due, post, sites)
    if when in _HALTED:
        found |= _until(halted.after(before, sites), str(when), str(key), _HALTED, post, sites)
    return found


def _until(
    fact: int, when: str, key: str, due: Sequence[str], post: PostConditionEffects, sites: DefinitionSites
) -> int:
    for other, written, effect in post.writes:
        if (other, written) == (when, key):
            break
        fact = effect.after(fact, sites) if other in due else fact
    return fact
