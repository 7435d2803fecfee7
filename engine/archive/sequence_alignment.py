"""Aligns two sequences so that as many items as possible meet an equal one (E. W. Myers, 1986)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

MAX_EDITS = 256
"""Items without a partner up to which an alignment is the longest one; beyond, it is put together of such parts."""
IndexPair = tuple[int | None, int | None]


def align_sequences(left: Sequence[str], right: Sequence[str]) -> Iterator[IndexPair]:
    """Yield pairs of the indices of equal items, in order; an item without a partner is paired with None.

    Of equal items that follow one another, the first ones are paired. The time is bounded by the length of the
    sequences times `MAX_EDITS`.
    """
    at_left = at_right = 0
    while at_left < len(left) or at_right < len(right):
        steps = _shortest_edit(left, right, at_left, at_right)
        for is_left, is_right in steps:
            yield (at_left if is_left else None, at_right if is_right else None)
            at_left, at_right = at_left + is_left, at_right + is_right


def _shortest_edit(
    left: Sequence[str], right: Sequence[str], from_left: int, from_right: int
) -> list[tuple[bool, bool]]:
    """Return steps to the end of both, or to the furthest place that `MAX_EDITS` edits reach.

    A step says whether it takes an item of the left and of the right sequence.
    """
    # The furthest index on the left, by diagonal: left index minus right index, both from the start.
    furthest: dict[int, int] = {1: 0}
    rounds: list[dict[int, int]] = []
    count_left, count_right = len(left) - from_left, len(right) - from_right
    for edits in range(MAX_EDITS + 1):
        rounds.append(dict(furthest))
        for diagonal in range(-edits, edits + 1, 2):
            is_insertion = diagonal == -edits or (
                diagonal != edits and furthest.get(diagonal - 1, -1) < furthest.get(diagonal + 1, -1)
            )
            x = furthest[diagonal + 1] if is_insertion else furthest[diagonal - 1] + 1
            y = x - diagonal
            while x < count_left and y < count_right and left[from_left + x] == right[from_right + y]:
                x, y = x + 1, y + 1
            furthest[diagonal] = x
            if x >= count_left and y >= count_right:
                return _steps(rounds, x, y)
    inside = {
        diagonal: x
        for diagonal, x in furthest.items()
        if (diagonal + MAX_EDITS) % 2 == 0 and x <= count_left and x - diagonal <= count_right
    }
    best = max(inside, key=lambda diagonal: 2 * inside[diagonal] - diagonal)
    return _steps(rounds, inside[best], inside[best] - best)


def _steps(rounds: Sequence[dict[int, int]], x: int, y: int) -> list[tuple[bool, bool]]:
    """Return the steps that lead to a place, from the furthest places before each edit."""
    steps: list[tuple[bool, bool]] = []
    for edits in range(len(rounds) - 1, -1, -1):
        furthest, diagonal = rounds[edits], x - y
        is_insertion = diagonal == -edits or (
            diagonal != edits and furthest.get(diagonal - 1, -1) < furthest.get(diagonal + 1, -1)
        )
        before = diagonal + 1 if is_insertion else diagonal - 1
        start_x = furthest[before] if edits else 0
        start_y = start_x - before if edits else 0
        while x > start_x and y > start_y:
            steps.append((True, True))
            x, y = x - 1, y - 1
        if edits:
            steps.append((x > start_x, y > start_y))
        x, y = start_x, start_y
    steps.reverse()
    return steps
