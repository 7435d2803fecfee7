"""Suggests the known name that a mistyped one probably meant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from heapq import nsmallest
from itertools import islice

_LONGEST = 100
"""Characters up to which a name is compared: comparing takes the product of both lengths."""
_MANY = 200
"""Names up to which all are compared; of more, those that begin alike and are about as long."""
_SHOWN = 8


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return `did you mean …?`, or the known names when none is near, or that there are none."""
    names = set(known)
    if not names:
        return "there are none"
    near = close_names(name, _alike(name, names), most=3, cutoff=0.6) if len(name) <= _LONGEST else []
    if near:
        return f"did you mean {' or '.join(near)}?"
    shown = ", ".join(each[:_LONGEST] for each in nsmallest(_SHOWN, names))
    return f"known: {shown}{', …' if len(names) > _SHOWN else ''}"


def close_names(name: str, known: Sequence[str], *, most: int, cutoff: float) -> list[str]:
    """Return the known names that are alike by `difflib`, the nearest first; it is loaded with the first mistake."""
    from difflib import get_close_matches

    return get_close_matches(name, known, n=most, cutoff=cutoff)


def _alike(name: str, names: set[str]) -> list[str]:
    """Return the names that are worth comparing, sorted; never more than a few hundred."""
    if len(names) <= _MANY:
        return sorted(each for each in names if len(each) <= _LONGEST)
    alike = (each for each in names if each[:1] == name[:1] and abs(len(each) - len(name)) <= 2)
    return sorted(islice(alike, _MANY)) if len(names) > 10 * _MANY else sorted(alike)[:_MANY]
