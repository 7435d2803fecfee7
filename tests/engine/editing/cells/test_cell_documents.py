"""The files of the open cell and its modules: which can be edited, and saving without overwriting anybody."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import load_cell
from engine.editing import DocumentConflict, DocumentRepository, NoSuchDocument
from engine.editing.cells import CellDocuments
from engine.errors import DocumentError
from tests.engine.editing.cells.cell_texts import CELL, MODULE, write_cell

CELL_ID = "behaviors/cells/bench.yaml"
MODULE_ID = "behaviors/cells/bin/module.yaml"


@pytest.fixture
def cells(tmp_path: Path) -> CellDocuments:
    """Those of a project whose cell is open."""
    return DocumentRepository(tmp_path, {}, cell=load_cell(write_cell(tmp_path))).cells


def test_the_cell_and_the_modules_of_the_project_can_be_edited(cells: CellDocuments, tmp_path: Path) -> None:
    (tmp_path / "node_modules" / "other").mkdir(parents=True)
    (tmp_path / "node_modules" / "other" / "module.yaml").write_text(MODULE)
    assert [(each.id, each.kind, each.folder) for each in cells.listed()] == [
        (CELL_ID, "cell", ""),
        (MODULE_ID, "module", "bin"),
    ]
    assert cells.open(CELL_ID).draft.kind == "cell"
    assert cells.open(MODULE_ID).draft.kind == "module"


@pytest.mark.parametrize(
    "document_id",
    [
        "",
        ".",
        "behaviors/cells/other.yaml",
        "behaviors/cells/../cells/bench.yaml",
        "../module.yaml",
        "/etc/module.yaml",
        "node_modules/a/module.yaml",
        ".flexcell/module.yaml",
        "a\0b/module.yaml",
        "flexcell.yaml",
    ],
)
def test_no_other_file_is_read_or_written(cells: CellDocuments, tmp_path: Path, document_id: str) -> None:
    (tmp_path / "behaviors" / "cells" / "other.yaml").write_text(CELL)
    with pytest.raises(NoSuchDocument):
        cells.open(document_id)
    with pytest.raises(NoSuchDocument):
        cells.save(document_id, CELL, base_hash="0" * 64)


def test_a_link_that_leads_out_of_the_project_is_not_followed(cells: CellDocuments, tmp_path: Path) -> None:
    outside = tmp_path.parent / f"{tmp_path.name}_outside"
    outside.mkdir()
    (outside / "module.yaml").write_text(MODULE)
    (tmp_path / "linked").symlink_to(outside)
    with pytest.raises(NoSuchDocument):
        cells.open("linked/module.yaml")


def test_a_saved_text_is_on_disk_and_the_text_before_is_a_version(cells: CellDocuments, tmp_path: Path) -> None:
    opened = cells.open(CELL_ID)
    text = CELL.replace("0.80", "0.90")
    saved = cells.save(CELL_ID, text, base_hash=opened.stored.hash)
    assert (tmp_path / CELL_ID).read_text() == text
    assert saved.hash != opened.stored.hash
    assert (tmp_path / ".flexcell" / "versions" / CELL_ID).is_dir()
    assert cells.save(CELL_ID, text, base_hash=saved.hash).hash == saved.hash


def test_a_document_with_errors_is_saved_but_not_what_is_no_document(cells: CellDocuments) -> None:
    base = cells.open(CELL_ID).stored.hash
    for text in ("- a\n", "a: ["):
        with pytest.raises(DocumentError):
            cells.save(CELL_ID, text, base_hash=base)
    cells.save(CELL_ID, CELL.replace("frame: slot", "frame: nowhere"), base_hash=base)


def test_a_file_that_has_changed_is_not_overwritten(cells: CellDocuments, tmp_path: Path) -> None:
    base = cells.open(CELL_ID).stored.hash
    mine = CELL.replace("mass_kg: 0.5", "mass_kg: 0.6")
    theirs = CELL.replace("# ours", "# theirs")
    (tmp_path / CELL_ID).write_text(theirs)
    with pytest.raises(DocumentConflict) as met:
        cells.save(CELL_ID, mine, base_hash=base)
    assert (tmp_path / CELL_ID).read_text() == theirs
    assert met.value.theirs.text == theirs
    assert met.value.merge is not None
    assert met.value.merge.text == mine.replace("# ours", "# theirs")
    (tmp_path / CELL_ID).write_text(CELL.replace("mass_kg: 0.5", "mass_kg: 0.7"))
    with pytest.raises(DocumentConflict) as met:
        cells.save(CELL_ID, mine, base_hash=base)
    assert met.value.merge is None


def test_a_merge_that_has_errors_is_for_a_person(cells: CellDocuments, tmp_path: Path) -> None:
    """One removes the frame in which the other puts a fixture."""
    base = cells.open(CELL_ID).stored.hash
    mine = CELL.replace("  floor:", "  lamp: {shape: box, size_m: [1, 1, 1], at: {frame: slot}}\n  floor:")
    theirs = CELL.replace("  slot:", "  nest:").replace("frame: slot", "frame: nest")
    (tmp_path / CELL_ID).write_text(theirs)
    with pytest.raises(DocumentConflict) as met:
        cells.save(CELL_ID, mine, base_hash=base)
    assert met.value.merge is None
