"""Suggests known names for a mistyped one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from heapq import nsmallest
from itertools import islice

_LONGEST = 100
"""Maximum length of a compared name: a comparison takes the product of both lengths."""
_MANY = 200
"""Number of names up to which all are compared; of more, only those of similar length and first letter."""
_SHOWN = 8


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return `did you mean …?`, or the known names when none is similar, or `there are none`."""
    names = set(known)
    if not names:
        return "there are none"
    similar = close_names(name, _candidates(name, names), most=3, cutoff=0.6) if len(name) <= _LONGEST else []
    if similar:
        return f"did you mean {' or '.join(similar)}?"
    shown = ", ".join(each[:_LONGEST] for each in nsmallest(_SHOWN, names))
    return f"known: {shown}{', …' if len(names) > _SHOWN else ''}"


def close_names(name: str, known: Sequence[str], *, most: int, cutoff: float) -> list[str]:
    """Return the known names that are similar by `difflib`, the closest first; imported at the first use."""
    from difflib import get_close_matches

    return get_close_matches(name, known, n=most, cutoff=cutoff)


def _candidates(name: str, names: set[str]) -> list[str]:
    """Return the names to compare, sorted; at most a few hundred."""
    if len(names) <= _MANY:
        return sorted(each for each in names if len(each) <= _LONGEST)
    similar = (each for each in names if each[:1] == name[:1] and abs(len(each) - len(name)) <= 2)
    return sorted(islice(similar, _MANY)) if len(names) > 10 * _MANY else sorted(similar)[:_MANY]
