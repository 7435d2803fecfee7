"""The process of franky-sim: started with its robots, read where they and the parts are, and ended."""

from __future__ import annotations

import asyncio
import socket
import sys
from collections.abc import Callable
from importlib.util import find_spec

import msgspec

from engine.errors import CellError
from robots.drivers.franka.emulation.simulator_messages import (
    RobotReport,
    RobotSetup,
    SimulatorInput,
    SimulatorReport,
    SimulatorSetup,
)

_MAIN = "from robots.drivers.franka.emulation.simulator_main import main; main()"
_END_S = 5.0
PORTS = (1337, 1338)
"""Of arm and hand."""


class RobotSimulator:
    """One process with robots on addresses; the ports are those of a robot."""

    def __init__(self, setup: SimulatorSetup) -> None:
        self.robots = tuple(SimulatedRobot(self) for _ in setup.robots)
        self.report: SimulatorReport | None = None
        """The last report, whether or not a client is connected."""
        self._setup = setup
        self._listeners: list[Callable[[SimulatorReport], None]] = []
        self._process: asyncio.subprocess.Process | None = None
        self._reading: asyncio.Task[None] | None = None

    async def start(self) -> None:
        """Start it, if it does not run, and return when it listens.

        Raises:
            CellError: franky-sim is not installed, cannot listen, or ends.
        """
        if self._process is not None:
            return
        if find_spec("franky_sim") is None:
            hint = "pip install 'flexcell[franka_sim]': Linux x86-64"
            raise CellError("the emulator of a Franka needs the package franky-sim", hint=hint)
        for robot in self._setup.robots:
            for port in PORTS:
                _check_free(robot.host, port)
        setup = msgspec.json.encode(self._setup).decode()
        self._process = process = await asyncio.create_subprocess_exec(
            sys.executable, "-c", _MAIN, setup, stdin=asyncio.subprocess.PIPE, stdout=asyncio.subprocess.PIPE
        )
        assert process.stdout is not None
        line = await process.stdout.readline()
        if not line:
            code = await process.wait()
            hint = "its own output above says why"
            raise CellError(f"franky-sim has ended with {code} before it was ready", hint=hint)
        self._take(line, after_s=0.0)
        self._reading = asyncio.create_task(self._read(process.stdout))

    def each_report(self, listener: Callable[[SimulatorReport], None]) -> None:
        """Call `listener` with each report from now on."""
        self._listeners.append(listener)

    def place_object(self, width_m: float) -> None:
        """Put a box of this width between the fingers, 0 for none; in a scene there are parts instead."""
        if self._setup.scene is not None:
            raise ValueError("its fingers are in a cell: put a part between them there")
        self.change(SimulatorInput(object_m=width_m))

    def change(self, given: SimulatorInput) -> None:
        """Send it what is to be changed; raises CellError where it does not run."""
        process = self._process
        if process is None or process.stdin is None:
            raise CellError("franky-sim does not run", hint="restart the emulator")
        process.stdin.write(msgspec.json.encode(given) + b"\n")

    async def stop(self) -> None:
        """End it, if it runs."""
        process, self._process = self._process, None
        reading, self._reading = self._reading, None
        if reading is not None:
            reading.cancel()
        if process is None or process.returncode is not None:
            return
        process.kill()
        await asyncio.wait_for(process.wait(), _END_S)

    async def _read(self, lines: asyncio.StreamReader) -> None:
        while line := await lines.readline():
            before_s = self.report.time_s if self.report is not None else 0.0
            self._take(line, after_s=before_s)

    def _take(self, line: bytes, *, after_s: float) -> None:
        self.report = report = msgspec.json.decode(line, type=SimulatorReport)
        for robot, each in zip(self.robots, report.robots, strict=True):
            robot.take(each, elapsed_s=report.time_s - after_s)
        for listener in self._listeners:
            listener(report)


class SimulatedRobot:
    """One robot of a process, which it starts and ends."""

    def __init__(self, simulator: RobotSimulator) -> None:
        self.simulator = simulator
        self.width_m = 0.0
        """Opening of the fingers, whether or not a client is connected."""
        self.speed_m_s = 0.0
        self.travel_m = 0.0
        self.joints_rad: tuple[float, ...] = ()
        """Joints of the arm, also while no client is connected; so is the speed of the fastest one."""
        self.fastest_rad_s = 0.0

    def take(self, report: RobotReport, *, elapsed_s: float) -> None:
        """Take a report, and how long the one before was ago in the time of the robot."""
        moved_m = abs(report.width_m - self.width_m)
        if elapsed_s > 0.0:
            self.speed_m_s = moved_m / elapsed_s
            self.travel_m += moved_m
        self.width_m = report.width_m
        self.joints_rad, self.fastest_rad_s = report.position_rad, report.fastest_rad_s


def _check_free(host: str, port: int) -> None:
    """Raise CellError if nothing can listen there; franky-sim says of two addresses only that both are of no use."""
    with socket.socket() as tried:
        tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            tried.bind((host, port))
        except OSError as error:
            hint = "another emulator may be there, `ss -ltnp` names it: end it, or choose another `host`"
            raise CellError(f"franky-sim cannot listen at {host}:{port}: {error.strerror}", hint=hint) from error


def single_robot(host: str) -> SimulatedRobot:
    """Return a robot with a process of its own."""
    (robot,) = RobotSimulator(SimulatorSetup(robots=(RobotSetup(host=host),))).robots
    return robot
