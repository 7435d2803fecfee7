"""The process of the cabinets of a cell whose other devices are emulated by another one: relays set points of 1 kHz.

Its first argument is a `FrankaCellSetup`. Writes lines of JSON: a `FrankaCellReady`, then each `SimulatorReport`. Reads
lines of `SimulatorInput`, and ends with its input.
"""

from __future__ import annotations

import asyncio
import sys

import msgspec

from engine.errors import CellError
from robots.drivers.franka.emulation.franka_cell import FrankaCell
from robots.drivers.franka.emulation.simulator_messages import (
    FrankaCellReady,
    FrankaCellSetup,
    SimulatorInput,
    SimulatorReport,
)


def main() -> None:
    """Serve until the input ends."""
    asyncio.run(_serve(msgspec.json.decode(sys.argv[1], type=FrankaCellSetup)))


async def _serve(setup: FrankaCellSetup) -> None:
    cell = FrankaCell(setup.hosts, setup.scene, report_steps=setup.report_steps)
    try:
        try:
            _write(FrankaCellReady(places=await cell.open()))
        except CellError as error:
            _write(FrankaCellReady(refused=error.message, hint=error.hint or ""))
            return
        except OSError as error:
            _write(FrankaCellReady(refused=error.strerror or str(error), number=error.errno))
            return
        assert cell.simulator.report is not None
        _write(cell.simulator.report)
        cell.simulator.each_report(_write)
        await _take_input(cell)
    finally:
        await cell.close()


async def _take_input(cell: FrankaCell) -> None:
    lines = asyncio.StreamReader()
    await asyncio.get_running_loop().connect_read_pipe(lambda: asyncio.StreamReaderProtocol(lines), sys.stdin)
    while line := await lines.readline():
        cell.simulator.change(msgspec.json.decode(line, type=SimulatorInput))


def _write(message: FrankaCellReady | SimulatorReport) -> None:
    sys.stdout.write(msgspec.json.encode(message).decode() + "\n")
    sys.stdout.flush()
