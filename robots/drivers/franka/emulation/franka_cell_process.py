"""The cabinets of the Franka arms of a cell in a process of their own, whose event loop has nothing else to do."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Callable, Mapping

import msgspec

from engine.errors import CellError
from engine.messages import Pose
from robots.drivers.franka.emulation.simulator_messages import (
    FrankaCellReady,
    FrankaCellSetup,
    SimulatorInput,
    SimulatorReport,
)
from robots.scene.sim_scene import SimScene

_MAIN = "from robots.drivers.franka.emulation.franka_cell_main import main; main()"
_REPORT_STEPS = 20
_END_S = 10.0


class FrankaCellProcess:
    """One process, used once.

    Args:
        hosts: Address of the cabinet of each arm.
        scene: The cell; its other arms are not there.
    """

    def __init__(self, hosts: Mapping[str, str], scene: SimScene) -> None:
        self._setup = FrankaCellSetup(hosts=dict(hosts), scene=scene, report_steps=_REPORT_STEPS)
        self._process: asyncio.subprocess.Process | None = None

    @property
    def arms(self) -> tuple[str, ...]:
        """The names of the arms, in the order of the reports."""
        return tuple(self._setup.hosts)

    @property
    def process_id(self) -> int:
        """The id of the process, 0 while there is none."""
        return self._process.pid if self._process is not None else 0

    async def open(self) -> dict[str, dict[str, str | int]]:
        """Start it and return where the cabinets listen, by the name of the arm; raises CellError or OSError."""
        setup = msgspec.json.encode(self._setup).decode()
        self._process = process = await asyncio.create_subprocess_exec(
            sys.executable, "-c", _MAIN, setup, stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE
        )
        ready = msgspec.json.decode(await self._line(process), type=FrankaCellReady)
        if ready.number is not None:
            raise OSError(ready.number, ready.refused)
        if ready.refused:
            raise CellError(ready.refused, hint=ready.hint)
        return ready.places

    async def read(self, listener: Callable[[SimulatorReport], None]) -> None:
        """Call `listener` with each report until cancelled; raises CellError when the process ends."""
        assert self._process is not None
        while True:
            listener(msgspec.json.decode(await self._line(self._process), type=SimulatorReport))

    def keep(self, parts: Mapping[str, Pose | None]) -> None:
        """Keep parts where this world has them, and free those with None."""
        assert self._process is not None
        assert self._process.stdin is not None
        self._process.stdin.write(msgspec.json.encode(SimulatorInput(parts=dict(parts))) + b"\n")

    async def close(self) -> None:
        """End it, if it runs."""
        process, self._process = self._process, None
        if process is None:
            return
        assert process.stdin is not None
        process.stdin.close()
        try:
            await asyncio.wait_for(process.wait(), _END_S)
        except TimeoutError:
            process.kill()
            await process.wait()

    async def _line(self, process: asyncio.subprocess.Process) -> bytes:
        assert process.stdout is not None
        line = await process.stdout.readline()
        if not line:
            raise CellError(f"the cabinets have ended with {await process.wait()}", hint="the output above says why")
        return line
