"""Hexapods in documents: what leads nowhere, cannot move, or is out of reach of the legs is refused at its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import Cell, load_cell
from engine.errors import DocumentError, Position

MODULE = """\
flexcell: 1
module: hexapod
frames:
  grip: {parent: handle, at: {xyz: [0, 0, 0.02]}}
fixtures:
  base: {shape: cylinder, size_m: [0.3, 0.02], at: {xyz: [0, 0, 0.01]}}
  platform: {shape: cylinder, size_m: [0.2, 0.016], at: {xyz: [0, 0, 0.19]}}
  handle: {shape: box, size_m: [0.03, 0.03, 0.06], at: {frame: platform, xyz: [0, 0, 0.038]}}
devices:
  legs:
    hexapod:
      base: base
      platform: platform
      carries: [handle]
      base_joints: {radius_m: 0.13, spread_rad: 0.4, z_m: 0.01}
      platform_joints: {radius_m: 0.08, spread_rad: 0.4, z_m: -0.008}
      length_m: [0.15, 0.23]
      brakes: release
      grip: grip
      poses:
        level: {xyz: [0, 0, 0.18]}
    positions:
      released: {steps: [{set: {release: true}}], time: 0.3 s}
      locked: {steps: [{set: {release: false}}], time: 0.3 s}
"""
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
connectors: {dock: {at: {xyz: [0.5, 0, 0.1]}}}
modules: {jig: {module: hexapod, connector: dock}}
"""


def jig(folder: Path, *changes: tuple[str, str], cell: str = CELL) -> Cell:
    """Return the cell with a hexapod whose text is changed."""
    text = MODULE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "hexapod").mkdir()
    (folder / "hexapod" / "module.yaml").write_text(text, encoding="utf-8")
    (folder / "cell.yaml").write_text(cell, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def test_what_a_hexapod_names_has_its_name_in_the_cell(tmp_path: Path) -> None:
    device = jig(tmp_path).document.devices["jig/legs"]
    hexapod = device.hexapod
    assert hexapod is not None
    assert (hexapod.base, hexapod.bodies, hexapod.grip) == ("jig/base", ("jig/platform", "jig/handle"), "jig/grip")
    assert device.moved_fixtures == hexapod.bodies


@pytest.mark.parametrize(
    ("old", "new", "message", "line"),
    [
        (
            "level: {xyz: [0, 0, 0.18]}",
            "level: {xyz: [0, 0, 0.25]}",
            "leg 1 would be 16.0 mm longer than its 230.0 mm",
            21,
        ),
        ("xyz: [0, 0, 0.19]", "xyz: [0, 0, 0.1]", "where `platform` stands, leg 1 would be", 13),
        ("carries: [handle]", "carries: []", "`handle` stands on `platform` and would not move with it", 12),
        ("at: {frame: platform, xyz: [0, 0, 0.038]}", "at: {xyz: [0, 0, 0.2]}", "does not stand on the platform", 19),
        ("carries: [handle]", "carries: [handel]", "there is no fixture `handel`", 14),
        ("grip: grip", "grip: gripp", "there is no frame `gripp`", 19),
        ("platform: platform", "platform: base", "base and platform are the same fixture", 13),
        ("[0.15, 0.23]", "[0.23, 0.15]", "the shortest leg is not shorter than the longest", 17),
        ("brakes: release", "brakes: relase", "no step sets the output `relase`", 18),
        ("      locked:", "      braked:", "the device has no position `locked` for its brakes", 11),
    ],
)
def test_what_cannot_be_is_refused_at_its_place(tmp_path: Path, old: str, new: str, message: str, line: int) -> None:
    with pytest.raises(DocumentError, match=message) as raised:
        jig(tmp_path, (old, new))
    where = raised.value.where
    assert isinstance(where, Position)
    assert (Path(where.file).name, where.line) == ("module.yaml", line)


def test_a_camera_does_not_stand_on_a_platform(tmp_path: Path) -> None:
    camera = "cameras: {eye: {frame: jig/platform, at: [0, 0, 0.5], look_at: [0, 0, 0]}}\n"
    with pytest.raises(DocumentError, match="`eye` stands on the platform of `jig/legs`, which moves"):
        jig(tmp_path, cell=CELL + camera)


def test_a_fixture_of_the_cell_does_not_stand_on_the_platform_of_a_module(tmp_path: Path) -> None:
    nest = "fixtures: {nest: {shape: box, size_m: [0.1, 0.1, 0.1], at: {frame: jig/platform}}}\n"
    with pytest.raises(DocumentError, match="`nest` stands on `jig/platform` and would not move with it"):
        jig(tmp_path, cell=CELL + nest)
