"""The parts at the begin and at the end that two texts have in common."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from engine.editing.text.same_ends import same_ends

WORDS = st.text("ab\n", max_size=12)


@given(begin=WORDS, old=WORDS, new=WORDS, end=WORDS)
def test_what_two_texts_have_in_common_at_both_ends_does_not_overlap(begin: str, old: str, new: str, end: str) -> None:
    one, two = begin + old + end, begin + new + end
    found = same_ends(one, two)
    tail = len(one) - found.tail
    assert one[: found.head] == two[: found.head]
    assert one[found.tail :] == two[len(two) - tail :]
    assert found.head + tail <= min(len(one), len(two))
    # Neither of them could be longer.
    assert one[found.head : found.head + 1] != two[found.head : found.head + 1] or found.head == min(len(one), len(two))
    assert found.head >= len(begin)
    assert found.longer == len(two) - len(one)
