"""An independent client, pyrobotiqgripper, drives the emulator: not only we take it for a gripper."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.emulated_gripper import emulated

WITNESSES = "FLEXCELL_WITNESSES"
"""Folder with the foreign client: `pip install --no-deps --target FOLDER pyrobotiqgripper==3.3.14`."""
SCRIPT = """
import json
from pyrobotiqgripper import RobotiqGripper
gripper = RobotiqGripper({arguments})
gripper.activate()
gripper.start()
gripper.open()
seen = [(gripper.position(), gripper.objectDetection())]
gripper.close()
seen.append((gripper.position(), gripper.objectDetection()))
gripper.open()
gripper.move(100)
seen.append((gripper.position(), gripper.objectDetection()))
gripper.disconnect()
print(json.dumps(seen))
"""


def witnessed(emulator: EmulatedProcess, arguments: str) -> list[list[int]]:
    """Return what the foreign client sees, in a process of its own; skips where it is not installed."""
    folder = os.environ.get(WITNESSES, "")
    if not folder or not (Path(folder) / "pyrobotiqgripper").is_dir():
        pytest.skip(f"{WITNESSES} names no folder with pyrobotiqgripper 3.3.14")
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT.format(arguments=arguments)],
        env=os.environ | {"PYTHONPATH": folder},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.nightly
@pytest.mark.parametrize("connection", ["serial", "rtu_over_tcp"])
def test_a_foreign_client_activates_the_emulator_moves_it_and_sees_the_object(connection: str) -> None:
    with emulated(connection, object_m=0.0427, active=False) as emulator:
        place = emulator.place
        arguments = (
            f"{str(place['device'])!r}"
            if connection == "serial"
            else f"connection_type='RTU_VIA_TCP', tcp_host={str(place['host'])!r}, tcp_port={place['port']}"
        )
        opened, closed, moved = witnessed(emulator, arguments)
        assert opened == [3, 3]
        assert closed == [116, 2]
        assert moved == [100, 3]
        assert emulator.do("state")["active"] is True
