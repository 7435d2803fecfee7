"""A decorator of trees is declared once: few files name it, and the page draws it from what the catalogue says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from engine.document.nodes.node_kind import WRAPPERS
from engine.document.nodes.node_kinds import NODE_KINDS, NodeKind

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "editor_web" / "frontend" / "src"
DECORATORS = {key: kind for key, kind in NODE_KINDS.items() if kind.is_decorator and key not in WRAPPERS}
"""Without `retry`, `timeout` and `guard`: they are keys of every node, planned, recorded and drawn as its policies."""
ORDINARY_WORDS = {
    "repeat": "the operator repeats nodes, and key presses repeat",
    "condition": "concurrency containers, branches and breakpoints have conditions",
}
"""Keys that are used for other things as well: of these kinds only the names of their classes are counted."""
MODELS, RUNTIME, AUTHORING = (
    "engine/document/nodes/node_spec.py",
    "engine/runtime/tree/decorators.py",
    "engine/authoring/tree_steps.py",
)


@cache
def sources() -> dict[str, frozenset[str]]:
    """Return the words of each file of the engine and the page."""
    files = [*(ROOT / "engine").rglob("*.py"), *PAGE.rglob("*.ts"), *PAGE.rglob("*.tsx")]
    return {
        path.relative_to(ROOT).as_posix(): frozenset(re.findall(r"\w+", path.read_text(encoding="utf-8")))
        for path in files
    }


def names_of(kind: NodeKind) -> Iterator[str]:
    """Yield the names of a kind: its key, the class of its model, and the class that executes it."""
    assert kind.model is not None
    yield kind.model.__name__
    executing = kind.model.__name__.removesuffix("Spec")
    if kind.kind not in ORDINARY_WORDS:
        yield from (kind.kind, executing)
    elif executing.lower() != kind.kind:
        yield executing


@pytest.mark.parametrize("key", DECORATORS)
def test_at_most_three_files_name_a_decorator(key: str) -> None:
    """Its model, what it does in a run, and its function for behaviors in Python."""
    names = set(names_of(DECORATORS[key]))
    naming = {path for path, words in sources().items() if names & words}
    assert naming <= {MODELS, RUNTIME, AUTHORING}
    assert {MODELS, RUNTIME} <= naming


def test_there_are_decorators_to_count() -> None:
    """Those without a policy of the same name; the exceptions are among them."""
    assert ORDINARY_WORDS.keys() <= DECORATORS.keys()
    assert {"inverter", "one_shot", "cooldown", "remap"} <= DECORATORS.keys()


def test_every_kind_has_an_icon_of_the_page() -> None:
    """The catalogue gives the name of an icon, the page its drawing; none is left over."""
    text = (PAGE / "features" / "editor" / "NodeIcon.tsx").read_text(encoding="utf-8")
    table = text.partition("const ICONS")[2].partition("\n}")[0]
    drawn = set(re.findall(r"^  (\w+): Icon", table, flags=re.MULTILINE))
    assert drawn == {kind.icon for kind in NODE_KINDS.values()}
