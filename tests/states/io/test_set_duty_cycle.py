"""The state that sets a PWM output of equipment, and the names that its check knows."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from engine.cell.cell_names import cell_names
from engine.document import load_cell
from engine.skills import pwm_outputs
from engine.skills.switch_result import SwitchResult
from engine.state import Outcome
from states.io.set_duty_cycle import SetDutyCycle
from tests.robots.drivers.equipment.device.equipment_cell import written
from tests.robots.drivers.equipment.served_equipment import SIMULATED
from tests.states.fake_context import FakeContext

HALF = SetDutyCycle(equipment="lights", name="lamp", duty_cycle=0.5)


async def test_the_output_is_set_by_one_request_to_the_equipment_which_is_leased() -> None:
    ctx = FakeContext({"lights/set_duty_cycle": SwitchResult(success=True, message="lamp is at 50%")})
    assert await HALF.run(ctx) == Outcome("set")
    assert ctx.sent == [("lights/set_duty_cycle", pwm_outputs.SetDutyCycle(name="lamp", duty_cycle=0.5))]
    assert HALF.resources() == ("lights",)


async def test_an_output_that_is_not_set_is_an_outcome_with_the_reason() -> None:
    refusal = SwitchResult(success=False, message="not enabled")
    outcome = await HALF.run(FakeContext({"lights/set_duty_cycle": refusal}))
    assert outcome.name == "failed"
    assert outcome.cause is not None
    assert [link.message for link in outcome.cause.chain()] == ["lamp of lights was not set to 50%", "not enabled"]


def test_a_duty_cycle_is_a_share() -> None:
    with pytest.raises(msgspec.ValidationError, match=r"<= 1\.0"):
        msgspec.convert({"equipment": "lights", "name": "lamp", "duty_cycle": 1.5}, SetDutyCycle)


def test_the_names_of_pwm_outputs_are_those_of_the_equipment_document(tmp_path: Path) -> None:
    pins = SIMULATED + "  lamp: {kind: pwm, pin: 12, safe: 0.1}\n"
    names = cell_names(load_cell(written(tmp_path, port=1, pins=pins)))
    assert names.by_kind["pwm_output"] == {"vice/lamp"}
    assert names.has("pwm_output", "vice/lamp")
    assert names.missing("pwm_output", "vice/valve") == "`vice` of the cell bench has no PWM output `valve`"
