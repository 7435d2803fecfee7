"""The differences between two plain values, field by field."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import cast

import msgspec

_MISSING = object()


class ValueChange(msgspec.Struct, frozen=True, kw_only=True):
    """One field that differs: its path `pose.xyz_m[0]`, and both values as short JSON, null where it is missing."""

    at: str
    left: str | None
    right: str | None


def value_changes(left: object, right: object, at: str = "", *, longest: int) -> Iterator[ValueChange]:
    """Yield the fields that differ; objects and lists of one length are compared inside.

    Args:
        left: A plain value, as JSON has it.
        right: Another one.
        at: Their path.
        longest: Characters of a value that are kept.
    """
    if isinstance(left, dict) and isinstance(right, dict):
        before, after = cast("dict[str, object]", left), cast("dict[str, object]", right)
        for key in chain(before, (key for key in after if key not in before)):
            inside = f"{at}.{key}" if at else key
            yield from value_changes(before.get(key, _MISSING), after.get(key, _MISSING), inside, longest=longest)
        return
    if isinstance(left, list) and isinstance(right, list):
        earlier, later = cast("list[object]", left), cast("list[object]", right)
        if len(earlier) == len(later):
            for index, pair in enumerate(zip(earlier, later, strict=True)):
                yield from value_changes(*pair, f"{at}[{index}]", longest=longest)
            return
    if left != right:
        yield ValueChange(
            at=at, left=_short(cast("object", left), longest), right=_short(cast("object", right), longest)
        )


def _short(value: object, longest: int) -> str | None:
    if value is _MISSING:
        return None
    text = msgspec.json.encode(value).decode()
    return text if len(text) <= longest else text[: longest - 1] + "…"
