"""What is connected to outputs and inputs of an emulated controller is heard and read, by the numbers of the driver."""

from __future__ import annotations

import asyncio

from robots.drivers.emulation.plant import Plant
from robots.drivers.universal_robots.emulator.controller_emulator import ControllerEmulator
from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.emulated_arm import EmulatedArm
from robots.drivers.universal_robots.emulator.ur_models import ARMS
from tests.robots.sim.sim_cell import until


def test_changes_of_standard_and_tool_outputs_are_heard_and_nothing_else() -> None:
    heard: list[tuple[int, bool]] = []

    def on_output(output: int, *, on: bool) -> None:
        heard.append((output, on))

    controller = ControllerState(EmulatedArm(ARMS["ur10"], cycle_s=0.008), on_output=on_output)
    controller.set_digital_outputs(0b1001, 0b1001)
    controller.set_digital_outputs(0b0001, 0b0001)
    controller.set_digital_outputs(1 << 17 | 1 << 8, 1 << 17 | 1 << 8)
    controller.set_digital_outputs(0b1000, 0)
    assert heard == [(0, True), (3, True), (9, True), (3, False)]


def test_inputs_are_numbered_as_outputs_are() -> None:
    controller = ControllerState(EmulatedArm(ARMS["ur10"], cycle_s=0.008))
    controller.set_digital_input(3, on=True)
    controller.set_digital_input(9, on=True)
    controller.set_digital_input(10, on=True)
    assert controller.digital_inputs == 1 << 3 | 1 << 17
    controller.set_digital_input(3, on=False)
    assert controller.digital_inputs == 1 << 17


async def test_inputs_follow_what_a_plant_senses_in_each_cycle() -> None:
    sensed = {2: True}
    emulator = ControllerEmulator(model="ur10", series="cb3", plant=Plant(inputs=lambda: sensed))
    cycles = asyncio.create_task(emulator.run())
    await until(lambda: emulator.controller.digital_inputs == 1 << 2)
    sensed[2] = False
    await until(lambda: emulator.controller.digital_inputs == 0)
    cycles.cancel()
    await asyncio.wait((cycles,))
