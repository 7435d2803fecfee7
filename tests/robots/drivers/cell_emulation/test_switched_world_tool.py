"""The valve between the outputs of a controller and a tool of the world."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from robots.drivers.cell_emulation.switched_world_tool import SwitchedWorldTool
from robots.drivers.emulation.plant import ToolMeasurement
from robots.standard_tools.switched_gripper_driver import SwitchedGripperOptions


class NotedTool:
    """Implements `ToolPlant`; notes what it is told."""

    def __init__(self) -> None:
        self.shares: list[float] = []

    def close_to(self, closed_share: float, *, speed_share: float = 1.0, force_share: float = 1.0) -> None:
        """Note the share."""
        self.shares.append(closed_share)

    def stop(self) -> None:
        """Do nothing."""

    def home(self) -> None:
        """Do nothing."""

    def measured(self) -> ToolMeasurement:
        """Return that it rests where it is."""
        return ToolMeasurement(closed_share=self.shares[-1], moving=False, blocked=False)


@pytest.mark.parametrize(
    ("given", "outputs", "shares"),
    [
        ({}, [(0, True), (0, True), (1, True), (0, False)], [1.0, 0.0]),
        ({"hold_output": 2, "inverted": True}, [(2, True), (2, False)], [0.0, 1.0]),
        # One coil goes off before the other goes on, and the valve stays in between; both at once move nothing.
        ({"release_output": 1}, [(1, False), (0, True), (0, False), (1, True)], [1.0, 0.0]),
        ({"release_output": 1}, [(0, True), (1, True), (0, False)], [1.0, 0.0]),
    ],
)
def test_a_tool_follows_its_outputs(
    given: dict[str, Any], outputs: list[tuple[int, bool]], shares: list[float]
) -> None:
    tool = NotedTool()
    options = msgspec.convert({"kind": "switched_gripper", **given}, SwitchedGripperOptions)
    wired = SwitchedWorldTool(options, owner="arm", tool=tool)
    for output, on in outputs:
        wired.take(output, on=on)
    assert tool.shares == shares


@pytest.mark.parametrize(
    ("sensor", "free", "holding"),
    [
        (None, "", ""),
        ({"topic": "line/part"}, "", ""),
        ({"input": 3}, "3 off", "3 on"),
        ({"input": 3, "inverted": True}, "3 on", "3 off"),
    ],
)
def test_the_input_of_its_sensor_follows_what_it_holds(sensor: dict[str, Any] | None, free: str, holding: str) -> None:
    held: list[bool] = []
    options = msgspec.convert({"kind": "switched_gripper", "sensor": sensor}, SwitchedGripperOptions)
    wired = SwitchedWorldTool(options, owner="arm", tool=NotedTool(), holds=lambda: bool(held))
    before = sensed(wired)
    held.append(True)
    assert (before, sensed(wired)) == (free, holding)


def sensed(wired: SwitchedWorldTool) -> str:
    """Return the input of its sensor in words."""
    return " ".join(f"{number} {'on' if on else 'off'}" for number, on in wired.sensed().items())
