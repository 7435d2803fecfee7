"""The state that switches an output."""

from __future__ import annotations

from typing import Any

import pytest

from engine.skill import Service
from engine.skills import digital_outputs as outputs
from engine.skills.digital_outputs import SetGripper, SetLinearAxis, SetToolExchange
from engine.skills.switch_result import SwitchResult
from engine.state import Outcome
from states.io.set_output import SetOutput
from tests.states.fake_context import FakeContext

DONE = SwitchResult(success=True, message="it is on")


@pytest.mark.parametrize(
    ("state", "request_"),
    [
        (SetOutput(robot="ur10", value=True, output=0), outputs.SetOutput(output=0, value=True)),
        (SetOutput(robot="ur10", value=False, output=9), outputs.SetOutput(output=9, value=False)),
        (SetOutput(robot="ur10", value=True, device="tool_exchange"), SetToolExchange(value=True)),
        (SetOutput(robot="ur10", value=True, device="gripper"), SetGripper(value=True)),
        (SetOutput(robot="ur10", value=False, device="linear_axis"), SetLinearAxis(value=False)),
        (SetOutput(robot="ur10", value=True, name="valve"), outputs.SetOutput(name="valve", value=True)),
    ],
)
async def test_an_output_is_named_by_its_number_or_by_what_hangs_on_it(
    state: SetOutput, request_: Service[Any]
) -> None:
    """One request to the robot, which is leased."""
    address = f"ur10/{request_.skill_name()}"
    ctx = FakeContext({address: DONE})
    assert await state.run(ctx) == Outcome("set")
    assert (ctx.sent, state.resources()) == ([(address, request_)], ("ur10",))


async def test_an_output_that_is_not_switched_is_an_outcome_with_the_robot_s_message() -> None:
    """Such as a number that it has not."""
    refusal = SwitchResult(success=False, message="there is no output 12")
    outcome = await SetOutput(robot="ur10", value=True, output=12).run(FakeContext({"ur10/set_output": refusal}))
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == [
        "output 12 of ur10 was not turned on",
        "there is no output 12",
    ]


@pytest.mark.parametrize("given", [{}, {"output": 1, "device": "gripper"}, {"output": 1, "name": "valve"}])
def test_an_output_has_one_name(given: dict[str, Any]) -> None:
    """Not none, not two."""
    with pytest.raises(ValueError, match="one of `output`, `device` and `name`"):
        SetOutput(robot="ur10", value=True, **given)
