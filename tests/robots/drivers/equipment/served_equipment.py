"""An equipment server as a program of its own, a client of it that can be frozen, and a PLC."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.engine.cli.command import FLEXCELL
from tests.robots.own_address import own_address

PINS = """
pins:
  clamp: {kind: digital_output, pin: 17, safe: true, active_low: true}
  valve: {kind: digital_output, pin: 22, safe: false, at_stop: safe}
  there: {kind: digital_input, pin: 27}
"""
SIMULATED = "flexcell: 1\nequipment: clamps\nbackend: {kind: simulated}\n" + PINS
CLIENT = """
import sys, time
from robots.drivers.equipment.wire.equipment_client import connected
host, port = sys.argv[1], int(sys.argv[2])
with connected(host, port, name="doomed", control=True) as client:
    client.set({"clamp": False, "valve": True})
    print(client.read().values, flush=True)
    while True:
        client.read()
        time.sleep(0.02)
"""


@dataclass
class ServedEquipment:
    """A running server."""

    host: str
    port: int
    process: subprocess.Popen[str]


@contextmanager
def served_equipment(file: Path, *, host: str = "", port: int = 0) -> Generator[ServedEquipment]:
    """Serve a file; the program is ended by SIGTERM."""
    command = [FLEXCELL, "equipment", "serve", str(file), "--host", host or own_address(), "--port", str(port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            place = json.loads(process.stdout.readline())["ready"]
            yield ServedEquipment(host=place["host"], port=place["port"], process=process)
        finally:
            process.terminate()
            process.wait(20.0)


@contextmanager
def doomed_client(server: ServedEquipment) -> Generator[subprocess.Popen[str]]:
    """Start a client that has opened the clamp and the valve, and goes on being alive."""
    command = [sys.executable, "-c", CLIENT, server.host, str(server.port)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert "'clamp': False" in process.stdout.readline()
            yield process
        finally:
            process.kill()


def waited_for(condition: Callable[[], bool], *, at_most_s: float = 20.0) -> bool:
    """Return whether a condition comes true."""
    end_s = time.monotonic() + at_most_s
    while time.monotonic() < end_s:
        if condition():
            return True
        time.sleep(0.005)
    return False
