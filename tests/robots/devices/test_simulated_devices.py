"""Simulated devices on the bus of an open cell: sensors follow the physics, planners the jaws; faults have names."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import FramePoses
from engine.skills.device_moves import DeviceFault, MoveDevice, SimulateDeviceFault
from engine.skills.modules import PlugModule
from engine.skills.planning_scene import ReadPlanningScene
from tests.robots.devices.moved_device import move, state

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
frames:
  seat: {parent: carriage, at: {xyz: [0, 0, 0.01]}}
fixtures:
  carriage: {shape: box, size_m: [0.1, 0.1, 0.02], at: {xyz: [0.5, 0, 0.1]}}
  clamp: {shape: box, size_m: [0.02, 0.02, 0.02], at: {xyz: [0.5, 0.5, 0.1]}}
devices:
  slide:
    axes:
      travel: {body: carriage, joint: slide, along: [0, 1, 0], stroke_m: 0.2, force_n: 80, speed_m_s: 0.2, output: go}
    sensors:
      at_front: {axis: travel, at_most: 0.003}
      at_back: {axis: travel, at_least: 0.197}
      air: {air: true}
    positions:
      front: {steps: [{set: {go: false}}], sensors: {at_front: true, at_back: false}, time: 2}
      back: {steps: [{set: {go: true}}], sensors: {at_front: false, at_back: true}, time: 2}
    interlocks:
      - {position: front, device: clamp, at: free}
  clamp:
    axes:
      bolt:
        {body: clamp, joint: slide, along: [1, 0, 0], stroke_m: 0.05, force_n: 80, speed_m_s: 0.2, self_holding: true, output: out, output_back: in}
    positions:
      free: {steps: [{set: {out: false, in: true}}], time: 0.5}
      clamped: {steps: [{set: {out: true, in: false}}], time: 0.5}
"""  # noqa: E501

pytestmark = pytest.mark.virtual


@asynccontextmanager
async def opened(folder: Path) -> AsyncGenerator[OpenCell]:
    """Open the cell."""
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    async with OpenCell(load_cell(folder / "cell.yaml")) as cell:
        yield cell


async def test_a_slide_is_where_its_end_switch_tells(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        assert (state(cell.bus, "slide").commanded, state(cell.bus, "slide").sensed) == ("", "front")
        result = await move(cell.bus, "slide", "back")
        known = state(cell.bus, "slide")
        assert (result.ended, known.commanded, known.sensed, known.problem) == ("reached", "back", "back", "")
        assert known.axes["travel"] == pytest.approx(0.2, abs=0.004)
        frames = cell.bus.topic("cell/frames", FramePoses).latest
        assert frames is not None
        assert frames.xyz[frames.names.index("carriage")][1] == pytest.approx(0.2, abs=0.004)


async def test_the_planning_scene_follows_the_carriage(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        await cell.bus.call(ReadPlanningScene(), to="cell")
        await move(cell.bus, "slide", "back")
        scene = await cell.bus.call(ReadPlanningScene(), to="cell")
        pose = next(one.pose for one in scene.obstacles if one.name == "carriage")
        assert pose.xyz[1] == pytest.approx(0.2, abs=0.004)


async def test_a_frame_on_the_carriage_follows_it(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        await move(cell.bus, "slide", "back")
        frames = cell.bus.topic("cell/frames", FramePoses).latest
        assert frames is not None
        carriage, seat = (frames.xyz[frames.names.index(name)] for name in ("carriage", "seat"))
        assert seat == pytest.approx((carriage[0], carriage[1], carriage[2] + 0.01), abs=2e-3)
        assert seat[1] > 0.19


async def test_without_sensors_a_state_is_unknown_and_a_position_timed(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        result = await move(cell.bus, "clamp", "clamped")
        known = state(cell.bus, "clamp")
        assert (result.ended, result.sensed) == ("timed", "unknown")
        assert (known.commanded, known.sensed, known.timed) == ("clamped", "unknown", True)


async def test_an_interlock_holds_until_the_other_device_was_moved_and_its_time_has_passed(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        await move(cell.bus, "slide", "back")
        assert (await move(cell.bus, "slide", "front")).reason == "clamp is not at free"
        await move(cell.bus, "clamp", "free")
        assert (await move(cell.bus, "slide", "front")).ended == "reached"


@pytest.mark.parametrize(
    ("fault", "ended"),
    [
        (SimulateDeviceFault(fault=DeviceFault(air=False)), "no_air"),
        (SimulateDeviceFault(fault=DeviceFault(stuck="travel")), "stuck"),
        (SimulateDeviceFault(fault=DeviceFault(sensor="at_back", reads=False)), "stuck"),
        (SimulateDeviceFault(fault=DeviceFault(sensor="at_front", reads=True)), "sensor_contradicts"),
    ],
    ids=["no air", "stuck", "sensor off", "sensor on"],
)
async def test_each_failure_has_its_name_and_can_be_repaired(
    tmp_path: Path, fault: SimulateDeviceFault, ended: str
) -> None:
    async with opened(tmp_path) as cell:
        assert (await cell.bus.call(fault, to="slide")).success
        assert (await move(cell.bus, "slide", "back")).ended == ended
        await cell.bus.call(SimulateDeviceFault(), to="slide")
        assert (await move(cell.bus, "slide", "back")).ended == "reached"


async def test_a_fault_of_what_a_device_does_not_have_is_refused(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        answer = await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(stuck="travle")), to="slide")
        assert (answer.success, answer.message) == (False, "slide has no travle: it has travel")


async def test_a_canceled_goal_ends_its_steps_and_keeps_the_outputs(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        handle = cell.bus.send_goal(MoveDevice(position="back"), to="slide")
        await asyncio.sleep(0.3)
        assert state(cell.bus, "slide").moving
        handle.cancel()
        assert (await handle.result()).status is GoalStatus.CANCELED
        known = state(cell.bus, "slide")
        assert (known.moving, known.outputs, known.timed) == (False, {"go": True}, False)


async def test_a_position_that_a_device_does_not_have_is_rejected(tmp_path: Path) -> None:
    async with opened(tmp_path) as cell:
        end = await cell.bus.send_goal(MoveDevice(position="bakc"), to="slide").result()
        assert end.status is GoalStatus.REJECTED
        assert end.cause is not None
        assert "slide has no position bakc" in end.cause.message


async def test_a_restored_world_presses_as_it_did(tmp_path: Path) -> None:
    """Outputs, commands and faults are those of the snapshot."""
    async with opened(tmp_path) as cell:
        await move(cell.bus, "clamp", "free")
        await move(cell.bus, "slide", "back")
        assert cell.world is not None
        image = cell.world.snapshot()
        await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(stuck="travel")), to="slide")
        await move(cell.bus, "slide", "front")
        await cell.world.restore(image)
        known = state(cell.bus, "slide")
        assert (known.commanded, known.sensed, known.outputs) == ("back", "back", {"go": True})
        assert (await move(cell.bus, "slide", "front")).ended == "reached"


async def test_a_self_holding_axis_presses_on_without_air(tmp_path: Path) -> None:
    """The valve moves and nothing follows it."""
    async with opened(tmp_path) as cell:
        await move(cell.bus, "clamp", "clamped")
        await cell.bus.call(SimulateDeviceFault(fault=DeviceFault(air=False)), to="clamp")
        await move(cell.bus, "clamp", "free")
        assert state(cell.bus, "clamp").axes["bolt"] == pytest.approx(0.05, abs=1e-3)


async def test_planners_know_the_carriage_where_it_is_also_after_a_module_was_plugged(tmp_path: Path) -> None:
    (tmp_path / "bin").mkdir()
    module = "flexcell: 1\nmodule: bin\nfixtures: {tray: {shape: tray, size_m: [0.2, 0.2, 0.03]}}\n"
    (tmp_path / "bin" / "module.yaml").write_text(module, encoding="utf-8")
    docked = (
        "connectors: {dock: {at: {xyz: [1, 1, 0]}}}\nmodules: {bin: {module: bin, connector: dock, plugged: false}}\n"
    )
    (tmp_path / "cell.yaml").write_text(CELL + docked, encoding="utf-8")
    async with OpenCell(load_cell(tmp_path / "cell.yaml")) as cell:
        await move(cell.bus, "slide", "back")
        await cell.bus.call(PlugModule(), to="bin")
        scene = await cell.bus.call(ReadPlanningScene(), to="cell")
        pose = next(one.pose for one in scene.obstacles if one.name == "carriage")
        assert pose.xyz[1] == pytest.approx(0.2, abs=0.004)
