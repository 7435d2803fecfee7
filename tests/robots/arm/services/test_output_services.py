"""Digital outputs by number and by what hangs on them."""

from __future__ import annotations

import pytest

from engine.bus import Holder
from engine.errors import LeaseRefused, NoSuchSkill
from engine.skills.digital_outputs import DigitalOutputs, SetGripper, SetLinearAxis, SetOutput, SetToolExchange
from engine.skills.switch_result import SwitchResult
from robots.arm.services.output_services import OutputServices
from robots.sim.ports.sim_outputs import SimOutputPort
from tests.robots.arm.served import Served, served


def outputs(port: SimOutputPort) -> OutputServices:
    """Ten outputs with a tool exchange and a linear axis."""
    return OutputServices("left", port, uses={"tool_exchange": 3, "linear_axis": 7})


def on(cell: Served) -> list[int]:
    """The numbers of the outputs that the topic says are on."""
    latest = cell.bus.topic("left/digital_outputs", DigitalOutputs).latest
    assert latest is not None
    assert len(latest.values) == 10
    return [number for number, value in enumerate(latest.values) if value]


@pytest.mark.virtual
async def test_an_output_is_set_by_its_number_and_by_what_hangs_on_it() -> None:
    """RCL tables 10 and 11: success and a message; the topic has all of them."""
    port = SimOutputPort("left", count=10)
    async with served(outputs=outputs(port)) as cell:
        assert on(cell) == []
        by_number = await cell.bus.call(SetOutput(output=9, value=True), to="left")
        by_name = await cell.bus.call(SetToolExchange(value=True), to="left")
        await cell.bus.call(SetLinearAxis(value=True), to="left")
        assert on(cell) == [3, 7, 9]
        await cell.bus.call(SetOutput(output=3, value=False), to="left")
        assert on(cell) == [7, 9]
    assert by_number == SwitchResult(success=True, message="output 9 is on")
    assert by_name == SwitchResult(success=True, message="tool exchange (output 3) is on")


@pytest.mark.virtual
async def test_an_output_that_is_not_there_is_not_set_and_the_message_says_which_are() -> None:
    """As the document has it: not an error of the bus."""
    async with served(outputs=outputs(SimOutputPort("left", count=10))) as cell:
        answer = await cell.bus.call(SetOutput(output=10, value=True), to="left")
        assert (answer.success, on(cell)) == (False, [])
    assert "there is no output 10" in answer.message
    assert "0 to 9" in answer.message


@pytest.mark.virtual
async def test_only_what_the_cell_names_has_a_service() -> None:
    """No gripper hangs on an output here, and an arm without outputs has none of them."""
    async with served(outputs=outputs(SimOutputPort("left", count=10))) as cell:
        with pytest.raises(NoSuchSkill):
            await cell.bus.call(SetGripper(value=True), to="left")
    async with served() as cell:
        with pytest.raises(NoSuchSkill):
            await cell.bus.call(SetOutput(output=0, value=True), to="left")


@pytest.mark.virtual
async def test_outputs_are_refused_to_others_while_a_run_holds_the_arm() -> None:
    """The tool exchange of a moving arm is not for passers-by."""
    async with served(outputs=outputs(SimOutputPort("left", count=10))) as cell:
        cell.bus.leases.acquire(("left",), Holder("run-1"))
        with pytest.raises(LeaseRefused):
            await cell.bus.call(SetToolExchange(value=True), to="left")
        assert on(cell) == []


def test_a_device_on_an_output_follows_it() -> None:
    """At once, and only at changes."""
    port = SimOutputPort("left", count=2)
    told: list[bool] = []
    port.wire(1, told.append)
    for output, value in ((1, True), (1, True), (0, True), (1, False)):
        port.set(output, on=value)
    assert told == [False, True, False]
