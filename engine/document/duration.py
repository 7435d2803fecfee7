"""Durations in documents: `30 s`, `500 ms`, `2 min`, `1 h`, or a number of seconds."""

from __future__ import annotations

import re
from typing import Annotated

from msgspec import Meta

from engine.errors import DocumentError

LONGEST_S = 1e9
"""Thirty years: longer waits are mistakes, and floats beyond it lose microsecond resolution."""
_PATTERN = r"^[0-9]+(\.[0-9]+)? ?(ms|s|min|h)$"
_SECONDS = {"ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}
_MEANING = "A duration: a number of seconds, or text, for example `500 ms`, `30 s`, `2 min`, `1 h`"

Duration = (
    Annotated[float, Meta(ge=0.0, le=LONGEST_S, description=_MEANING)]
    | Annotated[str, Meta(pattern=_PATTERN, description=_MEANING)]
)


def seconds(duration: float | str) -> float:
    """Return a duration in seconds.

    Raises:
        DocumentError: it is negative, longer than `LONGEST_S`, or has an unknown unit.
    """
    if isinstance(duration, str):
        if not re.fullmatch(_PATTERN, duration):
            raise DocumentError(f"{duration!r} is not a duration", hint="write `30 s`, `500 ms`, `2 min` or `1 h`")
        amount = duration.rstrip("mshin ")
        amount_s = float(amount) * _SECONDS[duration[len(amount) :].strip()]
    else:
        amount_s = float(duration)
    if not 0.0 <= amount_s <= LONGEST_S:
        raise DocumentError(f"{duration!r} is not a duration", hint=f"a number of seconds, from 0 to {LONGEST_S:g}")
    return amount_s
