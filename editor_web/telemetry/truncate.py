"""Any message or value as bounded, plain JSON: long lists, deep trees and large bytes are truncated and marked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import islice
from typing import cast

import msgspec

MAX_ITEMS = 60
MAX_DEPTH = 8
MAX_TEXT = 600
MAX_LEAVES = 1500


def truncate_value(value: object, *, max_leaves: int = MAX_LEAVES) -> object:
    """Return `value` as plain JSON of at most about `max_leaves` leaves; omitted items are marked as `… 40 more`.

    Omitted values are not accessed, so that a point cloud costs no more than a pose.
    """
    return _Truncation(max_leaves).of(value, 0)


class _Truncation:
    """One truncation; counts the remaining leaves."""

    def __init__(self, left: int) -> None:
        self._left = left

    def of(self, value: object, depth: int) -> object:
        self._left -= 1
        match value:
            case None | bool() | int():
                return value
            case float():
                return value if math.isfinite(value) else str(value)
            case str():
                over = len(value) - MAX_TEXT
                return value if over <= 0 else f"{value[:MAX_TEXT]}… {over} characters more"
            case bytes() | bytearray():
                return f"{len(value)} bytes"
            case msgspec.Struct():
                names = value.__struct_fields__
                return self._object(((name, getattr(value, name)) for name in names), len(names), depth)
            case Mapping():
                mapping = cast("Mapping[object, object]", value)
                return self._object(((str(key), each) for key, each in mapping.items()), len(mapping), depth)
            case list() | tuple() | set() | frozenset():
                items = cast("list[object]", value)
                return self._list(items, len(items), depth)
            case _:
                return _plain(value)

    def _object(self, pairs: Iterable[tuple[str, object]], count: int, depth: int) -> object:
        if depth >= MAX_DEPTH:
            return f"… {count} fields"
        kept: dict[str, object] = {}
        for key, each in islice(pairs, MAX_ITEMS):
            if self._left <= 0:
                break
            kept[key] = self.of(each, depth + 1)
        if len(kept) < count:
            kept["…"] = f"{count - len(kept)} more"
        return kept

    def _list(self, items: Iterable[object], count: int, depth: int) -> object:
        if depth >= MAX_DEPTH:
            return f"… {count} items"
        kept: list[object] = []
        for each in islice(items, MAX_ITEMS):
            if self._left <= 0:
                break
            kept.append(self.of(each, depth + 1))
        if len(kept) < count:
            kept.append(f"… {count - len(kept)} more")
        return kept


def _plain(value: object) -> object:
    """Return enumerations, dates and similar as msgspec encodes them; unknown types by their name."""
    try:
        return msgspec.to_builtins(value)
    except (TypeError, ValueError):
        return f"a {type(value).__name__}"
