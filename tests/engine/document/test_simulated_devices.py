"""Devices of a cell are simulated by one word: all of them or some, and the document stays as it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document import Cell, load_cell
from engine.document.simulated_devices import with_simulated_devices
from engine.errors import DocumentError

GRIPPER = "{kind: robotiq, connection: {kind: modbus_tcp, host: 192.168.1.11}}"
TEXT = f"""\
flexcell: 1
cell: bench
world: {{kind: mujoco}}
robots:
  left: {{model: ur10, driver: {{kind: vendor_arm}}, gripper: {{model: robotiq_2f85, driver: {GRIPPER}}}}}
  right: {{model: ur10, gripper: {{model: robotiq_2f85, driver: {GRIPPER}}}}}
  third: {{model: panda}}
"""


def cell_of(folder: Path, text: str = TEXT) -> Cell:
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


PINS = """\
flexcell: 1
equipment: clamps
backend: {kind: simulated}
pins: {clamp: {kind: digital_output, pin: 17, safe: true}}
"""
WITH_EQUIPMENT = """\
flexcell: 1
cell: bench
equipment:
  vice: {driver: {kind: equipment, host: 10.0.0.2}, pins: clamps.yaml}
  press: {driver: {kind: equipment, host: 10.0.0.3}}
  feeder: {pins: clamps.yaml}
"""


def test_equipment_is_simulated_by_the_document_of_its_pins_and_needs_no_world(tmp_path: Path) -> None:
    (tmp_path / "clamps.yaml").write_text(PINS, encoding="utf-8")
    cell = cell_of(tmp_path, WITH_EQUIPMENT)
    assert tuple(cell.document.real_devices) == ("vice", "press")
    simulated = with_simulated_devices(cell, ("vice",))
    assert (tuple(simulated.simulated), tuple(simulated.document.real_devices)) == (("vice",), ("press",))
    with pytest.raises(DocumentError, match="equipment `press` cannot be simulated: nothing names its pins") as refused:
        with_simulated_devices(cell, ("all",))
    assert str(refused.value.where).endswith("cell.yaml:5:3")


@pytest.mark.parametrize(
    ("names", "simulated", "driven"),
    [
        ((), (), ("left", "left/gripper", "right/gripper")),
        (("left",), ("left", "left/gripper"), ("right/gripper",)),
        (("left/gripper",), ("left/gripper",), ("left", "right/gripper")),
        (("right", "third"), ("right/gripper",), ("left", "left/gripper")),
        (("all",), ("left", "left/gripper", "right/gripper"), ()),
    ],
)
def test_named_devices_are_simulated_and_the_others_stay_driven(
    tmp_path: Path, names: tuple[str, ...], simulated: tuple[str, ...], driven: tuple[str, ...]
) -> None:
    cell = with_simulated_devices(cell_of(tmp_path), names)
    assert tuple(cell.simulated) == simulated
    assert tuple(cell.document.real_devices) == driven
    assert (tmp_path / "cell.yaml").read_text("utf-8") == TEXT


def test_what_was_simulated_before_stays_so(tmp_path: Path) -> None:
    cell = with_simulated_devices(with_simulated_devices(cell_of(tmp_path), ("right",)), ("left",))
    assert set(cell.simulated) == {"left", "left/gripper", "right/gripper"}
    assert cell.document.real_devices == {}


def test_an_unknown_device_is_refused_with_what_was_meant(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="bench has no device `lift` to simulate") as refused:
        with_simulated_devices(cell_of(tmp_path), ("lift",))
    assert "left" in (refused.value.hint or "")


def test_a_cell_without_a_world_simulates_nothing(tmp_path: Path) -> None:
    text = "flexcell: 1\ncell: bench\nrobots:\n  left: {model: ur10, driver: {kind: vendor_arm}}\n"
    with pytest.raises(DocumentError, match="no world"):
        with_simulated_devices(cell_of(tmp_path, text), ("all",))
