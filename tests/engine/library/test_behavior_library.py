"""The editor's library checks a behavior anew when its cell or entries change, with the same function."""

from __future__ import annotations

import os
from pathlib import Path

from engine.check import check_file, read_beside
from engine.document import load_behavior
from engine.library.behavior_library import Library
from tests.engine.check.checking import CATALOGUE, HEAD

MOVE = """\
cell: cell.yaml
root:
  machine:
    initial: home
    states:
      home:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: home}}
        transitions: {reached: good, failed: bad}
"""
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots: {left: {model: panda}}
store: {kind: sqlite, path: x.db, seed: entries.yaml}
"""


def test_a_finding_goes_when_the_entry_comes(tmp_path: Path) -> None:
    """And the command line says the same."""
    folder = tmp_path / "behaviors"
    folder.mkdir()
    for name, text in {"move.yaml": HEAD + MOVE, "cell.yaml": CELL}.items():
        (folder / name).write_text(text, encoding="utf-8")
    entries = folder / "entries.yaml"
    entries.write_text("flexcell: 1\njoints: {away: [0]}\n", encoding="utf-8")
    library = Library(tmp_path, CATALOGUE)
    assert [finding.code for finding in library.view("behaviors/move.yaml").findings] == ["missing-entry"]
    assert [finding.code for finding in check_file(folder / "move.yaml", CATALOGUE)] == ["missing-entry"]
    entries.write_text("flexcell: 1\njoints: {home: [0]}\n", encoding="utf-8")
    os.utime(entries, (1, 1))
    assert library.view("behaviors/move.yaml").findings == ()


def test_the_files_beside_a_behavior_are_its_cell_and_the_entries_of_that(tmp_path: Path) -> None:
    """A cell that cannot be read is watched as well, for it may become readable."""
    file = tmp_path / "move.yaml"
    file.write_text(HEAD + MOVE, encoding="utf-8")
    assert read_beside(load_behavior(file)) == (tmp_path / "cell.yaml",)
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    assert read_beside(load_behavior(file)) == (tmp_path / "cell.yaml", tmp_path / "entries.yaml")
    file.write_text(HEAD + MOVE.replace("cell: cell.yaml\n", ""), encoding="utf-8")
    assert read_beside(load_behavior(file)) == ()
