"""What the page remembers has an owner: no variables of modules, and every store begins anew with the page."""

from __future__ import annotations

import re

import pytest

from tests.house.test_page_names import COMMENT, PAGE, page_files

VARIABLE = re.compile(r"^(?:export )?(?:let|var) (\w+)", re.MULTILINE)
MAKERS = re.compile(r"import (?!type)[^;]*?\b(create|createStore)\b[^;]*? from 'zustand(?:/vanilla)?'")
STORES = {"api/pageStore.ts", "api/liveStore.ts"}
"""The one that makes all others, and the one that is made once more for each run that is shown beside another."""


@pytest.mark.parametrize(
    ("source", "names"),
    [
        ("let due: number | undefined\n", ["due"]),
        ("export let acts = NONE\n", ["acts"]),
        ("function f() {\n  let here = 1\n}\n", []),
        ("// let it\nconst letters = 1\n", []),
    ],
)
def test_variables_of_modules_are_found(source: str, names: list[str]) -> None:
    """What the next test reads; a pattern that finds nothing would let all pass."""
    assert VARIABLE.findall(COMMENT.sub("", source)) == names


def test_no_module_of_the_page_has_a_variable() -> None:
    """Two pages, or two tests, would share it: hold it in a `pageStore`, or in an object that one of these makes."""
    found = {
        str(path.relative_to(PAGE)): names
        for path in page_files(".ts", ".tsx")
        if (names := VARIABLE.findall(COMMENT.sub("", path.read_text(encoding="utf-8"))))
    }
    assert found == {}


def test_stores_of_the_page_begin_anew_with_it() -> None:
    """One that is made by zustand itself keeps what the test before has left in it."""
    found = {
        str(path.relative_to(PAGE))
        for path in page_files(".ts", ".tsx")
        if MAKERS.search(path.read_text(encoding="utf-8"))
    }
    assert found == STORES
