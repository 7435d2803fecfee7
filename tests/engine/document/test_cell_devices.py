"""Devices as data: names that lead nowhere are refused at their place; modules bring theirs with names in the cell."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document.cell import Cell, load_cell
from engine.document.cell_devices import DeviceSensor
from engine.errors import DocumentError

MODULE = """\
flexcell: 1
module: vice
fixtures:
  body: {shape: box, size_m: [0.2, 0.2, 0.1]}
  jaw: {shape: box, size_m: [0.02, 0.08, 0.04], at: {xyz: [0, 0, 0.1]}}
devices:
  jaws:
    axes:
      main: {body: jaw, joint: slide, along: [1, 0, 0], stroke_m: 0.05, force_n: 6, speed_m_s: 1, against: [body], output: close}
    sensors:
      shut: {axis: main, at_least: 0.02, at_most: 0.04}
      air: {air: true}
    positions:
      open: {steps: [{set: {close: false}}], time: 1}
      closed: {steps: [{set: {close: true}}, {wait_for: {shut: true}}], sensors: {shut: true}, time: 1}
    interlocks:
      - {position: closed, device: jaws, at: open}
"""  # noqa: E501
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
connectors: {dock: {}}
modules: {vice: {module: vice, connector: dock}}
"""


def vice(folder: Path, *changes: tuple[str, str], cell: str = CELL) -> Cell:
    """Return the cell with a vice whose text is changed."""
    text = MODULE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "vice").mkdir()
    (folder / "vice" / "module.yaml").write_text(text, encoding="utf-8")
    (folder / "cell.yaml").write_text(cell, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


def test_what_a_device_names_has_its_name_in_the_cell(tmp_path: Path) -> None:
    device = vice(tmp_path).document.devices["vice/jaws"]
    axis = device.axes["main"]
    assert (axis.body, axis.against, device.interlocks[0].device) == ("vice/jaw", ("vice/body",), "vice/jaws")
    assert (device.outputs, device.air_sensor) == (("close",), "air")


@pytest.mark.parametrize(
    ("old", "new", "message", "line"),
    [
        ("body: jaw", "body: jow", "there is no fixture `jow`", 9),
        ("against: [body]", "against: [bodi]", "there is no fixture `bodi`", 9),
        ("along: [1, 0, 0]", "along: [0, 0, 0]", "this direction has no length", 9),
        ("joint: slide, ", "", "`joint`", 9),
        ("force_n: 6", "torque_nm: 6", "torque_nm", 9),
        ("output: close", "output: clse", "no step sets the output `clse`", 9),
        ("{axis: main, at_least", "{axis: mein, at_least", "there is no axis `mein`", 11),
        ("at_least: 0.02", "at_least: 0.05", "sensor `shut` is never on", 11),
        ("{air: true}", "{}", "sensor `air` has either an `axis`, a `beam` or `air: true`", 12),
        ("wait_for: {shut", "wait_for: {shot", "there is no sensor `shot`", 15),
        ("sensors: {shut: true}", "sensors: {shot: true}", "there is no sensor `shot`", 15),
        ("[{set: {close: false}}]", "[{set: {close: false}, pause: 1}]", "a step has one of", 14),
        ("position: closed, device", "position: close, device", "`jaws` has no position `close`", 17),
        ("device: jaws, at", "device: jows, at", "there is no device `jows`", 17),
        ("at: open", "at: opened", "`jaws` has no position `opened`", 17),
        ("fixtures:\n", "fixtures:\n  # a comment\n", "", 0),
    ],
)
def test_a_name_that_leads_nowhere_is_refused_at_its_place(
    tmp_path: Path, old: str, new: str, message: str, line: int
) -> None:
    """The last row changes nothing that matters: the texts are valid otherwise."""
    if not message:
        assert vice(tmp_path, (old, new)).document.devices
        return
    with pytest.raises(DocumentError, match=message) as refused:
        vice(tmp_path, (old, new))
    assert f"vice/module.yaml:{line}:" in str(refused.value)


def test_a_fixture_is_moved_by_one_axis_only(tmp_path: Path) -> None:
    axis = "{body: jaw, joint: slide, along: [1, 0, 0], stroke_m: 0.05, force_n: 6, speed_m_s: 0.05, output: close}"
    second = f"      other: {axis}\n    sensors:"
    with pytest.raises(DocumentError, match="`jaw` is moved by `main` of `jaws` too"):
        vice(tmp_path, ("    sensors:", second))


def test_a_device_is_not_named_as_a_robot_is(tmp_path: Path) -> None:
    lamp = "devices: {arm: {positions: {lit: {steps: [{set: {on: true}}], time: 0}}}}\nrobots: {arm: {model: panda}}\n"
    with pytest.raises(DocumentError, match="`arm` is both a device and a robot"):
        vice(tmp_path, cell=CELL + lamp)


@pytest.mark.parametrize(("place", "on"), [(0.0, False), (0.1, True), (0.2, True), (0.3, False)])
def test_a_sensor_is_on_between_its_limits(place: float, on: bool) -> None:
    assert DeviceSensor(axis="x", at_least=0.1, at_most=0.2).is_on(place) is on
