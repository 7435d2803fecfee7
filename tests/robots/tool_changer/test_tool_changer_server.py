"""A tool changer on the bus of an open cell: what the arm has with a tool, and how each failure is told."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document import Placement
from engine.document.cell import load_cell
from engine.messages import RobotDescription
from engine.skills.arm_control import ArmStatus, ReadArm
from engine.skills.device_moves import DeviceFault, SimulateDeviceFault
from engine.skills.motion import JointTrapVel
from engine.skills.planning_scene import ReadPlanningScene
from engine.skills.simulated_world import PushBody
from engine.skills.tool_changer import (
    DescribeTool,
    LockTool,
    LockToolResult,
    ReadToolChanger,
    ReleaseTool,
    ReleaseToolResult,
    ToolChangerState,
)
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import model_by_name, model_of_entry
from robots.model.transform import RigidTransform

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco, gravity: false, realism: ideal}
robots:
  arm: {model: panda, tool_changer: {thickness_m: 0.05, self_holding: false}}
parts:
  probe:
    shape: cylinder
    size_m: [0.06, 0.02]
    mass_kg: 0.3
    at: PLACE
    tool:
      tcps: {tip: {xyz: [0, 0, 0.09]}, side: {xyz: [0.02, 0, 0.05], rpy: [0, 1.5708, 0]}}
      shapes: [{shape: box, size_m: [0.02, 0.02, 0.08], mass_kg: 0.1, at: {xyz: [0, 0, 0.05]}}]
  hook:
    {shape: box, size_m: [0.06, 0.06, 0.02], mass_kg: 0.3, at: {xyz: [0, 0.9, 0.1]}, tool: {tcps: {tip: {}}}}
"""

pytestmark = pytest.mark.virtual


@asynccontextmanager
async def opened(folder: Path, *, text: str = CELL, off_m: float = 0.0) -> AsyncGenerator[OpenCell]:
    """Open the cell with the probe at the face of the arm at home, or so far below it."""
    file = folder / "cell.yaml"
    file.write_text(text.replace("PLACE", "{}"), encoding="utf-8")
    entry = load_cell(file).document.robots["arm"]
    model = model_of_entry(entry, Path)
    base = RigidTransform.from_pose(entry.base.pose())
    face = ArmKinematics(model, base=base).tool_pose(np.array(model.home_rad))
    plate = Placement.of(
        face.then(RigidTransform.of((0.0, 0.0, 0.0102 + off_m), (0.0, 0.0, 0.0, 1.0))).to_pose("world")
    )
    place = f"{{xyz: {list(plate.xyz)}, rpy: {list(plate.rpy)}}}"
    file.write_text(text.replace("PLACE", place), encoding="utf-8")
    async with OpenCell(load_cell(file)) as cell:
        yield cell


async def lock(bus: SkillBus, tool: str = "probe", tcp: str = "") -> LockToolResult:
    end = await bus.send_goal(LockTool(tool=tool, tcp=tcp), to="arm").result()
    assert (end.status, end.cause) == (GoalStatus.SUCCEEDED, None)
    assert end.result is not None
    return end.result


async def release(bus: SkillBus, *, anywhere: bool = False) -> ReleaseToolResult | str:
    """Return how a release ended, or why it was refused."""
    end = await bus.send_goal(ReleaseTool(anywhere=anywhere), to="arm").result()
    if end.status is GoalStatus.REJECTED:
        assert end.cause is not None
        return end.cause.message
    assert end.result is not None
    return end.result


async def refused(bus: SkillBus, tool: str, tcp: str = "") -> str:
    end = await bus.send_goal(LockTool(tool=tool, tcp=tcp), to="arm").result()
    assert end.status is GoalStatus.REJECTED
    assert end.cause is not None
    return end.cause.message


def state(bus: SkillBus) -> ToolChangerState:
    found = bus.topic("arm/tool_changer", ToolChangerState).latest
    assert found is not None
    return found


async def settings(bus: SkillBus) -> tuple[float, float, float]:
    """Return how far the tool centre point is from the face, the load and how far its centre of mass is."""
    status: ArmStatus = await bus.call(ReadArm(), to="arm")
    now = status.settings
    return round(now.tool_xyz_m[2], 6), round(now.load_kg, 6), round(now.load_com_m[2], 6)


async def break_it(bus: SkillBus, fault: DeviceFault) -> None:
    assert (await bus.call(SimulateDeviceFault(fault=fault), to="arm")).success


async def held(bus: SkillBus) -> list[str]:
    return [part.name for part in (await bus.call(ReadPlanningScene(), to="cell")).held]


async def test_the_arm_has_what_the_tool_has_until_it_is_released(tmp_path: Path) -> None:
    """Tool centre point, load, shapes in the planning scene, and its name; 0.1 kg at 60 mm and 0.3 kg at 10 mm."""
    async with opened(tmp_path) as cell:
        bus = cell.bus
        assert (await settings(bus), await held(bus), state(bus).sensors["tool_present"]) == ((0.0, 0.0, 0.0), [], True)
        assert await lock(bus) == LockToolResult(ended="locked")
        assert state(bus) == ToolChangerState(
            tool="probe",
            tcp="tip",
            lock="locked",
            outputs={"tool_lock": True},
            sensors={"tool_locked": True, "tool_present": True},
        )
        assert (await settings(bus), await held(bus)) == ((0.1, 0.4, 0.0225), ["probe"])
        description = bus.topic("arm/description", RobotDescription)
        assert description.latest is not None
        assert description.latest.tool == "probe"
        assert await lock(bus, tcp="side") == LockToolResult(ended="locked")
        assert (await settings(bus), state(bus).tcp) == ((0.06, 0.4, 0.0225), "side")
        assert await release(bus) == ReleaseToolResult(ended="released")
        assert (state(bus).tool, state(bus).lock, description.latest.tool) == ("", "open", "")
        assert (await settings(bus), await held(bus)) == ((0.0, 0.0, 0.0), [])


async def test_a_lock_without_a_plate_at_its_face_stays_open(tmp_path: Path) -> None:
    async with opened(tmp_path, off_m=0.01) as cell:
        result = await lock(cell.bus)
        assert (result.ended, result.reason) == ("missing", "tool_present is off: no plate is at the face")
        assert (state(cell.bus).lock, state(cell.bus).tool) == ("open", "")


async def test_a_plate_that_is_felt_and_not_reached_is_not_locked(tmp_path: Path) -> None:
    """The switch in the face reaches farther than the lock; the piston shuts on nothing, and opens again."""
    async with opened(tmp_path, off_m=0.0014) as cell:
        result = await lock(cell.bus)
        assert (result.ended, result.reason) == ("not_locked", "tool_locked is off after 0.5 s")
        assert (state(cell.bus).lock, await settings(cell.bus)) == ("open", (0.0, 0.0, 0.0))


async def test_the_pins_of_another_tool_are_noticed(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        result = await lock(cell.bus, "hook")
        assert (result.ended, result.reason) == ("wrong_tool", "the pins of its plate tell probe")
        assert (state(cell.bus).lock, await held(cell.bus)) == ("open", [])


async def test_what_does_not_fit_is_refused_with_the_reason(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        bus = cell.bus
        assert "no tool prob" in await refused(bus, "prob")
        assert "probe has no tool centre point tipp" in await refused(bus, "probe", "tipp")
        await lock(bus)
        assert "arm has probe" in await refused(bus, "hook")
        assert (await bus.call(DescribeTool(tool="hook"), to="arm")).tool.mass_kg == 0.3


async def test_a_release_in_the_air_is_refused(tmp_path: Path) -> None:
    """Except where somebody holds the tool."""
    async with opened(tmp_path) as cell:
        bus = cell.bus
        await lock(bus)
        turned = (0.1, *model_by_name("panda").home_rad[1:])
        await bus.send_goal(JointTrapVel(joints=turned, speed=1.0), to="arm").result()
        assert "probe would fall" in str(await release(bus))
        assert state(bus).lock == "locked"
        assert await release(bus, anywhere=True) == ReleaseToolResult(ended="released")


async def test_a_tool_that_is_torn_off_is_noticed_without_a_question(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        bus = cell.bus
        await lock(bus)
        await bus.call(PushBody(body="probe", force_n=(0.0, 0.0, -700.0), duration_s=0.1), to="cell")
        await bus.clock.sleep(0.3)
        assert (state(bus).tool, state(bus).lock, state(bus).problem) == ("", "empty", "probe came off")
        assert (await settings(bus), await held(bus)) == ((0.0, 0.0, 0.0), [])


async def test_faults_of_the_lock_are_those_of_a_device(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        bus = cell.bus
        await break_it(bus, DeviceFault(stuck="lock"))
        assert (await lock(bus)).ended == "not_locked"
        await break_it(bus, DeviceFault())
        assert (await lock(bus)).ended == "locked"
        await break_it(bus, DeviceFault(stuck="lock"))
        assert (await release(bus)) == ReleaseToolResult(
            ended="not_released", reason="tool_locked is still on after 0.5 s"
        )
        assert (state(bus).tool, await held(bus)) == ("probe", ["probe"])
        wrong = await bus.call(SimulateDeviceFault(fault=DeviceFault(stuck="jaw")), to="arm")
        assert (wrong.success, "stuck: lock" in wrong.message) == (False, True)


@pytest.mark.parametrize("holds", [True, False])
async def test_without_air_only_a_self_holding_lock_keeps_its_tool(tmp_path: Path, *, holds: bool) -> None:
    text = CELL.replace("self_holding: false", f"self_holding: {str(holds).lower()}")
    async with opened(tmp_path, text=text) as cell:
        await lock(cell.bus)
        await break_it(cell.bus, DeviceFault(air=False))
        await cell.bus.clock.sleep(0.5)
        assert (state(cell.bus).tool, state(cell.bus).problem) == (("probe", "") if holds else ("", "probe came off"))


async def test_the_tool_is_known_after_a_restore(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        await lock(cell.bus)
        image = await cell.snapshot()
        assert image is not None
        await release(cell.bus)
        await cell.restore(image)
        found = await cell.bus.call(ReadToolChanger(), to="arm")
        assert (found.tool, found.tcp, found.lock, await settings(cell.bus)) == (
            "probe",
            "tip",
            "locked",
            (0.1, 0.4, 0.0225),
        )
