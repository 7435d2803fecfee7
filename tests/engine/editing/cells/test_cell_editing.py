"""Edits of a cell document: only what an edit concerns changes in the text, and all of it."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Any, cast

import pytest

from engine.document.text.yaml_source import parse_source
from engine.editing.cells.cell_draft import SECTIONS
from engine.editing.cells.cell_edit import AddCellItem, CellSection, RemoveCellItem, RenameCellItem, SetCellField
from engine.editing.cells.cell_editing import apply_cell_edits
from tests.engine.editing.cells.cell_texts import CELL, edited, refusal

ROOT = Path(__file__).parents[4]
SHIPPED = sorted(
    file
    for folder in ("behaviors", "benchmarks", "docs", "tests/robots")
    for file in (ROOT / folder).rglob("*.yaml")
    if file.name == "module.yaml" or "\nrobots:" in file.read_text(encoding="utf-8")
)


def changed_lines(after: str, *, before: str = CELL) -> list[str]:
    """The lines that differ, as `-old` and `+new`."""
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=0)
    return [line for line in lines if line[:1] in "+-" and line[:3] not in ("+++", "---")]


def sections_of(text: str) -> dict[str, Any]:
    """The plain data of a document."""
    return cast("dict[str, Any]", parse_source(text, file="bench.yaml").data)


def set_field(section: CellSection, name: str, *field: str, value: object) -> SetCellField:
    return SetCellField(section=section, name=name, field=field, value=value)


def test_there_are_shipped_cells() -> None:
    assert len(SHIPPED) >= 8


@pytest.mark.parametrize("file", SHIPPED, ids=lambda file: str(file.relative_to(ROOT)))
def test_edits_that_change_nothing_change_no_byte_of_a_shipped_document(file: Path) -> None:
    """Every field of every item is set to what it is, and an item is added and removed."""
    text = file.read_bytes().decode()
    data = sections_of(text)
    same = [
        SetCellField(section=section, name=name, field=(field,), value=value)
        for section in SECTIONS["cell"]
        for name, item in cast("dict[str, dict[str, object]]", data.get(section) or {}).items()
        for field, value in item.items()
    ]
    box: dict[str, object] = {"shape": "box", "size_m": [1, 1, 1]}
    added = AddCellItem(section="fixtures", name="a_new_box", value=box)
    removed = RemoveCellItem(section="fixtures", name="a_new_box")
    assert edited(*same, text=text) == text
    if data.get("fixtures"):
        assert edited(added, removed, text=text) == text


def test_a_number_changes_alone() -> None:
    after = edited(set_field("fixtures", "table", "size_m", value=[1, 0.8, 0.75]))
    assert changed_lines(after) == [
        "-    size_m: [1.0, 0.80, 0.7]   # measured",
        "+    size_m: [1.0, 0.80, 0.75]   # measured",
    ]


def test_a_whole_number_stays_a_float_where_a_float_was() -> None:
    after = edited(set_field("parts", "plate", "mass_kg", value=2))
    assert changed_lines(after) == ["-    mass_kg: 0.5", "+    mass_kg: 2.0"]


def test_a_field_that_is_not_written_is_added_and_null_removes_it() -> None:
    placed = edited(set_field("fixtures", "table", "at", "rpy", value=[0, 0, 1.5]))
    assert changed_lines(placed) == ["+      rpy: [0, 0, 1.5]"]
    back = edited(set_field("fixtures", "table", "at", "rpy", value=None), text=placed)
    assert back == CELL


def test_a_pose_without_numbers_is_not_written() -> None:
    after = edited(
        set_field("frames", "slot", "at", "rpy", value=None), set_field("frames", "slot", "at", "xyz", value=None)
    )
    assert changed_lines(after)[1] == "+  slot: {parent: table}"


def test_a_new_item_stands_at_the_end_of_its_section() -> None:
    value: dict[str, object] = {
        "shape": "box",
        "size_m": [0.1, 0.2, 0.3],
        "at": {"xyz": [0, 0, 0.15], "frame": "table"},
    }
    after = edited(AddCellItem(section="fixtures", name="block", value=value))
    assert changed_lines(after) == [
        "+  block: {shape: box, size_m: [0.1, 0.2, 0.3], at: {xyz: [0, 0, 0.15], frame: table}}"
    ]
    assert list(sections_of(after)["fixtures"]) == ["floor", "table", "block"]


def test_a_missing_section_is_written_in_its_place() -> None:
    text = "flexcell: 1\ncell: bare\n\nrobots: {}   # none yet\n\nframes:\n  a: {}\n"
    after = edited(AddCellItem(section="fixtures", name="box", value={"shape": "box"}), text=text)
    assert list(sections_of(after)) == ["flexcell", "cell", "robots", "fixtures", "frames"]
    assert "robots: {}   # none yet\n" in after


def test_each_item_of_a_new_section_has_a_line() -> None:
    arm: dict[str, object] = {"model": "panda", "base": {"xyz": [0, 0, 0]}}
    before = "flexcell: 1\ncell: bare\nworld: {kind: mujoco}\n"
    text = edited(AddCellItem(section="robots", name="left", value=arm), text=before)
    text = edited(AddCellItem(section="robots", name="right", value=arm), text=text)
    text = edited(AddCellItem(section="frames", name="slot", value={"at": {"xyz": [0, 0, 0]}}), text=text)
    assert text == before + (
        "robots:\n"
        "  left: {model: panda, base: {xyz: [0, 0, 0]}}\n"
        "  right: {model: panda, base: {xyz: [0, 0, 0]}}\n"
        "frames:\n"
        "  slot: {at: {xyz: [0, 0, 0]}}\n"
    )


def test_a_robot_gets_a_tool_and_loses_it() -> None:
    text = "flexcell: 1\ncell: bare\nrobots:\n  arm: {model: panda}   # in front\n"
    with_hand = edited(set_field("robots", "arm", "gripper", "model", value="panda_hand"), text=text)
    assert "  arm: {model: panda, gripper: {model: panda_hand}}   # in front\n" in with_hand
    assert edited(set_field("robots", "arm", "gripper", "model", value=None), text=with_hand) == text


def test_the_last_item_leaves_an_empty_section_with_its_comment() -> None:
    text = "flexcell: 1\ncell: bare\nframes:   # of the hall\n  a: {}\n"
    after = edited(RemoveCellItem(section="frames", name="a"), text=text)
    assert after == "flexcell: 1\ncell: bare\nframes: {}   # of the hall\n"


def test_a_renamed_fixture_is_renamed_wherever_something_stands_in_it() -> None:
    after = edited(RenameCellItem(section="fixtures", name="table", new_name="bench_top"))
    assert changed_lines(after) == [
        "-  dock: {parent: table, at: {xyz: [0.50, 0, 0.1]}}   # left edge",
        "+  dock: {parent: bench_top, at: {xyz: [0.50, 0, 0.1]}}   # left edge",
        "-  table:",
        "+  bench_top:",
        "-  slot: {parent: table, at: {xyz: [0.1, 0, 0.35], rpy: [0, 0, 1.5708]}}",
        "+  slot: {parent: bench_top, at: {xyz: [0.1, 0, 0.35], rpy: [0, 0, 1.5708]}}",
    ]
    assert edited(RenameCellItem(section="fixtures", name="bench_top", new_name="table"), text=after) == CELL


def test_renaming_follows_frames_of_cameras_labels_connectors_and_what_stands_on_modules() -> None:
    after = edited(
        RenameCellItem(section="frames", name="slot", new_name="nest"),
        RenameCellItem(section="parts", name="plate", new_name="sheet"),
        RenameCellItem(section="connectors", name="dock", new_name="port"),
        RenameCellItem(section="modules", name="bin", new_name="box"),
    )
    assert "    at: {xyz: [0, 0, 0.005], frame: nest}" in after
    assert "detect: {labels: {sheet: steel plate, box/screw: screw}, frame: nest}" in after
    assert "  box: {module: bin, connector: port}" in after


def test_renaming_follows_what_is_joined_and_what_is_joined_is_not_removed() -> None:
    text = CELL + "bonds: {pad: {kind: glue, part: plate, to: table}, tab: {kind: clip, part: bin/screw, to: plate}}\n"
    after = edited(
        RenameCellItem(section="parts", name="plate", new_name="sheet"),
        RenameCellItem(section="fixtures", name="table", new_name="bench_top"),
        RenameCellItem(section="modules", name="bin", new_name="box"),
        text=text,
    )
    bonds = "{pad: {kind: glue, part: sheet, to: bench_top}, tab: {kind: clip, part: box/screw, to: sheet}}"
    assert after.endswith(f"bonds: {bonds}\n")
    said = apply_cell_edits(text, [RemoveCellItem(section="parts", name="plate")], file="cell.yaml")[1]
    assert said is not None
    assert "it is named by `above`, `pad`, `tab`" in said.message


def test_an_item_that_is_named_elsewhere_is_not_removed() -> None:
    said = refusal(RemoveCellItem(section="fixtures", name="table"))
    assert said == ("`table` cannot be removed: it is named by `dock`, `slot`", "change or remove these first")
    assert refusal(RemoveCellItem(section="connectors", name="dock"))[0].endswith("it is named by `bin`")
    assert refusal(RemoveCellItem(section="parts", name="plate"))[0].endswith("it is named by `above`")
    without = edited(RemoveCellItem(section="cameras", name="above"), RemoveCellItem(section="parts", name="plate"))
    assert "plate" not in without


@pytest.mark.parametrize("taken", ["floor", "slot", "dock", "bin", "plate", "above", "world"])
def test_a_name_is_given_once(taken: str) -> None:
    message, hint = refusal(AddCellItem(section="frames", name=taken, value={}))
    assert taken in message
    assert hint == "choose another name"
    if taken != "slot":
        refusal(RenameCellItem(section="frames", name="slot", new_name=taken))


def test_all_edits_are_made_or_none() -> None:
    first = set_field("parts", "plate", "mass_kg", value=2)
    message, hint = refusal(first, RemoveCellItem(section="parts", name="plat"))
    assert message == "`parts` has no `plat`"
    assert "plate" in hint


def test_text_that_is_no_document_is_refused_and_not_changed() -> None:
    for text in ("- a\n- b\n", "a: [", "parts: 3\n", "parts: {plate: 3}\n", ""):
        refusal(set_field("parts", "plate", "mass_kg", value=2), text=text)
    refusal(AddCellItem(section="parts", name="plate", value={}), text="parts: 3\n")
