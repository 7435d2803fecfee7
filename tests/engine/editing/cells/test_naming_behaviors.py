"""Which saved behaviors name an item of the cell: those for this cell, with their nodes."""

from __future__ import annotations

from pathlib import Path

from engine.document.cell import load_cell
from engine.editing import DocumentRepository
from engine.registry import load_states
from tests.engine.editing.cells.cell_texts import write_cell

BEHAVIOR = """\
flexcell: 1
name: {name}
cell: {cell}
outcomes: [done, failed]
success: [done]
root:
  machine:
    initial: look
    states:
      look:
        state: cell.ExpectPart
        with: {{part: {part}, frame: slot}}
        transitions: {{there: done, elsewhere: failed}}
"""


def test_behaviors_for_the_cell_that_name_an_item_are_found(tmp_path: Path) -> None:
    """Not those for other cells, and not those that cannot be read."""
    cell = load_cell(write_cell(tmp_path))
    folder = tmp_path / "behaviors"
    for name, part, of in (("a", "plate", "bench"), ("b", "bin/screw", "bench"), ("c", "plate", "other")):
        text = BEHAVIOR.format(name=name, part=part, cell=f"cells/{of}.yaml")
        (folder / f"{name}.yaml").write_text(text)
    (folder / "d.yaml").write_text("root: [plate")
    documents = DocumentRepository(tmp_path, load_states(), cell=cell)
    assert [(each.id, each.paths) for each in documents.naming("plate")] == [("behaviors/a.yaml", ("root/look",))]
    assert [each.name for each in documents.naming("bin")] == ["b"]
    assert [each.name for each in documents.naming("slot")] == ["a", "b"]
    assert documents.naming("table") == ()
    assert DocumentRepository(tmp_path, load_states()).naming("plate") == ()
