"""What any store refuses before its database sees it: names, sizes, numbers no database keeps alike."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Any, cast

import msgspec

from engine.errors import StoreError

MAX_BYTES = 8 * 1024 * 1024
"""Size limit of one value as JSON, half of what the strictest database takes."""
MAX_DEPTH = 64
"""Lists and objects inside one another."""
MAX_TAGS = 32
"""Tags of one entry."""
MAX_NOTE = 1000
"""Characters of `by` and of `reason`."""
_NAME = re.compile(r"[a-z][a-z0-9_/.-]{0,127}")
_NAME_START = re.compile(r"[a-z0-9_/.-]{0,128}")
_TAG = re.compile(r"[a-z0-9][a-z0-9_/.-]{0,63}")
_ENCODER = msgspec.json.Encoder(order="deterministic")


def verify_name(kind: str, name: str) -> None:
    """Refuse a name that is not lower case letters, digits and `_ / . -`, starting with a letter, 128 at most."""
    if _NAME.fullmatch(name) is None:
        raise StoreError(
            f"{name!r:.150} cannot be the name of an entry",
            where=kind,
            hint="use a-z 0-9 _ / . - beginning with a letter, 128 characters at most",
        )


def is_name_start(prefix: str) -> bool:
    """Tell whether a name can begin so."""
    return _NAME_START.fullmatch(prefix) is not None


def verify_tags(tags: Iterable[str], *, where: str) -> tuple[str, ...]:
    """Return tags sorted and each once; refuse too many, and one that is not lower case letters, digits and `_ / . -`.

    Raises:
        StoreError: with the tag.
    """
    found = tuple(sorted(set(tags)))
    if len(found) > MAX_TAGS:
        raise StoreError(f"{len(found)} tags are more than {MAX_TAGS}", where=where, hint="use fewer")
    for tag in found:
        if _TAG.fullmatch(tag) is None:
            raise StoreError(
                f"{tag!r:.100} cannot be a tag", where=where, hint="use a-z 0-9 _ / . -, 64 characters at most"
            )
    return found


def verify_note(by: str, reason: str, *, where: str) -> None:
    """Refuse a note that is too long or no text that can be stored."""
    for name, text in (("by", by), ("reason", reason)):
        if len(text) > MAX_NOTE:
            raise StoreError(f"`{name}` has {len(text)} characters, more than {MAX_NOTE}", where=where)
        try:
            text.encode()
        except UnicodeEncodeError as error:
            raise StoreError(f"`{name}` is no valid text: {error}", where=where) from error


def encode_value(value: object, *, where: str) -> str:
    """Return the value as JSON with sorted keys, or refuse it naming the place inside.

    Raises:
        StoreError: it is no object, or holds a non-finite float, an integer beyond 64 bits, a
            key that is not text, something JSON has no form for, or is too deep or too large.
    """
    plain = _plain(value, where)
    if not isinstance(plain, dict):
        raise StoreError(f"a value must be an object with fields, not {type(plain).__name__}", where=where)
    if fault := _fault(cast("object", plain)):
        raise StoreError(fault, where=where)
    try:
        data = _ENCODER.encode(plain)
    except (TypeError, ValueError, OverflowError) as error:
        raise StoreError(f"the value cannot be written as JSON: {error}", where=where) from error
    if len(data) > MAX_BYTES:
        raise StoreError(
            f"the value takes {len(data) / 1e6:.1f} MB, more than {MAX_BYTES / 1e6:.1f} MB",
            where=where,
            hint="store it in parts",
        )
    return data.decode()


def decode_value(data: str, *, where: str) -> dict[str, object]:
    """Read back what `encode_value` wrote.

    Raises:
        StoreError: it is something else: the store is damaged.
    """
    try:
        return msgspec.json.decode(data, type=dict[str, object])
    except (msgspec.DecodeError, RecursionError, UnicodeEncodeError) as error:
        raise StoreError(
            f"its value in the store is damaged: {error}", where=where, hint="undo its last change, or write it anew"
        ) from error


def _plain(value: object, where: str) -> object:
    try:
        return msgspec.to_builtins(value, str_keys=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise StoreError(f"the value cannot be written as JSON: {error}", where=where) from error


def _fault(value: object) -> str:
    waiting: list[tuple[str, int, object]] = [("value", 0, value)]
    while waiting:
        path, depth, item = waiting.pop()
        if fault := _fault_of_one(path, depth, item):
            return fault
        if isinstance(item, dict):
            waiting += [(f"{path}.{key}", depth + 1, inner) for key, inner in cast("dict[str, Any]", item).items()]
        elif isinstance(item, (list, tuple)):
            waiting += [(f"{path}[{n}]", depth + 1, inner) for n, inner in enumerate(cast("list[Any]", item))]
    return ""


def _fault_of_one(path: str, depth: int, item: object) -> str:
    if depth > MAX_DEPTH:
        return f"{path:.80} lies deeper than {MAX_DEPTH} levels"
    if isinstance(item, float) and not math.isfinite(item):
        return f"{path} is {item}, not a finite number"
    if isinstance(item, int) and not -(2**63) <= item < 2**63:
        return f"{path} is an integer beyond 64 bits"
    if isinstance(item, dict):
        odd = [key for key in cast("dict[object, object]", item) if not isinstance(key, str)]
        return f"{path} has the key {odd[0]!r:.40}, which is not text" if odd else ""
    return ""
