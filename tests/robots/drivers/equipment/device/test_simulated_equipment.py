"""Equipment with `driver: sim`: pins in memory, inputs that are simulated, and STOP."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import NoSuchSkill
from engine.skills.devices import EnableDevice
from engine.skills.digital_inputs import SimulateInput
from engine.skills.digital_outputs import SetOutput
from tests.robots.drivers.equipment.device.equipment_cell import VICE, inputs, opened, outputs, switched, written


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


@pytest.mark.parametrize("request_on", [SimulateInput(name="there", value=True), SimulateInput(input=0, value=True)])
async def test_inputs_are_simulated_by_name_or_number(tmp_path: Path, request_on: SimulateInput) -> None:
    async with opened(written(tmp_path, port=1), simulate=("all",)) as cell:
        assert inputs(cell.bus).values == (False,)
        assert (await cell.bus.call(request_on, to=VICE)).message == "there is on"
        assert inputs(cell.bus).values == (True,)
        refused = await cell.bus.call(SimulateInput(name="gone", value=True), to=VICE)
        assert refused.message == "vice has no input gone; its inputs are there"
