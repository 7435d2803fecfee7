"""While a cell is open, the editor knows the entries of its store: what was taught just now is not missing."""

from __future__ import annotations

from pathlib import Path

from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.journal import Journal
from engine.project.session import Session
from engine.registry import load_states

CELL = """
flexcell: 1
cell: bench
store: {kind: sqlite, path: STORE, seed: ../entries.yaml}
parts: {plate: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1}}
"""
BEHAVIOR = """
flexcell: 1
name: move
cell: cells/bench.yaml
outcomes: [done, failed]
success: [done]
root:
  machine:
    initial: home
    states:
      home:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: taught}}
        transitions: {reached: done, failed: failed}
"""
ID = "behaviors/move.yaml"


async def test_an_entry_that_was_taught_is_not_missing_in_the_editor(tmp_path: Path) -> None:
    """And missing again when it is deleted; without the cell open, the seed counts. What the cell has is offered."""
    (tmp_path / "behaviors" / "cells").mkdir(parents=True)
    (tmp_path / "behaviors" / "entries.yaml").write_text("flexcell: 1\njoints: {home: [0]}\n")
    file = tmp_path / "behaviors" / "cells" / "bench.yaml"
    file.write_text(CELL.replace("STORE", str(tmp_path / "cell.db")))
    (tmp_path / ID).write_text(BEHAVIOR)
    with Journal.open(tmp_path / ".flexcell") as journal:
        async with (
            OpenCell(load_cell(file)) as cell,
            Session(cell, project=tmp_path, catalogue=load_states(), journal=journal) as session,
        ):
            found: list[list[str]] = []
            assert cell.store is not None
            for change in (
                None,
                cell.store.put("joints", "taught", {"joints": [1]}),
                cell.store.delete("joints", "taught"),
            ):
                if change is not None:
                    await change
                codes = [each.code for each in session.documents.examine(ID, BEHAVIOR).findings]
                found.append([code for code in codes if code == "missing-entry"])
            offered = session.documents.offered()
    assert found == [["missing-entry"], [], ["missing-entry"]]
    assert (offered["part"], offered["robot"]) == (("plate",), ())
