"""A decorator of trees is declared once: few files name it, and the page draws it from what the catalogue says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from engine.document.nodes.node_kind import WRAPPERS
from engine.document.nodes.node_kinds import LEAF_ICONS, NODE_KINDS, NodeKind, node_icon
from engine.registry import load_states

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "editor_web" / "frontend" / "src"
KIND_ICON = PAGE / "components" / "KindIcon.tsx"
CONTAINERS = ("machine", "concurrency", "priority", "tree", "foreach")
_KINDS = "|".join((*NODE_KINDS, *LEAF_ICONS))
CHOSEN_BY_KIND = re.compile(rf"^\s*(?:{_KINDS}): .*\bIcon[A-Z]|'(?:{_KINDS})' \? <?Icon", re.MULTILINE)
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


def test_the_page_draws_every_icon_that_the_server_names() -> None:
    """Those of kinds and of states, tools of the cell among them; none is left over."""
    states = {node_icon("state", state) for state in load_states().values()}
    assert set(drawn_icons()) == {*(kind.icon for kind in NODE_KINDS.values()), *LEAF_ICONS.values(), *states}


def test_the_icons_of_nodes_differ() -> None:
    components = list(drawn_icons().values())
    assert len(set(components)) == len(components)


def test_one_file_of_the_page_draws_nodes() -> None:
    """No other one chooses an icon by the kind of a node, or takes an icon that stands for a container."""
    containers = {drawn_icons()[kind.icon] for key, kind in NODE_KINDS.items() if key in CONTAINERS}
    drawing: set[str] = set()
    for path in PAGE.rglob("*.tsx"):
        text = path.read_text(encoding="utf-8")
        if CHOSEN_BY_KIND.search(text) or containers & set(re.findall(r"\w+", text)):
            drawing.add(path.relative_to(PAGE).as_posix())
    assert drawing == {KIND_ICON.relative_to(PAGE).as_posix()}


def test_an_icon_chosen_by_kind_is_seen() -> None:
    assert CHOSEN_BY_KIND.search("const ICONS = {\n  machine: IconHome,\n}")
    assert CHOSEN_BY_KIND.search("  state: { group: 'States', icon: <IconPuzzle /> },")
    assert CHOSEN_BY_KIND.search("const Icon = kind === 'behavior' ? IconFileImport : IconBox")
    assert not CHOSEN_BY_KIND.search("  run: { group: 'Runs', icon: <IconHistory /> },")


@cache
def drawn_icons() -> dict[str, str]:
    """Return what the page draws: names of icons, each with its component."""
    table = KIND_ICON.read_text(encoding="utf-8").partition("const ICONS")[2].partition("\n}")[0]
    return dict(re.findall(r"^  (\w+): (Icon\w+)", table, flags=re.MULTILINE))
