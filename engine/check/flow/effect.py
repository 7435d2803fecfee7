"""The effect of a node on the facts about userdata keys, from its entry to one of its outcomes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from engine.check.flow.definition_sites import DefinitionSites


@dataclass(frozen=True)
class Effect:
    """The writes for keys that were defined before (`gen`, `kill`), and that were not (`fresh`, `defines`).

    `keys` may be written. `gen` are the sites that they may then come from; keys in `kill` lose their
    previous sites. A write inside a container with its own scope is discarded if the key is not defined
    outside, so the two cases differ; in a `plain` effect they are equal.
    """

    keys: frozenset[str] = frozenset()
    gen: int = 0
    kill: int = 0
    fresh: int = 0
    defines: int = 0

    @property
    def plain(self) -> bool:
        """True if the writes do not depend on whether the keys were defined."""
        return self.gen == self.fresh

    def after(self, fact: int, sites: DefinitionSites) -> int:
        """Return the fact after the node, given the fact before it."""
        if not self.keys:
            return fact
        if self.gen == self.fresh:
            return fact & ~(self.kill | self.defines) | self.gen
        found = fact & ~(self.kill | self.defines)
        for key in self.keys:
            defined, undefined = sites.defined_bits(key), sites.undefined_bit(key)
            if fact & defined:
                found |= self.gen & defined
            if fact & undefined:
                found |= self.fresh & defined
        return found

    def perhaps(self) -> Effect:
        """Return the effect of a node that may have been stopped anywhere."""
        return Effect(self.keys, self.gen, 0, self.fresh, 0)

    def repeated(self, before: Effect) -> Effect:
        """Return the effect after any number of repetitions of `before`, an effect of the same node."""
        if not before.keys:
            return self
        gen = self.gen | before.gen & ~self.kill
        return Effect(self.keys | before.keys, gen, self.kill, self.fresh | before.fresh & ~self.kill, self.defines)

    def then(self, after: Effect) -> Effect:
        """Return the effect of this followed by `after`, which is plain."""
        if not after.keys:
            return self
        lost = after.kill | after.defines
        return Effect(
            self.keys | after.keys,
            self.gen & ~lost | after.gen,
            self.kill | after.kill,
            self.fresh & ~lost | after.fresh,
            self.defines | after.defines,
        )

    def hidden(self, own: frozenset[str], sites: DefinitionSites) -> Effect:
        """Return the effect outside a scope that declares these keys."""
        if not self.keys & own:
            return self
        seen = ~sites.all_bits(own)
        return Effect(self.keys - own, self.gen & seen, self.kill & seen, self.fresh & seen, self.defines & seen)

    def scoped(self) -> Effect:
        """Return the effect outside a scope that holds the keys that are not defined outside."""
        return Effect(self.keys, self.gen, self.kill) if self.keys else self


NO_EFFECT = Effect()


def write_effect(key: str, site: int, sites: DefinitionSites) -> Effect:
    """Return the effect of writing one key."""
    if not site:
        return NO_EFFECT
    return Effect(frozenset((key,)), site, sites.defined_bits(key), site, sites.undefined_bit(key))


def combine_effects(effects: Iterable[Effect]) -> Effect:
    """Return the effect of writing different keys at once."""
    found = NO_EFFECT
    for effect in effects:
        found = Effect(
            found.keys | effect.keys,
            found.gen | effect.gen,
            found.kill | effect.kill,
            found.fresh | effect.fresh,
            found.defines | effect.defines,
        )
    return found


def join_effects(effects: Iterable[Effect]) -> Effect:
    """Return the effect of one of several alternatives; `NO_EFFECT` for none."""
    found: Effect | None = None
    for effect in effects:
        if found is None:
            found = effect
            continue
        found = Effect(
            found.keys | effect.keys,
            found.gen | effect.gen,
            found.kill & effect.kill,
            found.fresh | effect.fresh,
            found.defines & effect.defines,
        )
    return found or NO_EFFECT


def container_effect(keys: frozenset[str], of_defined: int, of_undefined: int, sites: DefinitionSites) -> Effect:
    """Return the effect of a container from the fact at one of its outcomes.

    Args:
        keys: The keys that may be written inside.
        of_defined: The fact at the outcome if every key is defined at the entry.
        of_undefined: The fact at the outcome if no key is defined at the entry.
        sites: The definition sites.
    """
    gen = kill = fresh = defines = 0
    for key in keys:
        defined, undefined = sites.defined_bits(key), sites.undefined_bit(key)
        entry = defined & sites.entries
        gen |= of_defined & defined & ~entry
        kill |= 0 if of_defined & entry else defined
        fresh |= of_undefined & defined & ~entry
        defines |= 0 if of_undefined & undefined else undefined
    return Effect(keys, gen, kill, fresh, defines)
