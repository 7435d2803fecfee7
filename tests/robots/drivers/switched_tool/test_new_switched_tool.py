"""What a cell document may say of a switched tool."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell.drivers import DeviceContext, assigned_drivers
from engine.clock import new_clock
from engine.document import load_cell
from engine.errors import CellError
from robots.drivers.switched_tool.switched_tool import SwitchedTool

CELL = """\
flexcell: 1
cell: bench
topics:
  line/part_sensor: {type: boolean}
equipment:
  valves: {driver: {kind: equipment, host: 127.0.0.1}}
robots:
  arm: {model: irb4600, driver: {kind: abb_irc5, host: 127.0.0.1}, gripper: {model: %s, driver: {%s}}}
"""


def new_tool(folder: Path, model: str, driver: str) -> SwitchedTool:
    """Return the tool of a cell."""
    (folder / "cell.yaml").write_text(CELL % (model, driver), encoding="utf-8")
    cell = load_cell(folder / "cell.yaml")
    (assigned,) = (each for each in assigned_drivers(cell) if each.device == "tool")
    found = assigned.driver()
    name = assigned.device_name(found)
    context = DeviceContext(cell=cell, robot="arm")
    tool = found.new_device(assigned.options(found), name=name, clock=new_clock(), context=context)
    assert isinstance(tool, SwitchedTool)
    return tool


@pytest.mark.parametrize(
    ("model", "driver", "name", "max_force_n"),
    [
        ("magnet", "kind: switched_magnet, sensor: {topic: line/part_sensor}", "arm/magnet", 210.0),
        ("robotiq_2f85", "kind: switched_gripper, assume_held: true", "arm/gripper", 235.0),
    ],
)
async def test_a_tool_has_the_range_and_force_of_its_model(
    tmp_path: Path, model: str, driver: str, name: str, max_force_n: float
) -> None:
    tool = new_tool(tmp_path, model, driver)
    assert (tool.name, tool.drive.tool.max_force_n) == (name, max_force_n)
    report = await tool.report(readings=1)
    assert (report.address, report.state) == (
        "arm, output 0",
        "not known: arm has no digital outputs, or is not open yet",
    )


@pytest.mark.parametrize(
    ("model", "driver", "reason"),
    [
        ("magnet", "kind: switched_magnet, device: other", "`device` is other, which the cell does not have"),
        ("magnet", "kind: switched_magnet, sensor: {topic: line/eye}", "the cell declares no topic line/eye"),
        ("magnet", "kind: switched_magnet, device: valves", "of valves are given by their names in its document"),
        ("magnet", "kind: switched_magnet, hold_output: coil", "of arm are given by their numbers"),
        ("magnet", "kind: switched_gripper", "the model of this tool is no gripper"),
        ("softhand", "kind: switched_magnet", "the model of this tool is no magnet"),
    ],
)
async def test_what_does_not_fit_the_cell_is_refused(tmp_path: Path, model: str, driver: str, reason: str) -> None:
    with pytest.raises(CellError, match=reason):
        new_tool(tmp_path, model, driver)


@pytest.mark.virtual
async def test_it_has_no_virtual_time(tmp_path: Path) -> None:
    with pytest.raises(CellError, match="no virtual time"):
        new_tool(tmp_path, "magnet", "kind: switched_magnet")
