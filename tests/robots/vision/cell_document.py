"""The document of a cell that cameras watch, for tests of the whole device."""

from __future__ import annotations

from pathlib import Path

from engine.document.cell import Cell, load_cell

_TEXT = """
flexcell: 1
cell: watched
world: {kind: mujoco, step_s: 0.002}
robots:
  arm: {model: servo_arm, driver: sim, base: {xyz: [0, 0, 0]}}
fixtures:
  floor: {shape: box, size_m: [2.6, 2.6, 0.04], at: {xyz: [0.3, 0, -0.02]}}
parts:
  cube: {shape: box, size_m: [0.05, 0.05, 0.05], mass_kg: 0.1, at: {xyz: [0.6, 0.2, 0.025]}}
people:
  anna: {shoulder: [0.8, 0.4, 0.55], hand_rests: [0.95, 0.45, 0.1]}
cameras:
  top: {at: [0.9, 0.0, 1.8], look_at: [0.4, 0, 0.1], fov_rad: 1.2, noise_m: 0.001}
  side: {at: [0.4, 1.2, 1.2], look_at: [0.4, 0, 0.1], rate_hz: 5}
occupancy: {center_m: [0.4, 0.0, 0.4], size_m: [0.8, 1.2, 0.8]}
"""


def watched(folder: Path) -> Cell:
    """Return the cell, written to a folder."""
    file = folder / "watched.yaml"
    file.write_text(_TEXT, encoding="utf-8")
    return load_cell(file)
