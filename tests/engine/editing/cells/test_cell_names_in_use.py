"""Devices, equipment and bonds of a cell: what names them and what they name follows, and holds them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import pytest

from engine.document.text.yaml_source import parse_source
from engine.editing.cells.cell_draft import read_cell_draft
from engine.editing.cells.cell_edit import (
    AddCellItem,
    CellSection,
    RemoveCellItem,
    RenameCellField,
    RenameCellItem,
    SetCellField,
)
from tests.engine.editing.cells.cell_texts import edited, refusal
from tests.engine.editing.cells.device_texts import CELL, write_device_cell


def sections_of(text: str) -> dict[str, Any]:
    """The plain data of a document."""
    return cast("dict[str, Any]", parse_source(text, file="bench.yaml").data)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """The cell with its module and its pins on disk."""
    return write_device_cell(tmp_path)


@pytest.mark.parametrize(
    ("section", "name"),
    [
        ("equipment", "valves"),
        ("fixtures", "jaw"),
        ("fixtures", "stop"),
        ("parts", "lid"),
        ("modules", "press"),
        ("devices", "clamp"),
        ("bonds", "glue"),
    ],
)
def test_all_that_names_an_item_follows_its_new_name(section: CellSection, name: str, file: Path) -> None:
    after = edited(RenameCellItem(section=section, name=name, new_name="fresh"), text=CELL)
    assert read_cell_draft(after, file=file, kind="cell").findings == ()
    assert f" {name}:" not in after
    assert edited(RenameCellItem(section=section, name="fresh", new_name=name), text=after) == CELL


@pytest.mark.parametrize(
    ("section", "name", "by"),
    [
        ("equipment", "valves", "`clamp`"),
        ("fixtures", "jaw", "`clamp`"),
        ("fixtures", "stop", "`clamp`, `glue`"),
        ("modules", "press", "`clamp`"),
        ("parts", "lid", "`glue`"),
    ],
)
def test_an_item_that_a_device_or_bond_names_is_not_removed(section: CellSection, name: str, by: str) -> None:
    assert refusal(RemoveCellItem(section=section, name=name), text=CELL) == (
        f"`{name}` cannot be removed: it is named by {by}",
        "change or remove these first",
    )


def test_a_device_of_another_one_is_renamed_in_its_interlocks(file: Path) -> None:
    lock = {"position": "closed", "device": "gate", "at": "shut"}
    gate: dict[str, object] = {"positions": {"shut": {"steps": [{"set": {"valve": True}}], "time": "1 s"}}}
    text = edited(
        AddCellItem(section="devices", name="gate", value=gate),
        SetCellField(section="devices", name="clamp", field=("interlocks",), value=[lock]),
        text=CELL,
    )
    after = edited(RenameCellItem(section="devices", name="gate", new_name="door"), text=text)
    assert sections_of(after)["devices"]["clamp"]["interlocks"] == [{**lock, "device": "door"}]
    assert read_cell_draft(after, file=file, kind="cell").findings == ()


def test_names_on_the_bus_are_apart_from_names_in_the_world() -> None:
    """A device may have the name of its fixture; a bond any; equipment none of a device."""
    edited(RenameCellItem(section="devices", name="clamp", new_name="jaw"), text=CELL)
    edited(RenameCellItem(section="bonds", name="glue", new_name="jaw"), text=CELL)
    taken = refusal(RenameCellItem(section="equipment", name="valves", new_name="clamp"), text=CELL)
    assert taken == ("`clamp` is already a name in `devices`", "choose another name")


def test_one_number_of_an_axis_changes_alone_and_a_sensor_is_taken_away() -> None:
    after = edited(
        SetCellField(section="devices", name="clamp", field=("axes", "main", "force_n"), value=55), text=CELL
    )
    assert after == CELL.replace("force_n: 40", "force_n: 55")
    bare = edited(SetCellField(section="devices", name="clamp", field=("sensors", "shut"), value=None), text=CELL)
    assert "sensors" not in sections_of(bare)["devices"]["clamp"]


def test_a_draft_has_devices_equipment_and_bonds_with_their_surroundings(file: Path) -> None:
    draft = read_cell_draft(CELL, file=file, kind="cell")
    assert draft.findings == ()
    own = [(each.section, each.name) for each in draft.items if each.section in ("equipment", "devices", "bonds")]
    assert own == [("equipment", "valves"), ("devices", "clamp"), ("bonds", "glue")]
    assert draft.positions == {"clamp": ("closed",), "press/lift": ("top",)}
    assert draft.parts["lid"].xyz == (0.2, 0, 0.1551)


def test_what_is_wrong_in_a_device_is_found_at_it(file: Path) -> None:
    wrong = CELL.replace("body: jaw", "body: jow")
    (finding,) = read_cell_draft(wrong, file=file, kind="cell").findings
    assert (finding.path, finding.message) == ("devices/clamp", "there is no fixture `jow`")


@pytest.mark.parametrize("field", [("axes", "main"), ("sensors", "shut"), ("positions", "closed")])
def test_what_a_device_has_is_renamed_with_all_that_names_it(field: tuple[str, str], file: Path) -> None:
    waiting = [{"set": {"valve": True}}, {"wait_for": {"shut": True}}]
    gate: dict[str, object] = {
        "positions": {"open": {"steps": [{"set": {"valve": True}}], "time": "1 s"}},
        "interlocks": [{"position": "open", "device": "clamp", "at": "closed"}],
    }
    text = edited(
        SetCellField(section="devices", name="clamp", field=("positions", "closed", "steps"), value=waiting),
        AddCellItem(section="devices", name="gate", value=gate),
        text=CELL.replace("    equipment: valves\n", ""),  # its sensors would be pins, which keep their names
    )
    after = edited(RenameCellField(section="devices", name="clamp", field=field, new_name="fresh"), text=text)
    assert read_cell_draft(after, file=file, kind="cell").findings == ()
    back = RenameCellField(section="devices", name="clamp", field=(field[0], "fresh"), new_name=field[1])
    assert (after != text, edited(back, text=after)) == (True, text)


def test_what_a_device_has_not_is_not_renamed() -> None:
    missing = RenameCellField(section="devices", name="clamp", field=("axes", "other"), new_name="fresh")
    assert refusal(missing, text=CELL)[0] == "`clamp` has no `other` in `axes`"
