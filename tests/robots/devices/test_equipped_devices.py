"""Devices on equipment: their outputs and sensors are pins, in a world as well as without one."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import GoalStatus, Holder, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import FramePoses
from engine.skills.device_moves import DeviceFault, MoveDevice, SimulateDeviceFault
from engine.skills.digital_inputs import DigitalInputs, SimulateInput
from engine.skills.digital_outputs import DigitalOutputs, SetOutput
from engine.skills.planning_scene import ReadPlanningScene
from tests.robots.devices.moved_device import move, state

PINS = """\
flexcell: 1
equipment: pneumatics
backend: {kind: simulated}
pins:
  go: {kind: digital_output, pin: 1, safe: false}
  hold: {kind: digital_output, pin: 2, safe: false}
  at_front: {kind: digital_input, pin: 3}
  at_back: {kind: digital_input, pin: 4}
"""
WITHOUT_WORLD = """\
flexcell: 1
cell: bench
equipment:
  valves: {pins: pins.yaml}
fixtures:
  carriage: {shape: box, size_m: [0.1, 0.1, 0.02], at: {xyz: [0.5, 0, 0.1]}}
devices:
  slide:
    equipment: valves
    axes:
      travel: {body: carriage, joint: slide, along: [0, 1, 0], stroke_m: 0.2, force_n: 80, speed_m_s: 0.2, output: go}
    sensors:
      at_front: {axis: travel, at_most: 0.003}
      at_back: {axis: travel, at_least: 0.197}
    positions:
      front: {steps: [{set: {go: false}}], sensors: {at_front: true, at_back: false}, time: 2}
      back: {steps: [{set: {go: true}}], sensors: {at_front: false, at_back: true}, time: 2}
    interlocks:
      - {position: front, device: clamp, at: free}
  clamp:
    equipment: valves
    positions:
      free: {steps: [{set: {hold: false}}], time: 0.5}
      held: {steps: [{set: {hold: true}}], time: 0.5}
"""
IN_WORLD = WITHOUT_WORLD + "world: {kind: mujoco}\n"

pytestmark = pytest.mark.virtual


@asynccontextmanager
async def opened(folder: Path, text: str) -> AsyncGenerator[OpenCell]:
    """Open the cell."""
    (folder / "pins.yaml").write_text(PINS, encoding="utf-8")
    (folder / "cell.yaml").write_text(text, encoding="utf-8")
    async with OpenCell(load_cell(folder / "cell.yaml")) as cell:
        yield cell


def pins(bus: SkillBus) -> dict[str, bool]:
    """Return the values of all pins by name."""
    inputs = bus.topic("valves/digital_inputs", DigitalInputs).latest
    outputs = bus.topic("valves/digital_outputs", DigitalOutputs).latest
    assert inputs is not None
    assert outputs is not None
    return {name: each.values[number] for each in (inputs, outputs) for name, number in each.names.items()}


def carriage_y(bus: SkillBus) -> float:
    """Return how far the carriage is along its slide, in metres."""
    frames = bus.topic("cell/frames", FramePoses).latest
    assert frames is not None
    return frames.xyz[frames.names.index("carriage")][1]


async def simulate(bus: SkillBus, name: str, *, on: bool) -> None:
    """Set an input."""
    assert (await bus.call(SimulateInput(name=name, value=on), to="valves")).success


async def test_its_outputs_are_set_and_its_inputs_say_where_it_is(tmp_path: Path) -> None:
    async with opened(tmp_path, WITHOUT_WORLD) as cell:
        bus = cell.bus
        assert (state(bus, "slide").sensed, state(bus, "slide").axes) == ("between", {})
        moving = asyncio.create_task(move(bus, "slide", "back"))
        await bus.clock.sleep(0.5)
        assert (pins(bus)["go"], state(bus, "slide").moving) == (True, True)
        await simulate(bus, "at_back", on=True)
        assert (await moving).ended == "reached"
        assert (state(bus, "slide").sensed, state(bus, "slide").outputs) == ("back", {"go": True})


async def test_what_never_arrives_is_stuck(tmp_path: Path) -> None:
    async with opened(tmp_path, WITHOUT_WORLD) as cell:
        result = await move(cell.bus, "slide", "back")
        assert result.ended == "stuck"
        assert result.reason == "at_back is off after 2 s; nothing has changed since its start"


async def test_an_interlock_leaves_the_pins_alone(tmp_path: Path) -> None:
    async with opened(tmp_path, WITHOUT_WORLD) as cell:
        await move(cell.bus, "clamp", "held")
        refused = await move(cell.bus, "slide", "front")
        assert (refused.ended, refused.reason) == ("interlocked", "clamp is not at free")
        assert (await move(cell.bus, "clamp", "free")).ended == "timed"
        await simulate(cell.bus, "at_front", on=True)
        assert (await move(cell.bus, "slide", "front")).ended == "reached"


async def test_pins_that_another_run_commands_are_left_alone(tmp_path: Path) -> None:
    async with opened(tmp_path, WITHOUT_WORLD) as cell:
        cell.bus.leases.acquire(["valves"], Holder(run="another"))
        end = await cell.bus.send_goal(MoveDevice(position="back"), to="slide", holder=Holder(run="mine")).result()
        assert end.status is GoalStatus.ABORTED
        assert end.cause is not None
        assert "valves is commanded by run another" in end.cause.chain()[-1].message
        assert not pins(cell.bus)["go"]


async def test_in_a_world_axes_follow_the_pins_and_inputs_the_axes(tmp_path: Path) -> None:
    async with opened(tmp_path, IN_WORLD) as cell:
        bus = cell.bus
        await bus.clock.sleep(0.1)
        assert (pins(bus)["at_front"], pins(bus)["at_back"]) == (True, False)
        assert (await move(bus, "slide", "back")).ended == "reached"
        assert carriage_y(bus) == pytest.approx(0.2, abs=0.004)
        assert (pins(bus)["at_front"], pins(bus)["at_back"]) == (False, True)


async def test_an_output_that_is_set_by_hand_moves_the_axis_too(tmp_path: Path) -> None:
    async with opened(tmp_path, IN_WORLD) as cell:
        bus = cell.bus
        assert (await bus.call(SetOutput(name="go", value=True), to="valves")).success
        await bus.clock.sleep(2.0)
        assert carriage_y(bus) == pytest.approx(0.2, abs=0.004)
        assert pins(bus)["at_back"]
        assert (state(bus, "slide").commanded, state(bus, "slide").sensed) == ("", "back")


async def test_the_planning_scene_follows_an_output_that_is_set_by_hand(tmp_path: Path) -> None:
    async with opened(tmp_path, IN_WORLD) as cell:
        await cell.bus.call(ReadPlanningScene(), to="cell")
        assert (await cell.bus.call(SetOutput(name="go", value=True), to="valves")).success
        await cell.bus.clock.sleep(2.0)
        scene = await cell.bus.call(ReadPlanningScene(), to="cell")
        carriage = next(each for each in scene.obstacles if each.name == "carriage")
        assert carriage.pose.xyz[1] == pytest.approx(0.2, abs=0.004)


async def test_a_fault_that_is_refused_breaks_nothing(tmp_path: Path) -> None:
    async with opened(tmp_path, IN_WORLD) as cell:
        broken = SimulateDeviceFault(fault=DeviceFault(stuck="travel", brakes=False))
        assert not (await cell.bus.call(broken, to="slide")).success
        assert (await move(cell.bus, "slide", "back")).ended == "reached"


async def test_a_stop_makes_pins_safe_and_what_they_press_follows(tmp_path: Path) -> None:
    stops = PINS.replace("pin: 1, safe: false", "pin: 1, safe: false, at_stop: safe")
    async with opened(tmp_path, IN_WORLD) as cell:
        await move(cell.bus, "slide", "back")
        await cell.stop()
        await cell.bus.clock.sleep(1.0)
        assert carriage_y(cell.bus) == pytest.approx(0.2, abs=0.004)
    (tmp_path / "pins.yaml").write_text(stops, encoding="utf-8")
    async with OpenCell(load_cell(tmp_path / "cell.yaml")) as cell:
        await move(cell.bus, "slide", "back")
        await cell.stop()
        await cell.bus.clock.sleep(2.0)
        assert carriage_y(cell.bus) == pytest.approx(0.0, abs=0.004)


async def test_a_broken_device_has_its_cause(tmp_path: Path) -> None:
    async with opened(tmp_path, IN_WORLD) as cell:
        broken = SimulateDeviceFault(fault=DeviceFault(stuck="travel"))
        assert (await cell.bus.call(broken, to="slide")).success
        assert (await move(cell.bus, "slide", "back")).ended == "stuck"


async def test_what_was_pressed_is_pressed_in_a_resumed_run(tmp_path: Path) -> None:
    """The pins of a new cell begin with their safe values."""
    async with opened(tmp_path, IN_WORLD) as cell:
        await move(cell.bus, "slide", "back")
        before = await cell.snapshot()
        assert before is not None
    async with opened(tmp_path, IN_WORLD) as cell:
        await cell.restore(before)
        await cell.bus.clock.sleep(1.0)
        assert pins(cell.bus)["go"]
        assert carriage_y(cell.bus) == pytest.approx(0.2, abs=0.004)
