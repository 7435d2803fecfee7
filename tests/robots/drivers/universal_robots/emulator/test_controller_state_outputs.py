"""What is connected to the outputs of an emulated controller hears of each change, by the numbers of the driver."""

from __future__ import annotations

from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.emulated_arm import EmulatedArm
from robots.drivers.universal_robots.emulator.ur_models import ARMS


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
