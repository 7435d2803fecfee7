"""A switched tool at the pins of equipment, whose server is a real one."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Mapping
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, cast

import msgspec
import pytest

from engine.bus import SkillBus
from engine.cell.drivers import DeviceReport, installed_driver
from engine.errors import RobotError
from engine.robot import Robot
from engine.skills.gripper import GripperOpen
from robots.drivers.switched_tool.switched_tool import SwitchedTool
from robots.sim.grip.tool_summary import ToolSummary
from robots.switched.switched_kind import SwitchedKind
from robots.switched.switched_options import SwitchedToolOptions
from robots.tool_kinds import load_switched
from tests.robots.drivers.equipment.device.equipment_cell import VICE, opened, outputs, switched, written
from tests.robots.drivers.equipment.device.test_equipment_device import server_of
from tests.robots.drivers.switched_tool.test_switched_tool import GRASP

GRIPPER = "arm/gripper"


@asynccontextmanager
async def gripper_at(bus: SkillBus, devices: Mapping[str, Robot], **options: Any) -> AsyncGenerator[SwitchedTool]:
    """Serve a gripper that pins of the vice switch."""
    driver = installed_driver("switched_gripper")
    tool = SwitchedTool(
        GRIPPER,
        cast("SwitchedToolOptions", msgspec.convert({"kind": driver.kind, "device": VICE, **options}, driver.options)),
        kind=cast("SwitchedKind", load_switched("gripper")),
        tool=ToolSummary(kind="gripper", contacts=2, max_width_m=0.085, max_force_n=200.0),
        owner=VICE,
        devices=devices,
        about=DeviceReport(device=GRIPPER, driver=driver.kind, address=f"{VICE}, output clamp"),
    )
    async with tool:
        tool.register(bus)
        yield tool


async def test_pins_are_switched_by_their_names_once_tool_and_equipment_are_enabled(tmp_path: Path) -> None:
    wires = {"hold_output": "valve", "release_output": "clamp", "hold_s": 0.05, "sensor": {"input": "there"}}
    async with (
        server_of(tmp_path) as server,
        opened(written(tmp_path, port=server.port)) as cell,
        gripper_at(cell.bus, cell.equipment, **wires) as tool,
    ):
        await tool.enable("a test")
        refused = await cell.bus.send_goal(GRASP, to=GRIPPER).result()
        assert refused.cause is not None
        assert "not enabled" in refused.cause.chain()[-1].message
        await cell.enable("a test")
        end = await cell.bus.send_goal(GRASP, to=GRIPPER).result()
        assert (end.status.value, outputs(cell.bus)) == ("succeeded", {"clamp": False, "valve": True})
        assert end.result is not None
        assert (end.result.held, end.result.by) == (False, "sensor")
        await cell.bus.send_goal(GripperOpen(), to=GRIPPER).result()
        assert outputs(cell.bus) == {"clamp": True, "valve": False}
        await switched(cell.bus, "valve", on=True)
        assert tool.drive.reading().holds


@pytest.mark.parametrize(
    ("wires", "reason"),
    [
        ({"hold_output": "coil"}, "vice: there is no output coil .*clamp, valve"),
        ({"hold_output": "valve", "sensor": {"input": "part"}}, "vice has no input part"),
    ],
)
async def test_a_name_that_the_equipment_does_not_have_permits_nothing(
    tmp_path: Path, wires: dict[str, Any], reason: str
) -> None:
    async with (
        opened(written(tmp_path, port=1), simulate=(VICE,)) as cell,
        gripper_at(cell.bus, cell.equipment, **wires) as tool,
    ):
        with pytest.raises(RobotError, match=reason):
            await tool.enable("a test")
