"""Modules of a cell: what stands on them is in the cell below their names, and moves with their connectors."""

from __future__ import annotations

import math
import re
from pathlib import Path

import msgspec
import pytest

from engine.document.cell import Cell, load_cell
from engine.document.cell_modules import docked
from engine.document.cell_perception import DepthCamera
from engine.document.module_document import ModuleDocument
from engine.errors import DocumentError

MODULE = """\
flexcell: 1
module: bin
frames:
  slot: {parent: tray, at: {xyz: [0.05, 0, 0.01]}}
fixtures:
  tray: {shape: tray, size_m: [0.3, 0.2, 0.03]}
parts:
  block: {shape: box, size_m: [0.04, 0.04, 0.04], mass_kg: 0.1, at: {frame: slot, xyz: [0, 0, 0.02]}}
cameras:
  eye: {at: [0, 0, 0.8], look_at: [0, 0.1, 0], detect: {frame: slot, labels: {block: a block}}}
"""
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  table: {shape: box, size_m: [1, 1, 0.4], at: {xyz: [0.5, 0, 0.2]}}
frames:
  gauge: {parent: right/slot}
connectors:
  dock_a: {parent: table, at: {xyz: [0, 0.3, 0.2]}}
  dock_b: {parent: table, at: {xyz: [0, -0.3, 0.2], rpy: [0, 0, 1.5707963267948966]}}
modules:
  left: {module: modules/bin, connector: dock_a}
  right: {module: modules/bin/module.yaml, connector: dock_b}
"""


def written(folder: Path, *, cell: str = CELL, module: str = MODULE) -> Cell:
    """Return the cell of two bins."""
    (folder / "modules" / "bin").mkdir(parents=True, exist_ok=True)
    (folder / "modules" / "bin" / "module.yaml").write_text(module, encoding="utf-8")
    (folder / "cell.yaml").write_text(cell, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def test_what_stands_on_a_module_is_placed_by_its_connector(tmp_path: Path) -> None:
    """The second connector is turned by 90°: what is before the bin along x is along y of the world."""
    document = written(tmp_path).document
    assert list(document.fixtures) == ["table", "left/tray", "right/tray"]
    assert document.fixtures["left/tray"].at.xyz == pytest.approx((0.5, 0.3, 0.4))
    assert document.parts["left/block"].at.xyz == pytest.approx((0.55, 0.3, 0.43))
    assert document.parts["right/block"].at.xyz == pytest.approx((0.5, -0.25, 0.43))
    assert document.parts["right/block"].at.rpy == pytest.approx((0.0, 0.0, math.pi / 2.0))
    eye = document.cameras["right/eye"]
    assert (*eye.at, *eye.look_at) == pytest.approx((0.5, -0.3, 1.2, 0.4, -0.3, 0.4))
    assert eye.detect is not None
    assert eye.detect.labels == {"right/block": "a block"}
    assert eye.detect.frame == "right/slot"
    assert eye.detect.frame_at.xyz == pytest.approx((0.5, -0.25, 0.41))
    assert list(document.fixed_frames) == ["gauge", "dock_a", "dock_b", "left", "left/slot", "right", "right/slot"]
    assert document.fixed_frames["gauge"].xyz == pytest.approx((0.5, -0.25, 0.41))
    assert document.fixed_frames["left"].xyz == pytest.approx((0.5, 0.3, 0.4))
    assert document.in_world() == document


def test_each_item_is_found_where_it_is_written(tmp_path: Path) -> None:
    """What is wrong with it is said there, in the file of its module."""
    cell = written(tmp_path)
    module = str(tmp_path / "modules" / "bin" / "module.yaml")
    for path, file, line in (
        (("parts", "right/block", "mass_kg"), module, 8),
        (("cameras", "left/eye"), module, 10),
        (("frames", "left"), str(tmp_path / "cell.yaml"), 12),
        (("frames", "dock_b", "parent"), str(tmp_path / "cell.yaml"), 10),
        (("fixtures", "table"), str(tmp_path / "cell.yaml"), 5),
    ):
        position = cell.source.position(path)
        assert (position.file, position.line) == (file, line)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("connector: dock_b", "connector: dock_c", "cell.yaml:13:55: the cell has no connector `dock_c`"),
        ("connector: dock_b", "connector: dock_a", "cell.yaml:13:55: `left` and `right` are docked to the same"),
        ("module: modules/bin,", "module: modules/box,", "cell.yaml:12:18: module `left` is not there: "),
        ("  left: {module", "  table: {module", "cell.yaml:12:3: `table` is both a module and a fixture"),
        ("  dock_a: {parent", "  gauge: {parent", "cell.yaml:9:3: `gauge` is both a connector and a frame"),
        ("  left: {module", "  dock_a: {module", "cell.yaml:12:3: `dock_a` is both a module and a connector"),
        (
            "gauge: {parent: right/slot}",
            "gauge: {parent: right/slit}",
            "cell.yaml:7:19: `gauge` stands in",
        ),
    ],
)
def test_a_module_that_cannot_be_docked_is_refused_where_it_is_written(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in CELL
    with pytest.raises(DocumentError, match=re.escape(message)):
        written(tmp_path, cell=CELL.replace(old, new))


def test_frames_and_fixtures_do_not_stand_in_one_another_across_a_module(tmp_path: Path) -> None:
    """The table stands in the bin that stands on the table."""
    with pytest.raises(DocumentError, match="stand in one another"):
        written(tmp_path, cell=CELL.replace("at: {xyz: [0.5, 0, 0.2]}", "at: {frame: left/slot, xyz: [0.5, 0, 0.2]}"))


def test_a_changed_module_is_another_content(tmp_path: Path) -> None:
    """So that a served cell is known to have changed."""
    content = written(tmp_path).content
    assert written(tmp_path).content == content
    assert written(tmp_path, module=MODULE.replace("mass_kg: 0.1", "mass_kg: 0.2")).content != content


def test_nothing_of_a_module_has_a_name_outside_of_it() -> None:
    """Nor does it stand in a frame that its connector does not carry."""
    document = msgspec.yaml.decode(MODULE, type=ModuleDocument)
    items = docked("vice", document, connector="dock")
    names = [*items.frames, *items.fixtures, *items.parts, *items.cameras]
    assert {name.partition("/")[0] for name in names} == {"vice"}
    assert items.frames["vice"].parent == "dock"
    frames = [*(each.at.frame for each in (*items.fixtures.values(), *items.parts.values()))]
    assert set(frames) == {"vice", "vice/slot"}


def test_names_below_a_module_pass_to_another_process(tmp_path: Path) -> None:
    """The world and the detectors of a cell in real time are told in messages, which are checked when they are read."""
    cameras = written(tmp_path).document.cameras
    assert msgspec.json.decode(msgspec.json.encode(cameras), type=dict[str, DepthCamera]) == cameras
