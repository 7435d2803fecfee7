"""Upper bound of the automaton size of a regular expression, from its text."""

from __future__ import annotations

import re

_REPEATED = re.compile(r"\{(\d*)(?:,(\d*))?\}")
_MANY = 5_000
"""A class of Unicode characters, `\\pL`, compiles to thousands of byte ranges."""
_OPEN = 20
"""Any character, or a negated class, compiles to a few byte ranges."""


def pattern_weight(pattern: str) -> float:
    """Return an upper bound of the number of instructions of a pattern; any number for an invalid one."""
    # One row per open group: its weight so far, and its last atom, to which a repetition applies.
    groups: list[tuple[float, float]] = [(0.0, 0.0)]
    folded = 4.0 if "(?" in pattern else 1.0
    index = 0
    while index < len(pattern):
        total, atom = groups[-1]
        character = pattern[index]
        if character == "(":
            groups.append((0.0, 0.0))
            index += 1
            continue
        if character == ")" and len(groups) > 1:
            inner = sum(groups.pop()) + 2
            total, atom = groups[-1]
            groups[-1] = (total + atom, inner)
            index += 1
            continue
        repeated = _REPEATED.match(pattern, index)
        if repeated is not None:
            times = max((int(count) for count in repeated.groups() if count and len(count) < 6), default=1)
            groups[-1] = (total, atom * max(1, times) + 1)
            index = repeated.end()
            continue
        index, weight = _atom(pattern, index)
        groups[-1] = (total + atom, weight)
    return folded * sum(map(sum, groups))


def _atom(pattern: str, index: int) -> tuple[int, float]:
    """Return where the character, escape or class at `index` ends, and its weight."""
    character = pattern[index]
    if character == "\\":
        escaped = pattern[index + 1 : index + 2]
        if escaped not in ("p", "P"):
            return index + 2, _OPEN
        named = pattern.find("}", index) if pattern.startswith("{", index + 2) else index + 2
        return (named if named >= 0 else len(pattern)) + 1, _MANY
    if character == "[":
        end = index + 2
        while end < len(pattern) and pattern[end] != "]":
            end += 2 if pattern[end] == "\\" else 1
        inside = pattern[index:end]
        many = _MANY * (inside.count("\\p") + inside.count("\\P"))
        return end + 1, _OPEN + 4 * len(inside) + many
    return index + 1, _OPEN if character == "." else 1.0 if character.isascii() else 4.0
