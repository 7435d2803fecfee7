"""The behaviors of this project: what is done to any node of them and taken back leaves every byte as it was."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import pytest

from engine.editing import Draft
from engine.editing.text.outline import NodeRef, Outline
from tests.engine.editing.edit_fixtures import edited

BEHAVIORS = Path(__file__).parents[3] / "behaviors"
FILES = [file for file in sorted(BEHAVIORS.rglob("*.yaml")) if "\nroot:" in file.read_text(encoding="utf-8")]
NAMED = ("machine", "priority", "concurrency")


def refs(text: str) -> list[NodeRef]:
    """The nodes of a document, every third one: enough to meet all layouts."""
    return list(Outline(Draft(text, file="x.yaml").data).refs.values())[1::3]


@pytest.fixture(params=FILES, ids=lambda file: file.name)
def text(request: pytest.FixtureRequest) -> str:
    """One behavior."""
    file: Path = request.param
    return file.read_bytes().decode()


def test_a_rename_is_taken_back_by_another(text: str) -> None:
    for ref in refs(text):
        if ref.parent is not None and ref.parent.kind in NAMED:
            there = edited(text, {"edit": "rename_node", "path": ref.path, "name": "something_else"})
            path = f"{ref.parent.path}/something_else"
            assert there != text
            assert edited(there, {"edit": "rename_node", "path": path, "name": ref.name}) == text


def test_a_duplicate_is_removed_again(text: str) -> None:
    for ref in refs(text):
        if ref.parent is not None and ref.parent.kind in NAMED:
            twice = edited(text, {"edit": "duplicate", "paths": [ref.path]})
            (copy,) = set(Outline(Draft(twice, file="x").data).at(ref.parent.path).states) - set(ref.parent.states)
            assert edited(twice, {"edit": "remove_nodes", "paths": [f"{ref.parent.path}/{copy}"]}) == text


def test_what_a_node_says_is_set_and_taken_away(text: str) -> None:
    for ref in refs(text):
        for field, value in (("retry", {"times": 2}), ("autonomy", {"failed": "high"})):
            if field not in ref.data and not ref.in_tree:
                edit = {"edit": "set_field", "path": ref.path, "field": field}
                assert edited(edited(text, {**edit, "value": value}), edit) == text


def test_a_group_is_dissolved_again(text: str) -> None:
    for ref in refs(text):
        if ref.parent is not None and ref.parent.kind == "machine":
            made = edited(text, {"edit": "group", "paths": [ref.path], "kind": "machine", "name": "inner"})
            assert edited(made, {"edit": "ungroup", "path": f"{ref.parent.path}/inner"}) == text


def test_all_nodes_are_placed_and_forgotten(text: str) -> None:
    draft = Draft(text, file="x.yaml")
    view = cast("dict[str, object]", draft.data.get("view", {}))
    paths = [path for path in Outline(draft.data).refs if path not in view]
    made = edited(text, {"edit": "set_positions", "positions": {path: [10, 20] for path in paths}})
    assert edited(made, {"edit": "set_positions", "positions": dict.fromkeys(paths)}) == text
