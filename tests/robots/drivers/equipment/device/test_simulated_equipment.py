"""Equipment with `driver: sim`: pins in memory, inputs that are simulated, and STOP."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.errors import NoSuchSkill
from engine.skills.devices import EnableDevice
from engine.skills.digital_inputs import SimulateInput
from engine.skills.digital_outputs import SetOutput
from engine.skills.pwm_outputs import PwmOutputs, SetDutyCycle
from tests.robots.drivers.equipment.device.equipment_cell import VICE, inputs, opened, outputs, switched, written
from tests.robots.drivers.equipment.served_equipment import SIMULATED


async def test_outputs_begin_safe_and_are_set_without_a_server_or_a_world(tmp_path: Path) -> None:
    async with opened(written(tmp_path, port=1), simulate=("vice",)) as cell:
        assert outputs(cell.bus) == {"clamp": True, "valve": False}
        assert (await switched(cell.bus, "valve", on=True)).message == "valve is on"
        assert (await switched(cell.bus, "clamp", on=False)).success
        assert outputs(cell.bus) == {"clamp": False, "valve": True}
        await cell.stop()
        assert outputs(cell.bus) == {"clamp": False, "valve": False}
        refused = await cell.bus.call(SetOutput(name="there", value=True), to=VICE)
        assert refused.message == "vice has no output there; its outputs are clamp, valve"
        with pytest.raises(NoSuchSkill):
            await cell.bus.call(EnableDevice(reason="a test"), to=VICE)


LIT = SIMULATED + "  lamp: {kind: pwm, pin: 12, safe: 0.1, at_stop: safe}\n"


def duty_cycles(bus: SkillBus) -> dict[str, float]:
    """Return those of all PWM outputs."""
    latest = bus.topic(f"{VICE}/pwm_outputs", PwmOutputs).latest
    assert latest is not None
    return latest.duty_cycles


async def test_a_pwm_output_is_set_to_a_duty_cycle_and_goes_to_its_safe_one_at_stop(tmp_path: Path) -> None:
    async with opened(written(tmp_path, port=1, pins=LIT), simulate=("vice",)) as cell:
        assert duty_cycles(cell.bus) == {"lamp": 0.1}
        done = await cell.bus.call(SetDutyCycle(name="lamp", duty_cycle=0.4), to=VICE)
        assert (done.success, done.message) == (True, "lamp is at 40%")
        assert (duty_cycles(cell.bus), "lamp" in outputs(cell.bus)) == ({"lamp": 0.4}, False)
        refused = await cell.bus.call(SetDutyCycle(name="valve", duty_cycle=0.4), to=VICE)
        assert refused.message == "vice has no PWM output valve; those are lamp"
        await cell.stop()
        assert duty_cycles(cell.bus) == {"lamp": 0.1}


@pytest.mark.parametrize("request_on", [SimulateInput(name="there", value=True), SimulateInput(input=0, value=True)])
async def test_inputs_are_simulated_by_name_or_number(tmp_path: Path, request_on: SimulateInput) -> None:
    async with opened(written(tmp_path, port=1), simulate=("all",)) as cell:
        assert inputs(cell.bus).values == (False,)
        assert (await cell.bus.call(request_on, to=VICE)).message == "there is on"
        assert inputs(cell.bus).values == (True,)
        refused = await cell.bus.call(SimulateInput(name="gone", value=True), to=VICE)
        assert refused.message == "vice has no input gone; its inputs are there"
