"""Modules that are not plugged: their names are in the cell, nothing else; and what a document may say of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell.cell_names import cell_names
from engine.document.cell import Cell
from engine.document.docking import cell_as_docked, cell_at_start, docks_at_start, modules_below
from engine.errors import DocumentError
from tests.engine.document.test_cell_modules import CELL, MODULE, written

LATER = CELL.replace("connector: dock_b}", "connector: dock_b, plugged: false}").replace(
    "gauge: {parent: right/slot}", "gauge: {}"
)
NO_CAMERA = MODULE[: MODULE.index("cameras:")]


def plugged_later(folder: Path, cell: str = LATER) -> Cell:
    """Return the cell whose right bin is not plugged."""
    return written(folder, cell=cell, module=NO_CAMERA)


def test_a_module_that_is_not_plugged_has_names_but_is_not_in_the_cell(tmp_path: Path) -> None:
    cell = plugged_later(tmp_path)
    assert docks_at_start(cell) == {"left": "dock_a"}
    names = cell_names(cell).by_kind
    assert (names["module"], names["connector"]) == ({"left", "right"}, {"dock_a", "dock_b"})
    assert {"right/block", "left/block"} <= names["part"]
    assert {"right", "right/slot"} <= names["frame"]
    at_start = cell_at_start(cell)
    assert list(at_start.fixtures) == ["table", "left/tray"]
    assert list(at_start.parts) == ["left/block"]
    assert list(at_start.fixed_frames) == ["gauge", "dock_a", "dock_b", "left", "left/slot"]
    assert at_start.fixtures["left/tray"] == cell.document.fixtures["left/tray"]


def test_the_cell_as_docked_has_everything_where_its_module_is(tmp_path: Path) -> None:
    cell = plugged_later(tmp_path)
    swapped = cell_as_docked(cell, {"left": "dock_b", "right": "dock_a"})
    usual = cell_as_docked(cell, {"left": "dock_a", "right": "dock_b"})
    assert usual == cell.document
    for one, other in (("left", "right"), ("right", "left")):
        assert swapped.parts[f"{one}/block"].at == usual.parts[f"{other}/block"].at
        assert swapped.fixed_frames[f"{one}/slot"] == usual.fixed_frames[f"{other}/slot"]
    assert cell_as_docked(cell, {}).parts == {}


def test_frames_on_a_module_that_is_not_plugged_are_nowhere(tmp_path: Path) -> None:
    cell = CELL.replace("connectors:\n", "connectors:\n  on_right: {parent: right/tray}\n")
    nested = written(tmp_path, cell=cell, module=NO_CAMERA)
    assert modules_below(nested) == {"on_right": "right"}
    docked = cell_as_docked(nested, {"left": "dock_a"})
    assert {"gauge", "on_right"}.isdisjoint(docked.fixed_frames)
    assert docked.in_world() == docked


@pytest.mark.parametrize(
    ("cell", "module", "message", "line"),
    [
        (LATER.replace("connector: dock_a", ""), NO_CAMERA, "module `left` is docked to no connector", 12),
        (LATER, MODULE, "module `right` carries cameras, and such a module cannot be plugged while", 13),
        (
            LATER + "parts:\n  own: {shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 1, at: {frame: right/slot}}\n",
            NO_CAMERA,
            "`own` stands on module `right`, which is not plugged when the cell is opened",
            15,
        ),
        (
            LATER.replace("connectors:\n", "connectors:\n  dock_c: {parent: right/tray}\n").replace(
                "connector: dock_a", "connector: dock_c"
            ),
            NO_CAMERA,
            "`left` stands on module `right`, which is not plugged when the cell is opened",
            13,
        ),
        (LATER.replace("connector: dock_b", "connector: dock_c"), NO_CAMERA, "has no connector `dock_c`", 13),
    ],
    ids=["no connector", "cameras", "a part", "another module", "unknown connector"],
)
def test_what_cannot_be_is_said_at_its_line(tmp_path: Path, cell: str, module: str, message: str, line: int) -> None:
    with pytest.raises(DocumentError) as refused:
        written(tmp_path, cell=cell, module=module)
    assert message in refused.value.message
    assert f"cell.yaml:{line}:" in str(refused.value)


def test_two_modules_may_share_a_connector_that_only_one_has_at_the_start(tmp_path: Path) -> None:
    cell = plugged_later(tmp_path, LATER.replace("dock_b, plugged", "dock_a, plugged"))
    assert docks_at_start(cell) == {"left": "dock_a"}


def test_what_stands_on_a_module_is_known(tmp_path: Path) -> None:
    standing = CELL.replace(
        "  table:", "  post: {shape: box, size_m: [0.1, 0.1, 0.1], at: {frame: left/slot}}\n  table:"
    )
    assert written(tmp_path, cell=standing).carried == {"left": "fixture post"}
