"""Three-way merge of texts by lines: merges the changes of both sides and finds their conflicts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from difflib import SequenceMatcher


@dataclass(frozen=True, kw_only=True)
class MergeConflict:
    """Lines that both sides changed differently; `line`, from 1, is their position in our text."""

    line: int
    base: str
    ours: str
    theirs: str


@dataclass(frozen=True, kw_only=True)
class MergeResult:
    """The merged text, or the conflicts."""

    text: str | None
    conflicts: tuple[MergeConflict, ...] = ()


def merge_texts(base: str, ours: str, theirs: str) -> MergeResult:
    """Return a text with the changes of both sides."""
    lines = base.splitlines(keepends=True)
    mine, yours = ours.splitlines(keepends=True), theirs.splitlines(keepends=True)
    made: list[str] = []
    conflicts: list[MergeConflict] = []
    at = at_mine = at_yours = 0
    for start, start_mine, start_yours, size in _common(lines, mine, yours):
        was, one, two = lines[at:start], mine[at_mine:start_mine], yours[at_yours:start_yours]
        if two in (one, was):
            made += one
        elif one == was:
            made += two
        else:
            joined = ("".join(each) for each in (was, one, two))
            conflicts.append(MergeConflict(line=at_mine + 1, base=next(joined), ours=next(joined), theirs=next(joined)))
        made += lines[start : start + size]
        at, at_mine, at_yours = start + size, start_mine + size, start_yours + size
    if conflicts:
        return MergeResult(text=None, conflicts=tuple(conflicts))
    return MergeResult(text="".join(made))


def _common(base: list[str], mine: list[str], yours: list[str]) -> Iterator[tuple[int, int, int, int]]:
    """Iterate over the line runs common to all three: start in each, and length; the last is empty, at the end."""
    one = SequenceMatcher(None, base, mine, autojunk=False).get_matching_blocks()
    two = SequenceMatcher(None, base, yours, autojunk=False).get_matching_blocks()
    i = j = 0
    while i < len(one) and j < len(two):
        a, b = one[i], two[j]
        start, end = max(a.a, b.a), min(a.a + a.size, b.a + b.size)
        if start < end:
            yield start, a.b + start - a.a, b.b + start - b.a, end - start
        if a.a + a.size < b.a + b.size:
            i += 1
        else:
            j += 1
    yield len(base), len(mine), len(yours), 0
