"""What a text of a cell says: items with their lines, findings at them, and where its frames are."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.editing.cells.cell_draft import CellDraft, read_cell_draft
from tests.engine.editing.cells.cell_texts import CELL, MODULE, write_cell


def read(folder: Path, text: str) -> CellDraft:
    file = folder / "behaviors" / "cells" / "bench.yaml"
    return read_cell_draft(text, file=file if file.exists() else write_cell(folder), kind="cell")


def test_items_have_the_lines_that_they_are_written_in(tmp_path: Path) -> None:
    draft = read(tmp_path, CELL)
    assert draft.findings == ()
    lines = CELL.splitlines()
    places = {each.name: (lines[each.line - 1], lines[each.end_line - 1]) for each in draft.items}
    assert places["table"] == ("  table:", "      frame: floor             # not the world")
    assert places["floor"][0] == places["floor"][1]
    assert [each.section for each in draft.items if each.name == "bin"] == ["modules"]
    assert next(each for each in draft.items if each.name == "plate").value["mass_kg"] == 0.5


def test_all_that_something_may_stand_in_has_its_pose_in_the_world(tmp_path: Path) -> None:
    frames = read(tmp_path, CELL).frames
    assert frames["world"].xyz == (0.0, 0.0, 0.0)
    assert frames["table"].xyz == pytest.approx((0.6, 0.0, 0.33))
    assert frames["slot"].xyz == pytest.approx((0.7, 0.0, 0.68))
    assert frames["bin/tray"].xyz == frames["bin"].xyz == frames["dock"].xyz == pytest.approx((1.1, 0.0, 0.43))


def test_a_finding_is_at_its_item(tmp_path: Path) -> None:
    (finding,) = read(tmp_path, CELL.replace("frame: slot}\n\ncameras", "frame: slat}\n\ncameras")).findings
    assert (finding.path, finding.severity) == ("parts/plate", "error")
    assert "`slat`" in finding.message
    assert "slot" in finding.hint
    assert CELL.splitlines()[finding.line - 1].strip().startswith("at:")


def test_all_mistakes_of_a_text_are_found_at_once(tmp_path: Path) -> None:
    text = CELL.replace("mass_kg: 0.5", "mass_kg: heavy").replace(
        "shape: box\n    size_m: [1.0", "shape: bux\n    size_m: [1.0"
    )
    draft = read(tmp_path, text)
    assert sorted(each.path for each in draft.findings) == ["fixtures/table", "parts/plate"]
    assert draft.frames == {}
    assert len(draft.items) == 7


def test_a_text_that_cannot_be_read_has_a_finding_and_no_items(tmp_path: Path) -> None:
    draft = read(tmp_path, CELL + "parts: [")
    assert draft.items == ()
    assert draft.findings[0].line >= CELL.count("\n")
    for text in ("", "- a", "3", "fixtures: [1]\n", "fixtures: {a: 1}\n"):
        assert read(tmp_path, text).findings


def test_a_fault_of_a_module_says_which_file(tmp_path: Path) -> None:
    file = write_cell(tmp_path)
    (file.parent / "bin" / "module.yaml").write_text(MODULE.replace("tray, size", "trey, size"))
    (finding,) = read(tmp_path, CELL).findings
    assert (finding.line, finding.path) == (0, "")
    assert "module.yaml:5" in finding.message
    (file.parent / "bin" / "module.yaml").unlink()
    (finding,) = read(tmp_path, CELL).findings
    assert "module.yaml" in finding.message


def test_a_module_has_poses_in_its_own_frame(tmp_path: Path) -> None:
    draft = read_cell_draft(MODULE, file=tmp_path / "module.yaml", kind="module")
    assert (draft.findings, list(draft.frames)) == ((), ["world", "tray"])
    text = MODULE + "robots: {}\n"
    assert read_cell_draft(text, file=tmp_path / "module.yaml", kind="module").findings[0].path == ""


def test_a_mesh_that_is_not_there_is_found_at_its_fixture(tmp_path: Path) -> None:
    text = CELL.replace("  table:", "  housing: {shape: mesh, file: housing.stl}\n  table:", 1)
    line = text[: text.index("housing")].count("\n") + 1
    draft = read(tmp_path, text)
    (finding,) = draft.findings
    assert (finding.code, finding.path, finding.severity) == ("unusable-mesh", "fixtures/housing", "error")
    assert (finding.line, finding.message) == (line, "`housing.stl`: there is no such file")
    assert "table" in draft.frames
    (tmp_path / "behaviors" / "cells" / "housing.stl").write_bytes(b"solid")
    assert read(tmp_path, text).findings == ()
