"""A switched tool whose sensor is a digital input of the controller that switches it."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from engine.bus import SkillBus
from engine.errors import RobotError
from engine.skills.digital_inputs import DigitalInputs
from engine.skills.gripper import ReadGripper
from robots.switched.switched_options import PartSensor
from tests.robots.drivers.switched_tool.switched_under_test import ARM, switched
from tests.robots.drivers.switched_tool.test_switched_tool import GRASP

GRIPPER = f"{ARM}/gripper"


def read(bus: SkillBus, *values: bool, problem: str = "") -> None:
    """Let the controller report its inputs."""
    bus.topic(f"{ARM}/digital_inputs", DigitalInputs).publish(DigitalInputs(values=values, problem=problem))


@pytest.mark.parametrize("inverted", [False, True])
async def test_an_input_tells_whether_a_part_is_held_and_once_it_is_unknown_nothing_is(inverted: bool) -> None:
    async with switched("gripper", enable=False, sensor={"input": 1, "inverted": inverted}) as (bus, device, _):
        read(bus, False, not inverted)
        await device.enable("a test")
        grasp = await bus.send_goal(GRASP, to=GRIPPER).result()
        assert grasp.result is not None
        assert (grasp.result.held, grasp.result.by) == (True, "sensor")
        read(bus, False, inverted)
        assert not (await bus.call(ReadGripper(), to=GRIPPER)).held
        read(bus, False, not inverted)
        assert (await bus.call(ReadGripper(), to=GRIPPER)).held
        read(bus, problem="link cut")
        assert not (await bus.call(ReadGripper(), to=GRIPPER)).held


async def test_an_input_that_the_controller_does_not_have_is_named_when_the_tool_is_enabled() -> None:
    async with switched("gripper", enable=False, sensor={"input": 2}) as (bus, device, _):
        read(bus, True, True)
        with pytest.raises(RobotError, match="left has no input 2") as refused:
            await device.enable("a test")
        assert "flexcell devices" in (refused.value.hint or "")


@pytest.mark.parametrize("given", [{}, {"topic": "line/eye", "input": 1}])
def test_a_sensor_is_one_thing(given: dict[str, Any]) -> None:
    with pytest.raises(msgspec.ValidationError, match="either `topic` or `input`"):
        msgspec.convert(given, PartSensor)
