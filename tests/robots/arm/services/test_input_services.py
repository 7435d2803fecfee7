"""The inputs of a UR10 in a cell: named there, set in the place of sensors, kept over a crash; a behavior waits."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.document.cell import load_cell
from engine.errors import CellError
from engine.skills.digital_inputs import DigitalInputs, SimulateInput
from robots.arm.services.input_services import InputServices
from robots.sim.world.sim_world import SimWorld
from robots.simulated_cell import new_world

CELL = """
flexcell: 1
cell: one_ur10
world: {kind: mujoco, step_s: 0.002}
robots:
  ur10:
    model: ur10
    inputs: {part_present: 3, door_closed: 9}
"""
NAMES = {"part_present": 3, "door_closed": 9}


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


def latest(bus: SkillBus) -> DigitalInputs:
    message = bus.topic("ur10/digital_inputs", DigitalInputs).latest
    assert message is not None
    return message


@pytest.mark.virtual
async def test_simulated_inputs_are_set_published_with_their_names_and_kept_by_a_snapshot(tmp_path: Path) -> None:
    async with opened(tmp_path) as (bus, world):
        assert latest(bus) == DigitalInputs(values=(False,) * 10, names=NAMES)
        assert (await bus.call(SimulateInput(input=9, value=True), to="ur10")).message == "input 9 is on"
        assert latest(bus).values == (*(False,) * 9, True)
        assert (await bus.call(SimulateInput(name="door_closed", value=True), to="ur10")).message == "input 9 is on"
        unnamed = await bus.call(SimulateInput(name="gate", value=True), to="ur10")
        assert unnamed.message == "there is no input gate; the cell names part_present, door_closed"
        refused = await bus.call(SimulateInput(input=10, value=True), to="ur10")
        assert (refused.success, "its inputs are 0 to 9" in refused.message) == (False, True)
        snapshot = world.snapshot()
    async with opened(tmp_path) as (bus, world):
        await world.restore(snapshot)
        assert latest(bus).values == (*(False,) * 9, True)


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("text", "hint"),
    [
        (CELL.replace("door_closed: 9", "door_closed: 10"), "a ur10 has the inputs 0 to 9"),
        (CELL.replace("model: ur10", "model: panda"), "a panda has no inputs"),
    ],
)
async def test_a_name_for_an_input_that_is_missing_is_refused(tmp_path: Path, text: str, hint: str) -> None:
    with pytest.raises(CellError, match="has no input") as refused:
        async with opened(tmp_path, text):
            pass
    assert refused.value.hint == hint


class LosingPort:
    """Inputs of a controller whose connection gets lost."""

    def __init__(self) -> None:
        self.count = 2
        self.values: tuple[bool, ...] = (True, False)
        self.problem = ""


@pytest.mark.virtual
async def test_nothing_is_said_of_the_inputs_of_a_controller_that_is_lost() -> None:
    port = LosingPort()
    services = InputServices("ur10", port, names={"door": 0})
    async with SkillBus(new_clock()) as bus:
        services.register(bus)
        seen: list[DigitalInputs] = []
        bus.topic("ur10/digital_inputs", DigitalInputs).subscribe(seen.append)
        for values, problem in (((True, False), ""), ((True, True), ""), ((True, True), "link cut")):
            port.values, port.problem = values, problem
            services.publish_changes()
    assert seen == [
        DigitalInputs(values=(True, True), names={"door": 0}),
        DigitalInputs(values=(), names={"door": 0}, problem="link cut"),
    ]
