"""What a userdata value may be: what JSON keeps as it is, so that a run that goes on has what it had."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import cast

import msgspec

from engine.errors import UserdataError

_UNCHANGEABLE = frozenset((str, int, float, bool, bytes, type(None)))
_WHOLE = frozenset((int, bool, type(None)))
_NOT_KEPT = (bytes, bytearray, memoryview, set, frozenset)
_HINT = "it may hold text, finite numbers, true, false, null, lists, mappings with text as keys, and structs of them"


def plain_value(value: object, *, key: str, where: str) -> object:
    """Return a value as events keep it: in lists, mappings, text and numbers.

    Args:
        value: What is to be written.
        key: The userdata key that it is written to.
        where: Who writes it: a node path or position.

    Raises:
        UserdataError: it would come back from a journal as something else, or not at all; says which part.
    """
    try:
        for at, problem in _problems(value, ""):
            inside = f" (at {at.removeprefix('.')})" if at else ""
            raise UserdataError(f"userdata key {key!r} cannot hold {problem}{inside}", where=where, hint=_HINT)
        return msgspec.to_builtins(value)
    except RecursionError:
        message = f"userdata key {key!r} cannot hold what is nested so deeply, or in itself"
        raise UserdataError(message, where=where, hint=_HINT) from None


def is_immutable(value: object) -> bool:
    """Tell whether nobody can change a value: scalars, and frozen structs and tuples of such."""
    if type(value) in _UNCHANGEABLE:
        return True
    if isinstance(value, msgspec.Struct):
        return value.__struct_config__.frozen and all(map(is_immutable, msgspec.structs.astuple(value)))
    return isinstance(value, tuple) and all(map(is_immutable, cast("tuple[object, ...]", value)))


def _problems(value: object, at: str) -> Iterator[tuple[str, str]]:
    """Find what cannot be kept: where in the value it is, and what it is."""
    kind = type(value)
    if kind in _WHOLE:
        return
    if isinstance(value, float):
        if not math.isfinite(value):
            yield at, f"the number {value}"
    elif isinstance(value, str):
        if not _is_text(value):
            yield at, "text with half a character (a lone surrogate)"
    elif isinstance(value, list | tuple):
        items = cast("Collection[object]", value)
        if not _all_whole_or_finite(items):
            yield from _within(((f"{at}[{index}]", item) for index, item in enumerate(items)))
    elif isinstance(value, Mapping):
        yield from _in_mapping(cast("Mapping[object, object]", value), at)
    elif isinstance(value, msgspec.Struct):
        fields = zip(value.__struct_fields__, msgspec.structs.astuple(value), strict=True)
        yield from _within((f"{at}.{name}", item) for name, item in fields)
    elif isinstance(value, _NOT_KEPT):
        yield at, f"a value of type {kind.__name__}"
    else:
        yield from _of_another_type(value, at)


def _in_mapping(mapping: Mapping[object, object], at: str) -> Iterator[tuple[str, str]]:
    for name in mapping:
        if not isinstance(name, str) or not _is_text(name):
            yield at, f"a mapping with the key {name!r}"
    yield from _within((f"{at}.{name}", item) for name, item in mapping.items())


def _of_another_type(value: object, at: str) -> Iterator[tuple[str, str]]:
    """Look into what msgspec makes of a value of any other type: a date is text, a dataclass a mapping."""
    try:
        made = msgspec.to_builtins(value)
    except (TypeError, ValueError):
        made = value
    if type(made) is type(value):
        yield at, f"a value of type {type(value).__name__}"
    else:
        yield from _problems(made, at)


def _within(parts: Iterable[tuple[str, object]]) -> Iterator[tuple[str, str]]:
    for at, part in parts:
        yield from _problems(part, at)


def _all_whole_or_finite(items: Collection[object]) -> bool:
    """Tell, in one pass of the interpreter's own, whether these are whole or finite numbers alone."""
    kinds = set(map(type, items)) - _WHOLE
    return not kinds or (kinds == {float} and all(math.isfinite(item) for item in items if type(item) is float))


def _is_text(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True
