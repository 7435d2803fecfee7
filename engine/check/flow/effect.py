"""What a node does to the facts about userdata keys on its way from entry to one of its ends."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from engine.check.flow.definition_sites import DefinitionSites


@dataclass(frozen=True)
class Effect:
    """What is written where the key was defined before (`gen`, `kill`), and where it was not (`fresh`, `defines`).

    `keys` are those that may be written. `gen` are the sites they may then come from; keys in
    `kill` keep nothing of what they were. A write inside a container with a scope of its own is
    lost where the key is not defined outside, so the two cases differ; they do not in a `plain` effect.
    """

    keys: frozenset[str] = frozenset()
    gen: int = 0
    kill: int = 0
    fresh: int = 0
    defines: int = 0

    @property
    def plain(self) -> bool:
        """True when it writes the same whether or not the keys were defined."""
        return self.gen == self.fresh

    def after(self, fact: int, sites: DefinitionSites) -> int:
        """Return what holds behind the node when `fact` holds before it."""
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
        """Return the effect of a node that may have stopped anywhere on its way."""
        return Effect(self.keys, self.gen, 0, self.fresh, 0)

    def repeated(self, before: Effect) -> Effect:
        """Return the effect when `before`, of the same node, may have happened any number of times first."""
        if not before.keys:
            return self
        gen = self.gen | before.gen & ~self.kill
        return Effect(self.keys | before.keys, gen, self.kill, self.fresh | before.fresh & ~self.kill, self.defines)

    def then(self, after: Effect) -> Effect:
        """Return the effect of this and then of `after`, which writes the same whatever was defined."""
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
        """Return what of it is seen outside a scope with these keys of its own."""
        if not self.keys & own:
            return self
        seen = ~sites.all_bits(own)
        return Effect(self.keys - own, self.gen & seen, self.kill & seen, self.fresh & seen, self.defines & seen)

    def scoped(self) -> Effect:
        """Return what of it is seen outside a scope that takes the keys that are not defined outside."""
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
    """Return the effect of one of several ways; `NO_EFFECT` for none."""
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
    """Return the effect of a container from what holds at one of its ends.

    Args:
        keys: What may be written inside.
        of_defined: What holds at the end when every key is as at the entry and defined.
        of_undefined: What holds there when no key is defined at the entry.
        sites: The places.
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
