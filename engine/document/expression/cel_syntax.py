"""The syntax tree of an expression, read from the serialized protobuf bytes of a parsed CEL expression.

Only the tree messages of `cel/expr/syntax.proto` are read. Macros are already expanded to comprehensions, so the
tree is what the evaluator runs. Trees have no cycles, and the cache holds many nodes: they are excluded from
garbage collection.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import cast

import msgspec

_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
_FIXED = {_FIXED64: 8, _FIXED32: 4}


class CelLiteral(msgspec.Struct, frozen=True, gc=False, tag=True):
    """A constant; `text` is None if it is neither text nor bytes."""

    text: str | None = None


class CelIdentifier(msgspec.Struct, frozen=True, gc=False, tag=True):
    """The use of a variable, or of a type."""

    name: str
    id: int


class CelSelect(msgspec.Struct, frozen=True, gc=False, tag=True):
    """A field of a value, or with `test` whether the field exists."""

    operand: Syntax
    test: bool


class CelCall(msgspec.Struct, frozen=True, gc=False, tag=True):
    """An operator or function; the target of a method is its first argument."""

    function: str
    arguments: tuple[Syntax, ...]


class CelList(msgspec.Struct, frozen=True, gc=False, tag=True):
    """`[a, b]`."""

    items: tuple[Syntax, ...]


class CelMap(msgspec.Struct, frozen=True, gc=False, tag=True):
    """`{a: b}`; `message` names the type of a protobuf message."""

    message: str
    items: tuple[Syntax, ...]


class CelComprehension(msgspec.Struct, frozen=True, gc=False, tag=True):
    """The expansion of `all`, `exists`, `exists_one`, `map` and `filter`: a fold over a list or mapping."""

    variable: str
    values: Syntax
    accumulator: str
    start: Syntax
    condition: Syntax
    step: Syntax
    result: Syntax


Syntax = CelLiteral | CelIdentifier | CelSelect | CelCall | CelList | CelMap | CelComprehension


@dataclass(frozen=True, slots=True)
class ParsedExpression:
    """A tree, and the character index of each node, by node id."""

    root: Syntax
    positions: Mapping[int, int]

    def free_names(self) -> Iterator[tuple[str, int]]:
        """Yield each use of a name that no comprehension binds, with its character index."""
        for used in _free(self.root, frozenset()):
            yield used.name, self.positions.get(used.id, -1)


def read_parsed(serialized: bytes) -> ParsedExpression:
    """Return the tree in the serialized bytes of a parsed, unchecked expression."""
    message = _Fields(_Fields(serialized).message(2))
    positions = (_Fields(entry) for entry in _Fields(message.message(3)).messages(4))
    return ParsedExpression(_expression(message.message(2)), {entry.number(1): entry.number(2) for entry in positions})


def _free(node: Syntax, bound: frozenset[str]) -> Iterator[CelIdentifier]:
    match node:
        case CelLiteral():
            return
        case CelIdentifier():
            if node.name not in bound:
                yield node
        case CelSelect():
            yield from _free(node.operand, bound)
        case CelCall():
            for each in node.arguments:
                yield from _free(each, bound)
        case CelList() | CelMap():
            for each in node.items:
                yield from _free(each, bound)
        case CelComprehension():
            yield from _free(node.values, bound)
            yield from _free(node.start, bound)
            inside = bound | {node.variable, node.accumulator}
            for each in (node.condition, node.step):
                yield from _free(each, inside)
            yield from _free(node.result, bound | {node.accumulator})


def _expression(data: bytes) -> Syntax:
    fields = _Fields(data)
    for number, read in _KINDS.items():
        if number in fields:
            return read(_Fields(fields.message(number)), fields.number(2))
    return CelLiteral()


def _constant(fields: _Fields, _: int) -> Syntax:
    found = fields.message(6) if 6 in fields else fields.message(7) if 7 in fields else None
    return CelLiteral(found.decode("utf-8", "replace") if found is not None else None)


def _name(fields: _Fields, number: int) -> Syntax:
    return CelIdentifier(fields.text(1), number)


def _selection(fields: _Fields, _: int) -> Syntax:
    return CelSelect(_expression(fields.message(1)), bool(fields.number(3)))


def _call(fields: _Fields, _: int) -> Syntax:
    target = [fields.message(1)] if 1 in fields else []
    return CelCall(fields.text(2), tuple(map(_expression, [*target, *fields.messages(3)])))


def _list(fields: _Fields, _: int) -> Syntax:
    return CelList(tuple(map(_expression, fields.messages(1))))


def _mapping(fields: _Fields, _: int) -> Syntax:
    items: list[Syntax] = []
    for each in fields.messages(2):
        entry = _Fields(each)
        items += [_expression(entry.message(number)) for number in (3, 4) if number in entry]
    return CelMap(fields.text(1), tuple(items))


def _comprehension(fields: _Fields, _: int) -> Syntax:
    return CelComprehension(
        variable=fields.text(1),
        values=_expression(fields.message(2)),
        accumulator=fields.text(3),
        start=_expression(fields.message(4)),
        condition=_expression(fields.message(5)),
        step=_expression(fields.message(6)),
        result=_expression(fields.message(7)),
    )


_KINDS = {3: _constant, 4: _name, 5: _selection, 6: _call, 7: _list, 8: _mapping, 9: _comprehension}


class _Fields:
    """The fields of one protobuf message, by number."""

    __slots__ = ("_values",)

    def __init__(self, data: bytes) -> None:
        self._values: dict[int, list[int | bytes]] = {}
        for number, value in _wire(data):
            self._values.setdefault(number, []).append(value)

    def __contains__(self, number: int) -> bool:
        return number in self._values

    def number(self, field: int) -> int:
        found = self._values.get(field, [0])[-1]
        return found if isinstance(found, int) else 0

    def message(self, field: int) -> bytes:
        found = self._values.get(field, [b""])[-1]
        return found if isinstance(found, bytes) else b""

    def messages(self, field: int) -> list[bytes]:
        return cast("list[bytes]", self._values.get(field, []))

    def text(self, field: int) -> str:
        return self.message(field).decode("utf-8", "replace")


def _wire(data: bytes) -> Iterator[tuple[int, int | bytes]]:
    index = 0
    while index < len(data):
        tag, index = _varint(data, index)
        kind = tag & 7
        if kind == _VARINT:
            value, index = _varint(data, index)
            yield tag >> 3, value
            continue
        length = _FIXED.get(kind)
        if length is None:
            length, index = _varint(data, index)
        yield tag >> 3, data[index : index + length]
        index += length


def _varint(data: bytes, index: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[index]
        index += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, index
        shift += 7
