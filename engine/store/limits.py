"""The limits of every store, independent of the database: names, sizes, numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Any, cast

import msgspec

from engine.errors import StoreError

MAX_BYTES = 8 * 1024 * 1024
"""Size limit of one value as JSON, half of the limit of the strictest database."""
MAX_DEPTH = 64
"""Maximum nesting of lists and objects."""
MAX_TAGS = 32
"""Maximum number of tags of one entry."""
MAX_NOTE = 1000
"""Maximum number of characters of `by` and of `reason`."""
_NAME = re.compile(r"[a-z][a-z0-9_/.-]{0,127}")
_NAME_START = re.compile(r"[a-z0-9_/.-]{0,128}")
_TAG = re.compile(r"[a-z0-9][a-z0-9_/.-]{0,63}")
_ENCODER = msgspec.json.Encoder(order="deterministic")


def verify_name(kind: str, name: str) -> None:
    """Refuse a name that is not at most 128 lower case letters, digits and `_ / . -`, starting with a letter."""
    if _NAME.fullmatch(name) is None:
        raise StoreError(
            f"{name!r:.150} cannot be the name of an entry",
            where=kind,
            hint="use at most 128 characters of a-z 0-9 _ / . -, starting with a letter",
        )


def is_name_start(prefix: str) -> bool:
    """Return whether a name can begin with `prefix`."""
    return _NAME_START.fullmatch(prefix) is not None


def verify_tags(tags: Iterable[str], *, where: str) -> tuple[str, ...]:
    """Return the tags sorted and without duplicates.

    Raises:
        StoreError: too many tags, or a tag that is not lower case letters, digits and `_ / . -`.
    """
    distinct = tuple(sorted(set(tags)))
    if len(distinct) > MAX_TAGS:
        raise StoreError(f"{len(distinct)} tags are more than {MAX_TAGS}", where=where, hint="use fewer tags")
    for tag in distinct:
        if _TAG.fullmatch(tag) is None:
            raise StoreError(
                f"{tag!r:.100} cannot be a tag", where=where, hint="use at most 64 characters of a-z 0-9 _ / . -"
            )
    return distinct


def verify_note(by: str, reason: str, *, where: str) -> None:
    """Refuse a note that is too long or not valid text."""
    for name, text in (("by", by), ("reason", reason)):
        if len(text) > MAX_NOTE:
            raise StoreError(f"`{name}` has {len(text)} characters, more than {MAX_NOTE}", where=where)
        try:
            text.encode()
        except UnicodeEncodeError as error:
            raise StoreError(f"`{name}` is not valid text: {error}", where=where) from error


def encode_value(value: object, *, where: str) -> str:
    """Return the value as JSON with sorted keys; an error names the position in the value.

    Raises:
        StoreError: the value is not an object, has a non-finite float, an integer beyond 64 bits, a
            key that is not text, or data without a JSON form, or is too deep or too large.
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
            hint="split it into several entries",
        )
    return data.decode()


def decode_value(data: str, *, where: str) -> dict[str, object]:
    """Decode the output of `encode_value`.

    Raises:
        StoreError: the text is not a value: the store is damaged.
    """
    try:
        return msgspec.json.decode(data, type=dict[str, object])
    except (msgspec.DecodeError, RecursionError, UnicodeEncodeError) as error:
        raise StoreError(
            f"its value in the store is damaged: {error}", where=where, hint="undo its last change, or write it again"
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
        return f"{path:.80} is nested deeper than {MAX_DEPTH} levels"
    if isinstance(item, float) and not math.isfinite(item):
        return f"{path} is {item}, not a finite number"
    if isinstance(item, int) and not -(2**63) <= item < 2**63:
        return f"{path} is an integer beyond 64 bits"
    if isinstance(item, dict):
        invalid = [key for key in cast("dict[object, object]", item) if not isinstance(key, str)]
        return f"{path} has the key {invalid[0]!r:.40}, which is not text" if invalid else ""
    return ""
