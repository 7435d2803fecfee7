"""A cell and a module under test, with comments, odd spellings and every kind of reference, and edits of them."""

from __future__ import annotations

from pathlib import Path

from engine.editing.cells.cell_edit import AnyCellEdit
from engine.editing.cells.cell_editing import apply_cell_edits

CELL = """\
flexcell: 1
cell: bench            # ours
world: {kind: mujoco}

connectors:
  dock: {parent: table, at: {xyz: [0.50, 0, 0.1]}}   # left edge

modules:
  bin: {module: bin, connector: dock}

fixtures:              # what stands still
  floor: {shape: box, size_m: [2.0, 2, 0.04], at: {xyz: [0, 0, -2.0e-2]}, color: "#d8d5cf"}
  # the table of 2019
  table:
    shape: box
    size_m: [1.0, 0.80, 0.7]   # measured
    at:
      xyz: [0.6, 0.0, 0.35]
      frame: floor             # not the world

frames:
  slot: {parent: table, at: {xyz: [0.1, 0, 0.35], rpy: [0, 0, 1.5708]}}

parts:
  plate:
    shape: box
    size_m: [0.1, 0.1, 0.01]
    mass_kg: 0.5
    at: {xyz: [0, 0, 0.005], frame: slot}

cameras:
  above:
    at: [0.6, 0, 2]
    look_at: [0.6, 0, 0]
    detect: {labels: {plate: steel plate, bin/screw: screw}, frame: slot}
"""
MODULE = """\
flexcell: 1
module: bin
# what lies in it
fixtures:
  tray: {shape: tray, size_m: [0.2, 0.15, 0.05]}
parts:
  screw: {shape: cylinder, size_m: [0.01, 0.03], mass_kg: 0.02, at: {xyz: [0, 0, 0.03]}}
"""


def write_cell(folder: Path, text: str = CELL) -> Path:
    """Write the cell, with its module beside it, and return its file."""
    file = folder / "behaviors" / "cells" / "bench.yaml"
    (file.parent / "bin").mkdir(parents=True)
    file.write_text(text)
    (file.parent / "bin" / "module.yaml").write_text(MODULE)
    return file


def edited(*edits: AnyCellEdit, text: str = CELL) -> str:
    """The text after edits, which must not be refused."""
    made, refused = apply_cell_edits(text, edits, file="bench.yaml")
    assert refused is None, refused
    return made


def refusal(*edits: AnyCellEdit, text: str = CELL) -> tuple[str, str]:
    """Why edits are refused, and the hint; the text stays as it was."""
    made, refused = apply_cell_edits(text, edits, file="bench.yaml")
    assert made == text
    assert refused is not None
    return refused.message, refused.hint
