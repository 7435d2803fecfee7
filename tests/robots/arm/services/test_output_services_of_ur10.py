"""The outputs of a UR10 in a cell: named in the cell document, kept over a crash."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.document.cell import load_cell
from engine.errors import CellError
from engine.skills.digital_outputs import DigitalOutputs, SetLinearAxis, SetOutput, SetToolExchange
from robots.sim.world.sim_world import SimWorld
from robots.simulated_cell import new_world

CELL = """
flexcell: 1
cell: one_ur10
world: {kind: mujoco, step_s: 0.002}
robots:
  ur10:
    model: ur10
    outputs: {tool_exchange: 3, linear_axis: 0}
"""


@asynccontextmanager
async def opened(folder: Path, text: str = CELL) -> AsyncGenerator[tuple[SkillBus, SimWorld]]:
    """A cell with a UR10, in lockstep."""
    (folder / "cell.yaml").write_text(text)
    async with AsyncExitStack() as stack:
        bus = await stack.enter_async_context(SkillBus(new_clock()))
        cell = load_cell(folder / "cell.yaml")
        world = await stack.enter_async_context(new_world(cell, bus=bus, virtual=True, seed=None))
        for robot in world.robots():
            await stack.enter_async_context(robot)
            robot.register(bus)
        yield bus, world


def on(bus: SkillBus) -> list[int]:
    """The numbers of the outputs that are on."""
    latest = bus.topic("ur10/digital_outputs", DigitalOutputs).latest
    assert latest is not None
    return [number for number, value in enumerate(latest.values) if value]


@pytest.mark.virtual
async def test_the_ten_outputs_of_a_ur10_are_set_by_number_and_name_and_kept_by_a_snapshot(tmp_path: Path) -> None:
    """A world that goes on after a crash has the valves where they were."""
    async with opened(tmp_path) as (bus, world):
        for request in (SetToolExchange(value=True), SetLinearAxis(value=True), SetOutput(output=9, value=True)):
            assert (await bus.call(request, to="ur10")).success
        assert on(bus) == [0, 3, 9]
        snapshot = world.snapshot()
        await bus.call(SetOutput(output=3, value=False), to="ur10")
    async with opened(tmp_path) as (bus, world):
        assert on(bus) == []
        await world.restore(snapshot)
        assert on(bus) == [0, 3, 9]


@pytest.mark.virtual
async def test_an_output_that_the_model_has_not_is_an_error_of_the_cell(tmp_path: Path) -> None:
    """With its place in the document."""
    with pytest.raises(CellError, match=r"cell\.yaml:8:\d+: ur10 has no output 12 for gripper .*outputs 0 to 9"):
        async with opened(tmp_path, CELL.replace("tool_exchange: 3", "gripper: 12")):
            pass
