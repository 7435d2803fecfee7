"""Sizes of values, which determine the cost of an evaluation.

The weight of a value is the number of values in it, itself included, and one more for every 100
characters of text.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from enum import Enum
from itertools import chain
from typing import Any, NamedTuple, cast

import msgspec

from engine.errors import ExpressionError

CHARACTERS_PER_WEIGHT = 100
MAX_WEIGHT = 20_000
"""Maximum weight of a value that an expression reads."""
MAX_VALUE_DEPTH = 64
_MAX_LITERAL = 1_000
_ENDLESS = 1e15
_SCALARS = frozenset((int, float, bool, type(None), datetime, timedelta))


class ValueSize(NamedTuple):
    """Upper bounds of the size of a value."""

    weight: float = 1.0
    text: float = 0.0
    """Number of characters, if it may be text."""
    length: float = 0.0
    """Number of items, if it may be a list or mapping."""
    item: ValueSize | None = None
    """Upper bound of any key or item; None without items."""
    literal: str | None = None
    """The text itself, if it is short and known."""

    @property
    def inside(self) -> ValueSize:
        """Upper bound of any item."""
        return self.item or SCALAR


SCALAR = ValueSize()


def text_size(characters: float, literal: str | None = None) -> ValueSize:
    """Return the size of text."""
    characters = min(characters, _ENDLESS)
    return ValueSize(1 + characters / CHARACTERS_PER_WEIGHT, characters, literal=literal)


def list_size(length: float, item: ValueSize) -> ValueSize:
    """Return the size of a list of `length` items, or of a mapping with half as many entries."""
    length = min(length, _ENDLESS)
    return ValueSize(min(1 + length * item.weight, _ENDLESS), 0.0, length, item)


def joined_size(one: ValueSize, other: ValueSize) -> ValueSize:
    """Return the size of the concatenation of texts or lists."""
    text = min(one.text + other.text, _ENDLESS)
    length = min(one.length + other.length, _ENDLESS)
    return ValueSize(min(one.weight + other.weight, _ENDLESS), text, length, _common_item(one, other))


def either_size(one: ValueSize, other: ValueSize) -> ValueSize:
    """Return the size of a value that is one or the other."""
    if one is other:
        return one
    length = max(one.length, other.length)
    return ValueSize(max(one.weight, other.weight), max(one.text, other.text), length, _common_item(one, other))


def _common_item(one: ValueSize, other: ValueSize) -> ValueSize | None:
    if not one.length:
        return other.item
    if not other.length:
        return one.item
    return either_size(one.inside, other.inside)


_SHORT = text_size(100)
SMALL = ValueSize(1 + 2 * 16 * _SHORT.weight, _SHORT.text, 16.0, _SHORT)
"""A bound that most values satisfy: numbers, short texts, and short flat lists and mappings."""


def measure_value(value: object, *, name: str) -> ValueSize:
    """Return the size of a value; `name` is its name in messages.

    Raises:
        ExpressionError: it is too large, nested too deeply, or not a document value.
    """
    found = _Measuring(name).level([value], 0)
    short = isinstance(value, str) and len(value) <= _MAX_LITERAL
    return found._replace(literal=value) if short else found


class _Measuring:
    """One breadth-first walk over a value; it ends at the maximum weight."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._weight = 0.0

    def level(self, values: Sequence[object], depth: int) -> ValueSize:
        """Return an upper bound of the sizes of the values."""
        before = self._weight
        self._count(len(values))
        kinds: set[type] = set(map(type, values)) - _SCALARS
        if not kinds:
            return SCALAR
        if depth > MAX_VALUE_DEPTH:
            raise self._refused(f"is nested more than {MAX_VALUE_DEPTH} levels deep")
        text = length = slots = 0
        inside: list[object] = []
        for kind in kinds:
            those = [value for value in values if type(value) is kind] if len(values) > 1 else values
            if issubclass(kind, str | bytes):
                text = max(text, *map(len, cast("Sequence[str]", those)), 0)
                self._count(sum(map(len, cast("Sequence[str]", those))) / CHARACTERS_PER_WEIGHT)
            elif not issubclass(kind, int | float | Enum):
                items = self._opened(cast("type[object]", kind), those)
                length = max(length, *map(len, items))
                slots = max(slots, length * (2 if len(items) > len(those) else 1))
                self._count(sum(map(len, items)))
                inside.extend(chain.from_iterable(items))
        self._weight -= len(inside)
        item = self.level(inside, depth + 1) if inside else None
        weight = 1 + text / CHARACTERS_PER_WEIGHT + (slots * item.weight if item is not None else 0)
        return ValueSize(min(weight, self._weight - before), text, length, item)

    def _opened(self, kind: type[object], values: Sequence[object]) -> list[Any]:
        """Return the items of each value; keys and values of mappings are separate items."""
        if issubclass(kind, list | tuple | set | frozenset):
            return list(values)
        if issubclass(kind, msgspec.Struct):
            names = kind.__struct_fields__
            return [*([names] * len(values)), *([getattr(value, name) for name in names] for value in values)]
        if issubclass(kind, Mapping):
            known = cast("Sequence[Mapping[object, object]]", values)
            return [*(each.keys() for each in known), *(each.values() for each in known)]
        raise self._refused(f"is or contains a {kind.__name__}, which is not a document value")

    def _count(self, weight: float) -> None:
        self._weight += weight
        if self._weight > MAX_WEIGHT:
            raise self._refused(f"contains more than {MAX_WEIGHT:,} values")

    def _refused(self, reason: str) -> ExpressionError:
        return ExpressionError(f"`{self._name}` {reason}", hint="pass the value to a state instead")
