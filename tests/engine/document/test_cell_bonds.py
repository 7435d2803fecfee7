"""Bonds as data: names that lead nowhere are refused at their place; modules bring theirs with names in the cell."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import Cell, load_cell
from engine.document.cell_bonds import BondSpec, joined_groups
from engine.document.docking import cell_as_docked
from engine.errors import DocumentError

MODULE = """\
flexcell: 1
module: product
fixtures:
  base: {shape: box, size_m: [0.2, 0.2, 0.1]}
parts:
  board: {shape: box, size_m: [0.06, 0.04, 0.002], mass_kg: 0.02, at: {xyz: [0, 0, 0.1]}}
  battery: {shape: box, size_m: [0.02, 0.02, 0.02], mass_kg: 0.02, at: {xyz: [0.05, 0, 0.1]}}
bonds:
  tabs: {kind: solder, part: battery, to: board, at_m: [-0.01, 0, 0], force_n: 60, cut_n: 20}
  pad: {kind: glue, part: board, to: base, torque_nm: 1}
"""
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
connectors: {dock: {}}
modules: {product: {module: product, connector: dock}}
"""


def product(folder: Path, *changes: tuple[str, str]) -> Cell:
    """Return the cell with a product whose text is changed."""
    text = MODULE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "product").mkdir()
    (folder / "product" / "module.yaml").write_text(text, encoding="utf-8")
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def test_what_a_bond_joins_has_its_name_in_the_cell(tmp_path: Path) -> None:
    cell = product(tmp_path)
    bonds = cell.document.bonds
    assert {name: (bond.part, bond.to) for name, bond in bonds.items()} == {
        "product/tabs": ("product/battery", "product/board"),
        "product/pad": ("product/board", "product/base"),
    }
    assert cell_as_docked(cell, {"product": "dock"}).bonds == bonds
    assert cell_as_docked(cell, {}).bonds == {}


@pytest.mark.parametrize(
    ("old", "new", "message", "line"),
    [
        ("part: battery", "part: batery", "there is no part `batery`", 9),
        ("part: battery", "part: base", "there is no part `base`", 9),
        ("to: board", "to: bord", "there is no part and no fixture `bord`", 9),
        ("to: board", "to: battery", "`battery` is joined to itself", 9),
        ("torque_nm: 1", "torque_nm: 1, point: true", "a `point` carries no torque", 10),
        ("kind: glue", "kind: magic", "magic", 10),
        ("force_n: 60", "force_n: -1", "force_n", 9),
        (
            "at: {xyz: [0.05, 0, 0.1]}",
            "jitter: {xy_m: 0.01}, at: {xyz: [0.05, 0, 0.1]}",
            "`battery` is joined to the fixture `base` and cannot be displaced",
            7,
        ),
        ("bonds:\n", "bonds:\n  # a comment\n", "", 0),
    ],
)
def test_what_cannot_be_joined_is_refused_at_its_place(
    tmp_path: Path, old: str, new: str, message: str, line: int
) -> None:
    """The last row changes nothing that matters: the texts are valid otherwise."""
    if not message:
        assert product(tmp_path, (old, new)).document.bonds
        return
    with pytest.raises(DocumentError, match=message) as refused:
        product(tmp_path, (old, new))
    assert f"product/module.yaml:{line}:" in str(refused.value)


def test_two_joined_parts_cannot_both_be_displaced(tmp_path: Path) -> None:
    moved = ("mass_kg: 0.02, at", "mass_kg: 0.02, jitter: {yaw_rad: 0.1}, at")
    with pytest.raises(DocumentError, match="`battery` and `board` are joined and are displaced as one"):
        product(tmp_path, moved, ("part: board, to: base", "part: board, to: battery"))


def test_groups_hold_what_is_joined_by_others_between() -> None:
    def bond(part: str, to: str) -> BondSpec:
        return BondSpec(kind="clip", part=part, to=to)

    bonds = {
        "a": bond("lid", "housing"),
        "b": bond("ball", "cup"),
        "c": bond("board", "housing"),
        "d": bond("x", "lid"),
    }
    assert set(joined_groups(bonds)) == {frozenset(("lid", "housing", "board", "x")), frozenset(("ball", "cup"))}
