"""The places that define userdata keys, numbered, so that sets of them are integers.

Each key has two bits that are not sites: UNDEFINED (the key is not defined) and ENTRY (the key is
unchanged since the entry of the analysed container, where it was defined). Each site has its own bit
after them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

Origin = Literal["parameter", "userdata", "item", "index", "output", "reference", "collect", "post"]


@dataclass(frozen=True, kw_only=True)
class DefinitionSite:
    """One place that defines a key: a declaration, or a node that writes it.

    `path` is the node or container; `name` is the output key, or the inner key, that is written.
    States of one container that write the same output of one class share one site, that of the first.
    """

    number: int
    key: str
    origin: Origin
    path: str
    name: str


class DefinitionSites:
    """All keys of a behavior that are read, and all sites that define them."""

    def __init__(self, keys: Iterable[str]) -> None:
        self._numbers = {key: number for number, key in enumerate(keys)}
        self._first = 2 * len(self._numbers)
        self._sites: list[DefinitionSite] = []
        self._shared: set[int] = set()
        self._known: dict[tuple[str, Origin, str, str], DefinitionSite] = {}
        self._defined = [0b10 << 2 * number for number in range(len(self._numbers))]
        every_other = ((1 << self._first) - 1) // 3
        self.undefined = every_other
        """The bit UNDEFINED of every key."""
        self.entries = every_other << 1
        """The bit ENTRY of every key."""

    def __bool__(self) -> bool:
        return bool(self._numbers)

    def __iter__(self) -> Iterator[DefinitionSite]:
        return iter(self._sites)

    def __contains__(self, key: str) -> bool:
        return key in self._numbers

    def add(self, key: str, origin: Origin, path: str, name: str, *, group: str = "") -> int:
        """Register a site and return its bit; 0 for a key that is not read.

        Sites of one `group` share a bit: with fewer bits the analysis of loops converges sooner.
        """
        number = self._numbers.get(key)
        if number is None:
            return 0
        identity = (key, origin, group or path, name)
        site = self._known.get(identity)
        if site is None:
            site = DefinitionSite(number=self._first + len(self._sites), key=key, origin=origin, path=path, name=name)
            self._sites.append(site)
            self._known[identity] = site
            self._defined[number] |= 1 << site.number
        elif site.path != path:
            self._shared.add(site.number)
        return 1 << site.number

    def shared(self, site: DefinitionSite) -> bool:
        """Return whether a site represents several places."""
        return site.number in self._shared

    def defined_bits(self, key: str) -> int:
        """Return the bits of a key that mean that it is defined."""
        return self._defined[self._numbers[key]]

    def undefined_bit(self, key: str) -> int:
        """Return the bit that means that a key is not defined."""
        return 1 << 2 * self._numbers[key]

    def all_bits(self, keys: Iterable[str]) -> int:
        """Return all bits of some keys; keys that are not read have none."""
        found = 0
        for key in keys:
            if key in self._numbers:
                found |= self.defined_bits(key) | self.undefined_bit(key)
        return found

    def first(self, fact: int) -> DefinitionSite:
        """Return the first place, in document order, of those in `fact`."""
        return self._sites[(fact & -fact).bit_length() - 1 - self._first]

    def places(self, key: str, fact: int) -> tuple[DefinitionSite, ...]:
        """Return the places from which a key may come where `fact` holds, in document order."""
        of_key = (fact & self.defined_bits(key)) >> self._first
        found: list[DefinitionSite] = []
        while of_key:
            number = of_key.bit_length() - 1
            found.append(self._sites[number])
            of_key ^= 1 << number
        return tuple(reversed(found))
