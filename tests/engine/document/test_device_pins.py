"""Devices on equipment: its pins must have their names, and a module does not know equipment."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import Cell, load_cell
from engine.errors import DocumentError
from tests.engine.document.test_cell_devices import CELL, MODULE

PINS = """\
flexcell: 1
equipment: pneumatics
backend: {kind: simulated}
pins:
  close: {kind: digital_output, pin: 1, safe: false}
  shut: {kind: digital_input, pin: 2}
  air: {kind: digital_input, pin: 3}
"""
ON_VALVES = (
    CELL.replace("connector: dock}", "connector: dock, equipment: valves}") + "equipment: {valves: {pins: pins.yaml}}\n"
)


def read(folder: Path, *, cell: str = ON_VALVES, module: str = MODULE, pins: str = PINS) -> Cell:
    """Read a cell with a vice on equipment."""
    (folder / "vice").mkdir(exist_ok=True)
    (folder / "vice" / "module.yaml").write_text(module, encoding="utf-8")
    (folder / "pins.yaml").write_text(pins, encoding="utf-8")
    (folder / "cell.yaml").write_text(cell, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def test_the_cell_gives_a_module_its_equipment(tmp_path: Path) -> None:
    assert read(tmp_path).document.devices["vice/jaws"].equipment == "valves"
    assert read(tmp_path, cell=CELL).document.devices["vice/jaws"].equipment is None


@pytest.mark.parametrize(
    ("pins", "message"),
    [
        (PINS.replace("  close:", "  open:"), "`vice/jaws` sets the output `close`, which pins.yaml does not have"),
        (PINS.replace("  shut:", "  closed:"), "`vice/jaws` has the sensor `shut`, which pins.yaml does not have"),
        (
            PINS.replace("shut: {kind: digital_input, pin: 2}", "shut: {kind: digital_output, pin: 2, safe: false}"),
            "`vice/jaws` has the sensor `shut`, which pins.yaml does not have",
        ),
    ],
)
def test_a_pin_that_is_missing_is_named(tmp_path: Path, pins: str, message: str) -> None:
    with pytest.raises(DocumentError, match=message) as refused:
        read(tmp_path, pins=pins)
    assert str(refused.value.where).endswith("cell.yaml:5:60")
    assert "did you mean one of its" in str(refused.value.hint)


def test_equipment_that_the_cell_does_not_have_is_named(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="the cell has no equipment `valve`") as refused:
        read(tmp_path, cell=ON_VALVES.replace("equipment: valves}", "equipment: valve}"))
    assert "valves" in str(refused.value.hint)


def test_pins_that_only_the_server_knows_are_not_checked(tmp_path: Path) -> None:
    server = ON_VALVES.replace("{pins: pins.yaml}", "{driver: {kind: equipment, host: h, port: 1}}")
    assert read(tmp_path, cell=server).document.devices["vice/jaws"].equipment == "valves"


def test_a_module_does_not_know_equipment(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="device `jaws` names equipment, which a module does not know") as refused:
        read(tmp_path, module=MODULE.replace("  jaws:\n", "  jaws:\n    equipment: valves\n"))
    assert str(refused.value.where).endswith("module.yaml:8:16")


def test_a_device_that_nothing_moves_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="nothing moves the device `vice/jaws`") as refused:
        read(tmp_path, cell=CELL.replace("world: {kind: mujoco}\n", ""))
    assert "`equipment:`" in str(refused.value.hint)
    assert read(tmp_path, cell=ON_VALVES.replace("world: {kind: mujoco}\n", "")).document.world is None
