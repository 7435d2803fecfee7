"""Wildcards over paths and addresses."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.path_pattern import matches

PARTS = st.lists(st.text("ab.", min_size=1, max_size=3), min_size=1, max_size=5)


@pytest.mark.parametrize(
    ("pattern", "yes", "no"),
    [
        ("**", ("root", "root/a/b"), ()),
        ("root/*/grasp", ("root/a/grasp",), ("root/grasp", "root/a/b/grasp", "root/a/grasp2")),
        ("root/**/grasp", ("root/grasp", "root/a/b/grasp"), ("root/agrasp", "grasp")),
        ("root/**", ("root", "root/a/b"), ("roots",)),
        ("**/grasp", ("grasp", "root/a/grasp"), ("root/agrasp",)),
        ("left/gr*", ("left/gripper", "left/gr"), ("left/gripper/open", "right/gripper")),
        ("a.b", ("a.b",), ("axb",)),
        ("**/**/a", ("a", "b/a"), ("b",)),
    ],
)
def test_what_a_pattern_stands_for(pattern: str, yes: tuple[str, ...], no: tuple[str, ...]) -> None:
    """`*` stays within one part, `**` takes any number of them."""
    assert [p for p in (*yes, *no) if matches(pattern, p)] == list(yes)


@given(PARTS, st.data())
def test_any_path_fits_itself_with_parts_blanked_out(parts: list[str], data: st.DataObject) -> None:
    """A part becomes `*`, a run of parts becomes `**`."""
    start = data.draw(st.integers(0, len(parts)))
    end = data.draw(st.integers(start, len(parts)))
    blanked = [*parts[:start], "**", *parts[end:]]
    starred = ["*" if data.draw(st.booleans()) else part for part in parts]
    path = "/".join(parts)
    assert [matches("/".join(p), path) for p in (parts, blanked, starred)] == [True, True, True]


@given(PARTS, PARTS)
def test_stars_alone_count_parts(parts: list[str], other: list[str]) -> None:
    """As many `*` as the path has parts, and no other number."""
    assert matches("/".join("*" for _ in parts), "/".join(other)) == (len(parts) == len(other))
