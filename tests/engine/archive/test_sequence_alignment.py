"""As many items as possible meet an equal one, in order."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.archive import sequence_alignment
from engine.archive.sequence_alignment import align_sequences

SEQUENCES = st.lists(st.sampled_from("abc"), max_size=24)


def longest_common(left: list[str], right: list[str]) -> int:
    """The length of the longest common subsequence, by the book."""
    row = [0] * (len(right) + 1)
    for item in left:
        before = row
        row = [0]
        for index, other in enumerate(right):
            row.append(before[index] + 1 if item == other else max(before[index + 1], row[index]))
    return row[-1]


@given(left=SEQUENCES, right=SEQUENCES)
def test_the_alignment_is_the_longest_one_and_takes_each_item_once(left: list[str], right: list[str]) -> None:
    """In the order of both."""
    pairs = list(align_sequences(left, right))
    assert [one for one, _ in pairs if one is not None] == list(range(len(left)))
    assert [other for _, other in pairs if other is not None] == list(range(len(right)))
    met = [(one, other) for one, other in pairs if one is not None and other is not None]
    assert all(left[one] == right[other] for one, other in met)
    assert len(met) == longest_common(left, right)


@given(left=SEQUENCES, right=SEQUENCES)
def test_an_alignment_in_parts_takes_each_item_once(left: list[str], right: list[str]) -> None:
    """Where more edits are needed than one part may have."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sequence_alignment, "MAX_EDITS", 2)
        pairs = list(align_sequences(left, right))
    assert [one for one, _ in pairs if one is not None] == list(range(len(left)))
    assert [other for _, other in pairs if other is not None] == list(range(len(right)))
    assert all(left[one] == right[other] for one, other in pairs if one is not None and other is not None)
