"""Three-way merges: both changes, or the conflict; never a change lost."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from engine.editing.text.three_way_merge import MergeConflict, merge_texts

LINES = st.lists(st.sampled_from(["a", "b", "c", "d", "e"]), max_size=8)


def text(lines: list[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


def test_changes_of_different_lines_are_both_made() -> None:
    merged = merge_texts("a\nb\nc\nd\n", "A\nb\nc\nd\n", "a\nb\nc\nd\ne\n")
    assert (merged.text, merged.conflicts) == ("A\nb\nc\nd\ne\n", ())


def test_different_changes_of_one_line_are_a_conflict() -> None:
    merged = merge_texts("a\nb\nc\n", "a\nX\nc\n", "a\nY\nc\n")
    assert merged.text is None
    assert merged.conflicts == (MergeConflict(line=2, base="b\n", ours="X\n", theirs="Y\n"),)


def test_the_same_change_on_both_sides_is_made_once() -> None:
    assert merge_texts("a\nb\n", "a\nX\n", "a\nX\n").text == "a\nX\n"


@settings(deadline=None)
@given(base=LINES, changed=LINES)
def test_a_change_of_one_side_only_is_that_side(base: list[str], changed: list[str]) -> None:
    assert merge_texts(text(base), text(changed), text(base)).text == text(changed)
    assert merge_texts(text(base), text(base), text(changed)).text == text(changed)
    assert merge_texts(text(base), text(changed), text(changed)).text == text(changed)


@settings(deadline=None)
@given(base=LINES, ours=LINES, theirs=LINES)
def test_what_is_new_on_either_side_is_in_the_merge_or_in_a_conflict(
    base: list[str], ours: list[str], theirs: list[str]
) -> None:
    """Marked lines cannot be there by chance."""
    mine = [*ours[:2], "MINE", *ours[2:]]
    yours = [*theirs[:3], "YOURS", *theirs[3:]]
    merged = merge_texts(text(base), text(mine), text(yours))
    if merged.text is not None:
        assert "MINE\n" in merged.text
        assert "YOURS\n" in merged.text
    else:
        assert merged.conflicts
        assert all(each.ours != each.theirs for each in merged.conflicts)


@settings(deadline=None)
@given(base=LINES, ours=LINES, theirs=LINES)
def test_a_merge_does_not_depend_on_who_asks(base: list[str], ours: list[str], theirs: list[str]) -> None:
    one = merge_texts(text(base), text(ours), text(theirs))
    two = merge_texts(text(base), text(theirs), text(ours))
    assert (one.text is None) == (two.text is None)
    assert len(one.conflicts) == len(two.conflicts)
