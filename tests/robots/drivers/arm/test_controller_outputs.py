"""The outputs of a real controller: what fails is raised to who confirms it, and reported where nobody does."""

from __future__ import annotations

import asyncio
import logging

import pytest

from engine.errors import RobotError
from robots.drivers.arm.arm_process_messages import FromArmProcess, OutputSet, SetControllerOutput, ToArmProcess
from robots.drivers.arm.controller_outputs import ControllerOutputs


def new_outputs(broken: set[int]) -> ControllerOutputs:
    """Return four outputs, some of which are not set."""

    async def ask(request: ToArmProcess) -> FromArmProcess:
        assert isinstance(request, SetControllerOutput)
        if request.output in broken:
            raise RobotError(f"output {request.output} reads back as off")
        return OutputSet()

    return ControllerOutputs("arm", count=4, values=lambda: (False,) * 4, ask=ask)


async def finished() -> None:
    """Let the requests end: they wait for nothing."""
    for _ in range(5):
        await asyncio.sleep(0)


async def test_an_output_that_is_not_set_is_an_error_of_who_confirms_it() -> None:
    outputs = new_outputs({2})
    outputs.set(1, on=True)
    await outputs.confirmed()
    outputs.set(2, on=True)
    await finished()
    with pytest.raises(RobotError, match="output 2 reads back as off"):
        await outputs.confirmed()
    await outputs.confirmed()


async def test_an_error_that_nobody_confirms_is_reported(caplog: pytest.LogCaptureFixture) -> None:
    outputs = new_outputs({2})
    with caplog.at_level(logging.WARNING, logger="flexcell.devices"):
        outputs.set(1, on=True)
        outputs.set(2, on=True)
        await finished()
    assert [record.getMessage() for record in caplog.records] == ["arm: output 2 reads back as off"]


async def test_what_was_set_last_is_what_is_confirmed() -> None:
    broken = {2}
    outputs = new_outputs(broken)
    outputs.set(2, on=True)
    await finished()
    broken.clear()
    outputs.set(2, on=True)
    await outputs.confirmed()
