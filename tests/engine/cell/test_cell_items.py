"""The items of a cell: what there is, which topics tell of it, and its lines of the document."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell import CellItem, items_of_cell
from engine.document.cell import Cell, load_cell

CELL = """\
flexcell: 1
cell: bench
description: A bench.
world: {kind: mujoco}

robots:
  left:
    model: panda
    gripper: {model: panda_hand}   # fingers of rubber
  # The next one comes with the new table.

  right: {model: ur10, base: {xyz: [1, 0, 0]}}
fixtures: {table: {shape: box, size_m: [1, 1, 0.02]}}

# What is moved.
parts:
  plate:
    shape: box
    size_m: [0.1, 0.1, 0.01]
    # weighed
    mass_kg: 0.1
cameras:
  eye: {at: [0, 0, 1], look_at: [0, 0, 0]}
frames: {slot: {parent: table}}
"""
TOPICS = ("cell/parts", "cell/frames", "eye/depth", "left/gripper/state", "left/status", "left2/status", "right/status")


@pytest.fixture
def cell(tmp_path: Path) -> Cell:
    """A cell of a few items, as it was opened."""
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    return load_cell(tmp_path / "cell.yaml")


def items(cell: Cell) -> dict[str, CellItem]:
    """Return them by address."""
    return {item.path: item for item in items_of_cell(cell, name="bench", topics=TOPICS).items}


def test_every_item_is_there_in_the_order_of_the_kinds(cell: Cell) -> None:
    whole = items_of_cell(cell, name="bench")
    assert (whole.cell, whole.description, whole.file, whole.changed) == ("bench", "A bench.", "cell.yaml", False)
    assert [(item.path, item.kind, item.model, item.owner) for item in whole.items] == [
        ("robots/left", "robot", "panda", ""),
        ("robots/left/gripper", "tool", "panda_hand", "robots/left"),
        ("robots/right", "robot", "ur10", ""),
        ("fixtures/table", "fixture", "box", ""),
        ("parts/plate", "part", "box", ""),
        ("frames/slot", "frame", "in table", ""),
        ("cameras/eye", "camera", "sim", ""),
        ("world", "world", "mujoco", ""),
    ]


def test_topics_belong_to_the_item_whose_name_they_have(cell: Cell) -> None:
    """Those of a tool to the tool, and not to its arm as well."""
    assert {path: item.topics for path, item in items(cell).items() if item.topics} == {
        "robots/left": ("left/status",),
        "robots/left/gripper": ("left/gripper/state",),
        "robots/right": ("right/status",),
        "parts/plate": ("cell/parts",),
        "cameras/eye": ("eye/depth",),
        "world": ("cell/frames",),
    }


def test_a_tool_changer_is_the_tool_of_its_arm(tmp_path: Path) -> None:
    text = CELL.replace("gripper: {model: panda_hand}", "tool_changer: {mass_kg: 0.4}")
    (tmp_path / "cell.yaml").write_text(text, encoding="utf-8")
    topics = ("left/status", "left/tool_changer")
    found = {one.path: one for one in items_of_cell(load_cell(tmp_path / "cell.yaml"), name="b", topics=topics).items}
    item = found["robots/left/tool_changer"]
    assert (item.kind, item.name, item.owner) == ("tool", "left", "robots/left")
    assert (item.topics, found["robots/left"].topics) == (("left/tool_changer",), ("left/status",))
    assert (item.text, item.line) == ("tool_changer: {mass_kg: 0.4}   # fingers of rubber", 9)


@pytest.mark.parametrize(
    ("path", "line", "text"),
    [
        ("robots/left", 7, "left:\n  model: panda\n  gripper: {model: panda_hand}   # fingers of rubber"),
        ("robots/left/gripper", 9, "gripper: {model: panda_hand}   # fingers of rubber"),
        ("robots/right", 12, "right: {model: ur10, base: {xyz: [1, 0, 0]}}"),
        ("fixtures/table", 13, "fixtures: {table: {shape: box, size_m: [1, 1, 0.02]}}"),
        ("parts/plate", 17, "plate:\n  shape: box\n  size_m: [0.1, 0.1, 0.01]\n  # weighed\n  mass_kg: 0.1"),
        ("cameras/eye", 23, "eye: {at: [0, 0, 1], look_at: [0, 0, 0]}"),
        ("world", 4, "world: {kind: mujoco}"),
    ],
)
def test_an_item_has_its_lines_and_no_comment_of_the_next(cell: Cell, path: str, line: int, text: str) -> None:
    assert (items(cell)[path].line, items(cell)[path].text) == (line, text)


def test_the_lines_are_those_of_the_document_now(cell: Cell) -> None:
    """The items are still those of the open cell."""
    cell.file.write_text(CELL.replace("parts:", "# More:\nparts:").replace("  plate:", "  disk:"), encoding="utf-8")
    whole = items_of_cell(cell, name="bench")
    changed = {item.path: item for item in whole.items}
    assert whole.changed
    assert (changed["parts/plate"].text, changed["parts/plate"].line) == ("", 0)
    assert changed["cameras/eye"].line == 24


@pytest.mark.parametrize("content", [b"robots: [", b"\xff\xfe", None])
def test_a_document_that_cannot_be_read_takes_no_item_away(cell: Cell, content: bytes | None) -> None:
    """Somebody is editing it, or has moved it."""
    before = list(items(cell))
    if content is None:
        cell.file.unlink()
    else:
        cell.file.write_bytes(content)
    whole = items_of_cell(cell, name="bench")
    assert whole.changed
    assert ([item.path for item in whole.items], {item.text for item in whole.items}) == (before, {""})


def test_a_cell_without_a_document_has_no_items() -> None:
    whole = items_of_cell(None, name="bench", topics=TOPICS)
    assert (whole.cell, whole.file, whole.items) == ("bench", "", ())


def test_a_json_document_has_its_items(tmp_path: Path) -> None:
    (tmp_path / "cell.json").write_text(
        '{"flexcell": 1, "cell": "bench",\n "parts": {\n  "ball": {"shape": "sphere",\n   "size_m": [0.1],\n'
        '   "mass_kg": 1}}}',
        encoding="utf-8",
    )
    (item,) = items_of_cell(load_cell(tmp_path / "cell.json"), name="bench").items
    assert (item.path, item.line) == ("parts/ball", 3)
    assert item.text.startswith('"ball": {"shape": "sphere",')


MODULE = """\
flexcell: 1
module: rack
frames: {slot: {parent: shelf}}
fixtures:
  # Of wood.
  shelf: {shape: box, size_m: [0.3, 0.2, 0.1]}
parts: {block: {shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 0.1, at: {frame: slot}}}
"""
DOCKED = """\
connectors:
  dock: {parent: table}
modules:
  store: {module: racks/rack/, connector: dock}
"""


def test_what_stands_on_a_module_belongs_to_it_and_has_the_lines_of_its_document(tmp_path: Path) -> None:
    folder = tmp_path / "racks" / "rack"
    folder.mkdir(parents=True)
    (folder / "module.yaml").write_text(MODULE, encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(CELL + DOCKED, encoding="utf-8")
    cell = load_cell(tmp_path / "cell.yaml")
    found = items(cell)
    assert [(path, item.kind, item.model) for path, item in found.items() if item.owner == "modules/store"] == [
        ("fixtures/store/shelf", "fixture", "box"),
        ("parts/store/block", "part", "box"),
        ("frames/store/slot", "frame", "in store/shelf"),
    ]
    shelf, module, dock = (found[path] for path in ("fixtures/store/shelf", "modules/store", "connectors/dock"))
    assert (shelf.text, shelf.line, shelf.file) == (
        "shelf: {shape: box, size_m: [0.3, 0.2, 0.1]}",
        6,
        "racks/rack/module.yaml",
    )
    assert (module.kind, module.model, module.file) == ("module", "rack", "")
    assert module.text == "store: {module: racks/rack/, connector: dock}"
    assert dock.text == "dock: {parent: table}"
    assert not items_of_cell(cell, name="bench").changed
    (folder / "module.yaml").write_text(MODULE.replace("0.3", "0.4"), encoding="utf-8")
    assert items_of_cell(cell, name="bench").changed


def test_a_cell_with_equipment_is_unchanged_until_its_pins_are(tmp_path: Path) -> None:
    pins = "flexcell: 1\nequipment: clamps\nbackend: {kind: simulated}\npins: {valve: {kind: digital_input, pin: 1}}\n"
    (tmp_path / "clamps.yaml").write_text(pins, encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(CELL + "equipment: {valves: {pins: clamps.yaml}}\n", encoding="utf-8")
    cell = load_cell(tmp_path / "cell.yaml")
    assert not items_of_cell(cell, name="bench").changed
    (tmp_path / "clamps.yaml").write_text(pins.replace("pin: 1", "pin: 2"), encoding="utf-8")
    assert items_of_cell(cell, name="bench").changed


def test_a_module_that_is_named_by_its_file_is_called_as_its_document_says(tmp_path: Path) -> None:
    (tmp_path / "racks").mkdir()
    (tmp_path / "racks" / "small.yaml").write_text(MODULE, encoding="utf-8")
    (tmp_path / "cell.yaml").write_text(CELL + DOCKED.replace("racks/rack/", "racks/small.yaml"), encoding="utf-8")
    found = items(load_cell(tmp_path / "cell.yaml"))
    assert found["modules/store"].model == "rack"
    assert found["parts/store/block"].file == "racks/small.yaml"
