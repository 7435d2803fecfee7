"""Paths and ids of the page are made and read in one place: nothing else takes them apart."""

from __future__ import annotations

import re

import pytest

from tests.house.test_page_names import COMMENT, PAGE, page_files

TAKEN_APART = re.compile(r"\.(?:split|lastIndexOf|indexOf)\(\s*['\"][/|#]['\"]")
HOMES = {"document/path.ts", "document/edgeId.ts", "document/userdata.ts"}
"""Paths; arrows and outcomes; scopes of userdata with the number of their round."""


@pytest.mark.parametrize(
    ("source", "is_found"),
    [
        ("const [a, b] = id.split('|')", True),
        ("path.slice(path.lastIndexOf('/') + 1)", True),
        ("text.split(\n  '#')", True),
        ("text.split('\\n')", False),
        ("// path.split('/')\nnameOfPath(path)", False),
    ],
)
def test_what_takes_a_path_apart_is_found(source: str, is_found: bool) -> None:
    """What the next test reads; a pattern that finds nothing would let all pass."""
    assert (TAKEN_APART.search(COMMENT.sub("", source)) is not None) is is_found


def test_only_their_homes_take_paths_and_ids_apart() -> None:
    """`document/path.ts` has what can be asked of a path, `document/edgeId.ts` what of an arrow."""
    found = {
        str(path.relative_to(PAGE))
        for path in page_files(".ts", ".tsx")
        if TAKEN_APART.search(COMMENT.sub("", path.read_text(encoding="utf-8")))
    }
    assert found == HOMES
