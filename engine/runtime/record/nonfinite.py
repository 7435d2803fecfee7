"""Numbers that JSON does not have, in what events keep of requests, answers and messages.

A sensor may well say that the next obstacle is infinitely far, and a replay must be told the same.
"""

from __future__ import annotations

import math
from typing import Any, cast

_MARK = "~number"


def encode_nonfinite(value: Any) -> Any:
    """Return plain data with each NaN and infinity as `{"~number": "nan"}`; the data itself where there is none."""
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
                # Long lists are of numbers or text, and are looked at on the event loop.
                return listed
            changed = [encode_nonfinite(each) for each in listed]
            return changed if any(new is not old for new, old in zip(changed, listed, strict=True)) else listed
        case _:
            return value


def _all_finite(plain: list[Any]) -> bool:
    return all(map(math.isfinite, (each for each in plain if type(each) is float)))


def decode_nonfinite(value: object) -> object:
    """Return what `encode_nonfinite` was given."""
    match value:
        case {"~number": str(text)} if len(cast("dict[object, object]", value)) == 1:
            return float(text)
        case dict():
            return {key: decode_nonfinite(each) for key, each in cast("dict[object, object]", value).items()}
        case list():
            return [decode_nonfinite(each) for each in cast("list[object]", value)]
        case _:
            return value
