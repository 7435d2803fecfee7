"""An emulated Robotiq gripper as a program of its own, its side channel, and the driver on it."""

from __future__ import annotations

import json
import os
import socket
import subprocess
from collections.abc import AsyncGenerator, Generator
from contextlib import ExitStack, asynccontextmanager, contextmanager
from dataclasses import dataclass
from itertools import count
from typing import Any, Self

import msgspec

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.skills.devices import EnableDevice
from robots.drivers.device_transport import WireTrace
from robots.drivers.robotiq.new_robotiq import new_robotiq
from robots.drivers.robotiq.robotiq_gripper import RobotiqGripper
from robots.drivers.robotiq.robotiq_options import RobotiqOptions
from tests.engine.cli.command import FLEXCELL

CONNECTIONS = ("modbus_tcp", "rtu_over_tcp", "urcap", "serial")
HAND = "left/gripper"
_HOSTS = count(2)


@dataclass
class EmulatedProcess:
    """One running emulator."""

    place: dict[str, Any]
    process: subprocess.Popen[str]

    @property
    def connection(self) -> dict[str, Any]:
        """`connection` in the options of the driver."""
        keys = ("host", "port", "device")
        return {"kind": self.place["connection"]} | {key: self.place[key] for key in keys if key in self.place}

    def do(self, what: str, **values: object) -> dict[str, Any]:
        """Execute a request on the side channel and return its answer."""
        host = str(self.place.get("host", "127.0.0.1"))
        with socket.create_connection((host, self.place["side_port"]), timeout=20.0) as side:
            side.sendall(json.dumps({"do": what, **values}).encode() + b"\n")
            answer: dict[str, Any] = json.loads(side.makefile().readline())
        assert "error" not in answer, answer
        return answer

    def options(self, **options: object) -> RobotiqOptions:
        """Return the options of the driver; a loaded machine gets more time than a cell by default."""
        given = {"kind": "robotiq", "connection": self.connection, "stale_s": 1.0, "timeout_s": 0.4, **options}
        return msgspec.convert(given, RobotiqOptions)


@contextmanager
def emulated(connection: str, *, object_m: float | None = None, active: bool = True) -> Generator[EmulatedProcess]:
    """Start an emulator on a loopback address of its own."""
    # All of 127/8 is this machine; a pty has no address, and its side channel a free port of the usual one.
    host = f"127.{20 + os.getpid() % 200}.{next(_HOSTS) % 250 + 1}.1"
    given = [f"connection={connection}", f"active={str(active).lower()}", "activation_s=0.3"]
    given += [f"host={host}"] if connection != "serial" else []
    given += [f"object_m={object_m}"] if object_m is not None else []
    with subprocess.Popen([FLEXCELL, "emulate", "robotiq", *given], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            yield EmulatedProcess(place=json.loads(process.stdout.readline())["ready"], process=process)
        finally:
            process.terminate()
            process.wait(20.0)


class Emulators:
    """One emulator a connection, started at its first use, activated and without a fault of the wire."""

    def __init__(self) -> None:
        self._stack = ExitStack()
        self._started: dict[str, EmulatedProcess] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()

    def of(self, connection: str) -> EmulatedProcess:
        """Return the emulator of a connection."""
        if connection not in self._started:
            self._started[connection] = self._stack.enter_context(emulated(connection))
        return self._started[connection]


@asynccontextmanager
async def driven(
    emulator: EmulatedProcess, *, enable: bool = False, trace: WireTrace | None = None, **options: float
) -> AsyncGenerator[tuple[SkillBus, RobotiqGripper]]:
    """The driver on an emulator, with its skills on a bus."""
    async with SkillBus(new_clock()) as bus:
        device = new_robotiq(emulator.options(**options), name=HAND, clock=bus.clock, trace=trace)
        async with device:
            device.register(bus)
            if enable:
                await bus.call(EnableDevice(reason="a test"), to=HAND)
            yield bus, device
