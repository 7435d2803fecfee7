"""Cells with the values of factors."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from engine.document.cell import Cell, load_cell
from engine.errors import DocumentError
from engine.sweep.subject.cell_variation import varied_cell

CELL = """\
flexcell: 1
cell: table
world: {kind: mujoco}
parts:
  bolt: {shape: cylinder, size_m: [0.01, 0.05], mass_kg: 0.2, at: {xyz: [0.1, 0.2, 0.3], rpy: [0, 0, 1.0]}}
  nut: {shape: box, size_m: [0.01, 0.01, 0.01], mass_kg: 0.1}
fixtures:
  pad: {shape: box, size_m: [0.1, 0.1, 0.1], spring: {stiffness_n_m: 1000}}
"""


@pytest.fixture
def cell(tmp_path: Path) -> Cell:
    file = tmp_path / "cell.yaml"
    file.write_text(CELL, encoding="utf-8")
    return load_cell(file)


def test_a_displacement_is_added_to_the_written_pose(cell: Cell) -> None:
    varied = varied_cell(cell, {"displace.bolt.x_m": 0.01, "displace.bolt.z_m": -0.1, "displace.bolt.yaw_rad": 0.5})
    at = varied.document.parts["bolt"].at
    assert at.xyz == pytest.approx((0.11, 0.2, 0.2))
    assert at.rpy == pytest.approx((0.0, 0.0, 1.5))
    assert varied.document.parts["nut"] == cell.document.parts["nut"]


def test_a_part_without_a_written_pose_is_displaced_from_its_default(cell: Cell) -> None:
    varied = varied_cell(cell, {"displace.nut.y_m": 0.02, "displace.nut.yaw_rad": math.pi})
    assert varied.document.parts["nut"].at.xyz == (0.0, 0.02, 0.0)
    assert varied.document.parts["nut"].at.rpy == (0.0, 0.0, math.pi)


BONDS = """
bonds:
  seam: {kind: glue, part: nut, to: bolt}
  base: {kind: clip, part: ring, to: disc}
  rest: {kind: clip, part: disc, to: pad}
"""
RINGS = """\
  ring: {shape: sphere, size_m: [0.01], mass_kg: 0.1, at: {xyz: [1, 1, 1]}}
  disc: {shape: sphere, size_m: [0.01], mass_kg: 0.1, at: {xyz: [1, 1, 2]}}
fixtures:
"""


@pytest.fixture
def joined(tmp_path: Path) -> Cell:
    file = tmp_path / "cell.yaml"
    file.write_text(CELL.replace("fixtures:\n", RINGS) + BONDS, encoding="utf-8")
    return load_cell(file)


def test_what_is_joined_to_a_displaced_part_is_displaced_and_turned_with_it(joined: Cell) -> None:
    """The bolt is at (0.1, 0.2, 0.3) and the nut at the origin: they turn about the bolt by a quarter."""
    parts = varied_cell(joined, {"displace.bolt.x_m": 0.5, "displace.bolt.yaw_rad": math.pi / 2}).document.parts
    assert parts["bolt"].at.xyz == pytest.approx((0.6, 0.2, 0.3))
    assert parts["nut"].at.xyz == pytest.approx((0.6 + 0.2, 0.2 - 0.1, 0.0))
    assert parts["nut"].at.rpy == pytest.approx((0.0, 0.0, math.pi / 2))
    assert parts["ring"] == joined.document.parts["ring"]


@pytest.mark.parametrize(
    ("displaced", "message"),
    [
        (("ring",), "`ring` is joined to the fixture `pad`"),
        (("nut", "bolt"), "`bolt` and `nut` are joined and are displaced as one"),
    ],
)
def test_what_cannot_be_displaced_as_one_is_refused(joined: Cell, displaced: tuple[str, ...], message: str) -> None:
    with pytest.raises(DocumentError, match=message):
        varied_cell(joined, {f"displace.{name}.x_m": 0.01 for name in displaced})


def test_any_value_of_the_document_can_be_varied(cell: Cell) -> None:
    values = {
        "cell.parts.bolt.mass_kg": 1.5,
        "cell.fixtures.pad.spring.friction": 0.9,
        "cell.world.gravity": False,
        "cell.parts.bolt.at.xyz.1": 0.7,
        "cell.parts.nut.jitter.xy_m": 0.003,
    }
    document = varied_cell(cell, values).document
    assert document.parts["bolt"].mass_kg == 1.5
    assert document.fixtures["pad"].spring is not None
    assert document.fixtures["pad"].spring.friction == 0.9
    assert document.world is not None
    assert not document.world.gravity
    assert document.parts["bolt"].at.xyz == (0.1, 0.7, 0.3)
    assert document.parts["nut"].jitter.xy_m == 0.003


def test_the_cell_itself_and_its_file_stay(cell: Cell) -> None:
    before = cell.document
    varied = varied_cell(cell, {"cell.parts.bolt.mass_kg": 1.5, "parameters.speed": 0.3})
    assert cell.document == before
    assert cell.document.parts["bolt"].mass_kg == 0.2
    assert varied.file == cell.file


def test_without_a_factor_of_the_cell_it_is_the_same(cell: Cell) -> None:
    assert varied_cell(cell, {"parameters.speed": 0.3, "seed": 4}) is cell


@pytest.mark.parametrize(
    ("address", "value", "message"),
    [
        ("displace.bold.x_m", 0.1, r"displace.bold.x_m: the cell has no part `bold` \(did you mean bolt\?\)"),
        ("displace.bolt.x_m", "far", "a displacement is a number, not 'far'"),
        ("displace.bolt.x_m", True, "a displacement is a number, not True"),
        ("cell.parts.bolt.mas_kg", 1.0, "cell.yaml:5.*unknown key `mas_kg`.*mass_kg"),
        ("cell.parts.bolt.mass_kg", -1.0, "cell.yaml:5.*`mass_kg`"),
        ("cell.parts.bolt.mass_kg.more", 1.0, "there is nothing named `more` in 0.2"),
        ("cell.parts.bolt.at.xyz.3", 1.0, "the list has 3 values"),
        ("cell.parts.bolt.at.xyz.x", 1.0, r"there is nothing named `x` in \[0.1, 0.2, 0.3\]"),
    ],
)
def test_a_factor_that_names_nothing_says_so(cell: Cell, address: str, value: object, message: str) -> None:
    with pytest.raises(DocumentError, match=message):
        varied_cell(cell, {address: value})
