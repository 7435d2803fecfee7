"""`flexcell cell new`: a document that is valid as it is, and never another one's."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from tests.engine.cli.command import flexcell


def test_a_new_cell_is_valid_and_says_what_is_next(tmp_path: Path) -> None:
    said = flexcell("cell", "new", "cells/press.yaml", cwd=tmp_path)
    assert said.code == 0, said.err
    assert said.out.splitlines() == [
        "cells/press.yaml",
        "Build it in the browser: flexcell serve --cell cells/press.yaml, then press *Edit the cell*.",
    ]
    document = load_cell(tmp_path / "cells" / "press.yaml").document
    assert (document.cell, list(document.fixtures), document.robots) == ("press", ["floor"], {})
    assert flexcell("check", "cells/press.yaml", cwd=tmp_path).code == 0


@pytest.mark.parametrize(("file", "name"), [("Our Cell-2.yaml", "our_cell_2"), ("2.yml", "cell_2"), ("ü.yaml", "cell")])
def test_its_name_is_that_of_the_file_in_letters_that_a_name_may_have(tmp_path: Path, file: str, name: str) -> None:
    assert flexcell("cell", "new", file, cwd=tmp_path).code == 0
    assert load_cell(tmp_path / file).document.cell == name


def test_a_file_that_exists_stays_as_it_is(tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text("mine", encoding="utf-8")
    said = flexcell("cell", "new", "cell.yaml", cwd=tmp_path)
    assert (said.code != 0, "cell.yaml exists already" in said.err) == (True, True)
    assert file.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(("file", "why"), [("cell.json", "is no YAML file"), ("mine/cell.yaml", "cannot be written")])
def test_a_place_where_no_document_can_be_is_named(tmp_path: Path, file: str, why: str) -> None:
    (tmp_path / "mine").write_text("a file", encoding="utf-8")
    said = flexcell("cell", "new", file, cwd=tmp_path)
    assert (said.code != 0, file in said.err, why in said.err) == (True, True, True), said.err
