"""Converts Python values to plain document data: frozen structs become mappings without defaults."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from enum import Enum
from functools import lru_cache
from typing import cast

import msgspec

from engine.authoring.expression_values import Param
from engine.errors import DocumentError, Position

_NO_DEFAULT = object()


def to_plain_data(value: object, *, what: str, where: Position) -> object:
    """Return a value as lists, mappings, text, numbers, booleans and None.

    Args:
        value: Any value made of these, of structs, or of types that msgspec encodes.
        what: Name of the value in messages.
        where: Position for errors.

    Raises:
        DocumentError: a document cannot contain it.
    """
    return _Conversion(what, where).convert(value)


def has_expression(value: object) -> bool:
    """Return whether plain data contains a `${…}`."""
    if isinstance(value, str):
        return "${" in value
    if isinstance(value, dict):
        return any(map(has_expression, cast("dict[str, object]", value).values()))
    return isinstance(value, list) and any(map(has_expression, cast("list[object]", value)))


class _Conversion:
    def __init__(self, what: str, where: Position) -> None:
        self._what = what
        self._where = where

    def convert(self, value: object) -> object:
        match value:
            case None | bool():
                return value
            case Enum():
                return self.convert(value.value)
            case str():
                return self._text(value)
            case int() | float():
                return self._number(value)
            case list() | tuple():
                return [self.convert(item) for item in cast("list[object]", value)]
            case Mapping():
                return {self._key(k): self.convert(item) for k, item in cast("Mapping[object, object]", value).items()}
            case msgspec.Struct() if not value.__struct_config__.array_like:
                return dict(self._fields(value))
            case Param():
                return str(cast("object", value))
            case _:
                return self._other(value)

    def _fields(self, value: msgspec.Struct) -> Iterator[tuple[str, object]]:
        config = value.__struct_config__
        if config.tag_field is not None:
            yield config.tag_field, config.tag
        for found in _fields_of(type(value)):
            given = getattr(value, found.name)
            default = _default(found)
            # 1, 1.0 and True are equal, but differ for a parameter of any type.
            if given is msgspec.UNSET or (type(given) is type(default) and given == default):
                continue
            yield found.encode_name, self.convert(given)

    def _other(self, value: object) -> object:
        try:
            return self.convert(msgspec.to_builtins(value, str_keys=True))
        except (TypeError, RecursionError) as error:
            raise self._refused(f"a document cannot contain a {type(value).__name__}") from error

    def _text(self, text: str) -> str:
        try:
            text.encode()
        except UnicodeEncodeError as error:
            raise self._refused(f"{text!r} is not Unicode text") from error
        return str.__str__(text)

    def _number(self, number: float) -> float:
        if isinstance(number, float) and not math.isfinite(number):
            raise self._refused(f"{number} is not a finite number")
        if isinstance(number, int) and not -(2**63) <= number < 2**63:
            raise self._refused(f"{number} does not fit into 64 bits")
        return int(number) if isinstance(number, int) else float(number)

    def _key(self, key: object) -> str:
        if not isinstance(key, str):
            raise self._refused(f"the key {key!r} is not text")
        return self._text(key)

    def _refused(self, why: str) -> DocumentError:
        return DocumentError(f"{self._what}: {why}", where=self._where, hint="use text, numbers, lists and mappings")


@lru_cache(maxsize=1024)
def _fields_of(kind: type[msgspec.Struct]) -> tuple[msgspec.structs.FieldInfo, ...]:
    return msgspec.structs.fields(kind)


def _default(found: msgspec.structs.FieldInfo) -> object:
    if found.default_factory is not msgspec.NODEFAULT:
        return found.default_factory()
    return _NO_DEFAULT if found.required else found.default
