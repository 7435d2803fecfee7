"""The parts at the begin and at the end of two texts that are the same: what lies in them needs no comparison."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass

from engine.editing.text.syntax import Member


@dataclass(frozen=True)
class SameEnds:
    """Where an old text begins and ends to differ from a new one, which is longer by `longer` characters."""

    head: int
    tail: int
    longer: int

    def members(self, olds: list[Member], *, at_head: bool, moved: int) -> tuple[int, int]:
        """Return the number of the first entries that lie in the same begin, and of the first of those in the same end.

        Args:
            olds: Entries of a block, in their order.
            at_head: Whether the first of them begins in both texts at the same place.
            moved: By how many characters the end of the last of them moved.
        """
        first, rest = 0, len(olds)
        if at_head:
            # Each of them is followed by the line of another one.
            first = max(0, bisect_left(olds, self.head, key=lambda member: member.at) - 2)
        if moved == self.longer:
            # The line before begins after the difference too.
            rest = min(len(olds), bisect_left(olds, self.tail, lo=first, key=lambda member: member.at) + 2)
        return first, rest


def same_ends(old: str, new: str) -> SameEnds:
    """Compare two texts."""
    most = min(len(old), len(new))
    head = _longest(most, lambda low, high: old[low:high] == new[low:high])
    # Without what is in the first part already.
    tail = _longest(
        most - head,
        lambda low, high: old[len(old) - high : len(old) - low] == new[len(new) - high : len(new) - low],
    )
    return SameEnds(head, len(old) - tail, len(new) - len(old))


def _longest(most: int, same: Callable[[int, int], bool]) -> int:
    """Return over how many characters two texts are the same; `same` compares what is between two distances."""
    low, high = 0, most
    while low < high:
        middle = (low + high + 1) // 2
        low, high = (middle, high) if same(low, middle) else (low, middle - 1)
    return low
