"""Valid userdata values: those that JSON stores without change, so that a resumed run restores them exactly."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import cast

import msgspec

from engine.errors import UserdataError

_IMMUTABLE = frozenset((str, int, float, bool, bytes, type(None)))
_WHOLE = frozenset((int, bool, type(None)))
_UNSUPPORTED = (bytes, bytearray, memoryview, set, frozenset)
_HINT = "it may hold text, finite numbers, true, false, null, lists, mappings with text keys, and structs of these"


def plain_value(value: object, *, key: str, where: str) -> object:
    """Return a value as stored in events: lists, mappings, text and numbers.

    Args:
        value: The value to write.
        key: The userdata key that it is written to.
        where: The writer: a node path or position.

    Raises:
        UserdataError: a journal would restore the value differently or not at all; names the part of the value.
    """
    try:
        for at, problem in _problems(value, ""):
            inside = f" (at {at.removeprefix('.')})" if at else ""
            raise UserdataError(f"userdata key {key!r} cannot hold {problem}{inside}", where=where, hint=_HINT)
        return msgspec.to_builtins(value)
    except RecursionError:
        message = f"userdata key {key!r} cannot hold a value that is nested too deeply or contains itself"
        raise UserdataError(message, where=where, hint=_HINT) from None


def is_immutable(value: object) -> bool:
    """Return whether a value is immutable: scalars, and frozen structs and tuples of immutable values."""
    if type(value) in _IMMUTABLE:
        return True
    if isinstance(value, msgspec.Struct):
        return value.__struct_config__.frozen and all(map(is_immutable, msgspec.structs.astuple(value)))
    return isinstance(value, tuple) and all(map(is_immutable, cast("tuple[object, ...]", value)))


def _problems(value: object, at: str) -> Iterator[tuple[str, str]]:
    """Yield the location and description of each part that cannot be stored."""
    kind = type(value)
    if kind in _WHOLE:
        return
    if isinstance(value, float):
        if not math.isfinite(value):
            yield at, f"the number {value}"
    elif isinstance(value, str):
        if not _is_text(value):
            yield at, "text with a lone surrogate"
    elif isinstance(value, list | tuple):
        items = cast("Collection[object]", value)
        if not _all_whole_or_finite(items):
            yield from _within(((f"{at}[{index}]", item) for index, item in enumerate(items)))
    elif isinstance(value, Mapping):
        yield from _in_mapping(cast("Mapping[object, object]", value), at)
    elif isinstance(value, msgspec.Struct):
        fields = zip(value.__struct_fields__, msgspec.structs.astuple(value), strict=True)
        yield from _within((f"{at}.{name}", item) for name, item in fields)
    elif isinstance(value, _UNSUPPORTED):
        yield at, f"a value of type {kind.__name__}"
    else:
        yield from _of_another_type(value, at)


def _in_mapping(mapping: Mapping[object, object], at: str) -> Iterator[tuple[str, str]]:
    for name in mapping:
        if not isinstance(name, str) or not _is_text(name):
            yield at, f"a mapping with the key {name!r}"
    yield from _within((f"{at}.{name}", item) for name, item in mapping.items())


def _of_another_type(value: object, at: str) -> Iterator[tuple[str, str]]:
    """Check the msgspec conversion of a value of any other type: a date becomes text, a dataclass a mapping."""
    try:
        plain = msgspec.to_builtins(value)
    except (TypeError, ValueError):
        plain = value
    if type(plain) is type(value):
        yield at, f"a value of type {type(value).__name__}"
    else:
        yield from _problems(plain, at)


def _within(parts: Iterable[tuple[str, object]]) -> Iterator[tuple[str, str]]:
    for at, part in parts:
        yield from _problems(part, at)


def _all_whole_or_finite(items: Collection[object]) -> bool:
    """Return, in one pass of built-in code, whether all items are whole or finite numbers."""
    kinds = set(map(type, items)) - _WHOLE
    return not kinds or (kinds == {float} and all(math.isfinite(item) for item in items if type(item) is float))


def _is_text(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True
