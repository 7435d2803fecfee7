"""Emulators of devices as programs of their own, and their side channels."""

from __future__ import annotations

import json
import socket
import subprocess
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from engine.cell.drivers import DeviceContext
from engine.document.cell import load_cell
from tests.engine.cli.command import FLEXCELL
from tests.robots.own_address import own_address

CELL = Path(__file__).parents[3] / "behaviors" / "cells" / "ur10.yaml"


@dataclass
class EmulatedProcess:
    """One running emulator."""

    place: dict[str, Any]
    process: subprocess.Popen[str]
    side_host: str

    @property
    def connection(self) -> dict[str, Any]:
        """Where it is, and over which connection, as `connection` in the options of a driver."""
        keys = ("host", "port", "device")
        return {"kind": self.place["connection"]} | {key: self.place[key] for key in keys if key in self.place}

    @property
    def serial_device(self) -> str:
        """Where it is, as `device` in the options of a driver with a serial line."""
        if "device" in self.place:
            return str(self.place["device"])
        return f"socket://{self.place['host']}:{self.place['port']}"

    def do(self, what: str, **values: object) -> dict[str, Any]:
        """Execute a request on the side channel and return its answer."""
        with socket.create_connection((self.side_host, self.place["side_port"]), timeout=20.0) as side:
            side.sendall(json.dumps({"do": what, **values}).encode() + b"\n")
            answer: dict[str, Any] = json.loads(side.makefile().readline())
        assert "error" not in answer, answer
        return answer


@contextmanager
def emulated_device(kind: str, connection: str = "", **options: object) -> Generator[EmulatedProcess]:
    """Start an emulator on a loopback address of its own."""
    # All of 127/8 is this machine; a pty has no address, and its side channel a free port of the usual one.
    host = own_address()
    given = [f"{name}={str(value).lower() if isinstance(value, bool) else value}" for name, value in options.items()]
    given += [f"connection={connection}"] if connection else []
    side_host = str(options.get("host", host if connection != "serial" else "127.0.0.1"))
    given += [f"host={side_host}"] if "host" not in options else []
    with subprocess.Popen([FLEXCELL, "emulate", kind, *given], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            place = json.loads(process.stdout.readline())["ready"]
            yield EmulatedProcess(place=place, process=process, side_host=side_host)
        finally:
            process.terminate()
            process.wait(20.0)


def tool_context(capture: Path | None = None) -> DeviceContext:
    """The surroundings of a tool; its cell does not matter."""
    return DeviceContext(cell=load_cell(CELL), robot="left", capture=capture)


def replayed(capture: Path, *, pace: float = 0.0, **options: str) -> AbstractContextManager[EmulatedProcess]:
    """Start the replay of a capture; unless said otherwise without the delays."""
    return emulated_device("replay", connection="", file=capture, pace=pace, **options)


class Emulators:
    """One emulator a connection, started at its first use."""

    def __init__(self, start: Callable[[str], AbstractContextManager[EmulatedProcess]]) -> None:
        self._start = start
        self._stack = ExitStack()
        self._started: dict[str, EmulatedProcess] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self._stack.close()

    def of(self, connection: str) -> EmulatedProcess:
        """Return the emulator of a connection."""
        if connection not in self._started:
            self._started[connection] = self._stack.enter_context(self._start(connection))
        return self._started[connection]
