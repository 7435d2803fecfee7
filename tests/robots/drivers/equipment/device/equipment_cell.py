"""A cell with equipment whose server runs in this process, and what happens in it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.document import load_cell, with_simulated_devices
from engine.skills.digital_inputs import DigitalInputs
from engine.skills.digital_outputs import DigitalOutputs, SetOutput
from engine.skills.switch_result import SwitchResult
from tests.robots.drivers.equipment.served_equipment import SIMULATED

VICE = "vice"
CELL = """\
flexcell: 1
cell: bench
equipment:
  vice: {driver: {kind: equipment, host: HOST, port: PORT}, pins: clamps.yaml}
"""


def written(folder: Path, *, host: str = "127.0.0.1", port: int, pins: str = SIMULATED) -> Path:
    """Write the cell and its equipment document, and return the cell."""
    (folder / "clamps.yaml").write_text(pins, encoding="utf-8")
    (folder / "cell.yaml").write_text(CELL.replace("HOST", host).replace("PORT", str(port)), encoding="utf-8")
    return folder / "cell.yaml"


@asynccontextmanager
async def opened(file: Path, *, simulate: tuple[str, ...] = ()) -> AsyncGenerator[OpenCell]:
    """Open a cell."""
    async with OpenCell(with_simulated_devices(load_cell(file), simulate)) as cell:
        yield cell


async def switched(bus: SkillBus, name: str, *, on: bool) -> SwitchResult:
    """Set an output of the vice."""
    return await bus.call(SetOutput(name=name, value=on), to=VICE)


def outputs(bus: SkillBus) -> dict[str, bool]:
    """Return the outputs by name."""
    latest = bus.topic(f"{VICE}/digital_outputs", DigitalOutputs).latest
    assert latest is not None
    return {name: latest.values[number] for name, number in latest.names.items()}


def inputs(bus: SkillBus) -> DigitalInputs:
    """Return the last message of the inputs."""
    latest = bus.topic(f"{VICE}/digital_inputs", DigitalInputs).latest
    assert latest is not None
    return latest


async def until(condition: Callable[[], Any], *, at_most_s: float = 20.0) -> None:
    """Wait for a condition that other tasks or threads bring about."""
    async with asyncio.timeout(at_most_s):
        # What is read tells nobody that it has changed: it can only be looked at.
        while not condition():  # noqa: ASYNC110
            await asyncio.sleep(0.005)
