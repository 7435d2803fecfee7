"""Encodes NaN and infinities, which JSON does not support, in recorded requests, results and messages.

A sensor may report an infinite distance to the next obstacle, and a replay must receive the same value.
"""

from __future__ import annotations

import math
from typing import Any, cast

_MARK = "~number"


def encode_nonfinite(value: Any) -> Any:
    """Return plain data with each NaN and infinity as `{"~number": "nan"}`; the same object where there is none."""
    match value:
        case float():
            return value if math.isfinite(value) else {_MARK: str(value)}
        case dict():
            known = cast("dict[object, object]", value)
            items = {key: encode_nonfinite(each) for key, each in known.items()}
            return items if any(items[key] is not each for key, each in known.items()) else known
        case list():
            listed = cast("list[Any]", value)
            kinds = set(map(type, listed))
            if kinds.isdisjoint((dict, list)) and (float not in kinds or _all_finite(listed)):
                # Long lists hold numbers or text; this runs on the event loop, so it must be fast.
                return listed
            changed = [encode_nonfinite(each) for each in listed]
            return changed if any(new is not old for new, old in zip(changed, listed, strict=True)) else listed
        case _:
            return value


def _all_finite(plain: list[Any]) -> bool:
    return all(map(math.isfinite, (each for each in plain if type(each) is float)))


def decode_nonfinite(value: object) -> object:
    """Return the data that `encode_nonfinite` encoded."""
    match value:
        case {"~number": str(text)} if len(cast("dict[object, object]", value)) == 1:
            return float(text)
        case dict():
            return {key: decode_nonfinite(each) for key, each in cast("dict[object, object]", value).items()}
        case list():
            return [decode_nonfinite(each) for each in cast("list[object]", value)]
        case _:
            return value
