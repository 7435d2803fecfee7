"""A document of another kind is named as what it is, not by its keys one after another."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from engine.document.document_kind import kind_of
from engine.document.loader import load_behavior
from engine.errors import DocumentError
from tests.engine.cli.command import flexcell

BEHAVIOR = "flexcell: 1\nname: wait\noutcomes: [done]\nroot: {state: flow.Wait, with: {duration_s: 0.1}}\n"
CELL = "flexcell: 1\ncell: bench\nworld: {kind: mujoco}\n"


@pytest.mark.parametrize(
    ("data", "kind"),
    [
        ({"cell": "a", "root": {}}, "behavior"),
        ({"cell": "a", "behavior": "b"}, "sweep"),
        ({"cell": "a", "fixtures": {}}, "cell"),
        ({"module": "a", "fixtures": {}}, "module"),
        ({"joints": {}}, "entries"),
        ({"floor": 1}, None),
        ([], None),
    ],
)
def test_a_kind_is_known_by_the_keys(data: object, kind: str | None) -> None:
    assert kind_of(data) == kind


def test_a_cell_is_no_behavior_and_a_behavior_no_cell(tmp_path: Path) -> None:
    behavior, cell = tmp_path / "wait.yaml", tmp_path / "bench.yaml"
    behavior.write_text(BEHAVIOR, encoding="utf-8")
    cell.write_text(CELL, encoding="utf-8")
    with pytest.raises(DocumentError, match="this is a behavior document, not a cell") as refused:
        load_cell(behavior)
    assert "flexcell run BEHAVIOR --cell CELL" in (refused.value.hint or "")
    with pytest.raises(DocumentError, match="this is a cell document, not a behavior"):
        load_behavior(cell)
    said = flexcell("run", "bench.yaml", cwd=tmp_path)
    assert (said.code, "bench.yaml:1:1: this is a cell document, not a behavior" in said.err) == (2, True), said.err


def test_a_document_with_mistakes_has_its_own(tmp_path: Path) -> None:
    behavior = tmp_path / "wait.yaml"
    behavior.write_text(BEHAVIOR.replace("outcomes:", "outcome:"), encoding="utf-8")
    with pytest.raises(DocumentError, match="unknown key `outcome`"):
        load_behavior(behavior)
