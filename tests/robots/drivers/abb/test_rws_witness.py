"""An independent client, abb-robot-client, reads and commands the emulator: not only we take it for a controller."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.robots.drivers.abb.emulated_irc5 import EmulatedIrc5, emulated

WITNESSES = "FLEXCELL_WITNESSES"
"""Folder with the foreign client: `pip install --target FOLDER abb-robot-client==0.4.0`."""
RWS = """
import json
from abb_robot_client.rws import RWS
rws = RWS("http://{host}:{port}", "Default User", "robotics")
seen = [rws.get_controller_state(), rws.get_operation_mode(), rws.get_execution_state().ctrlexecstate]
seen.append(sorted(rws.get_tasks()))
seen.append([round(float(value), 3) for value in rws.get_jointtarget().robax])
rws.stop()
seen.append(rws.get_execution_state().ctrlexecstate)
rws.set_controller_state("motoroff")
seen.append(rws.get_controller_state())
rws.set_controller_state("motoron")
rws.resetpp()
rws.start()
seen.append([rws.get_controller_state(), rws.get_execution_state().ctrlexecstate])
try:
    rws.resetpp()
except Exception as error:
    seen.append(type(error).__name__)
seen.append([entry.code for entry in rws.read_event_log()][:1])
signal = dict(signal="diDoor", network="Local", unit="PANEL")
seen.append(rws.get_digital_io(**signal))
rws.set_digital_io(value=1, **signal)
seen.append(rws.get_digital_io(**signal))
print(json.dumps(seen))
"""
EGM = """
import json, time
from abb_robot_client.egm import EGM
egm = EGM({port})
goal, seen, end_s = None, [], time.monotonic() + 30.0
while time.monotonic() < end_s:
    answered, state = egm.receive_from_robot(1.0)
    if not answered:
        continue
    if goal is None:
        goal = state.joint_angles.copy()
        goal[0] += 10.0
        seen = [state.motors_on, state.rapid_running, [round(float(angle), 3) for angle in state.joint_angles]]
    egm.send_to_robot(goal)
    if abs(state.joint_angles[0] - goal[0]) < 0.001:
        break
seen.append([round(float(angle), 3) for angle in state.joint_angles_planned])
print(json.dumps(seen))
"""


def witnessed(script: str) -> Any:
    """Return what the foreign client prints last, in a process of its own; skips where it is not installed."""
    folder = os.environ.get(WITNESSES, "")
    if not folder or not (Path(folder) / "abb_robot_client").is_dir():
        pytest.skip(f"{WITNESSES} names no folder with abb-robot-client 0.4.0")
    done = subprocess.run(
        [sys.executable, "-c", script],
        env=os.environ | {"PYTHONPATH": folder},
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    return json.loads(done.stdout.splitlines()[-1])


@pytest.mark.nightly
def test_a_foreign_client_reads_stops_and_starts_the_controller() -> None:
    with emulated(signals="Local/PANEL/diDoor") as emulator:
        seen = witnessed(RWS.format(host=emulator.place["host"], port=emulator.place["rws_port"]))
        assert seen == [
            "motoron",
            "AUTO",
            "running",
            ["ROS_MotionServer", "T_ROB1"],
            [0.0, 0.0, 0.0, 0.0, 28.648, 0.0],
            "stopped",
            "motoroff",
            ["motoron", "running"],
            "ABBException",
            [10011],
            0,
            1,
        ]
        assert_stopped_and_started(emulator)


def assert_stopped_and_started(emulator: EmulatedIrc5) -> None:
    """Compare with what the emulator says of itself."""
    assert emulator.do("state")["asked"] == ["stop", "motoroff", "motoron", "resetpp", "start", "resetpp"]


@pytest.mark.nightly
def test_a_foreign_client_guides_the_controller() -> None:
    """Its protobuf reads our measurements, and the emulator follows its set points."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    # It listens on all addresses.
    with emulated(egm_client=f"127.0.0.1:{port}", comm_timeout_s=1.0) as emulator:
        motors_on, runs, start_deg, planned_deg = witnessed(EGM.format(port=port))
        assert (motors_on, runs, start_deg) == (True, True, [0.0, 0.0, 0.0, 0.0, 28.648, 0.0])
        assert planned_deg == [10.0, *start_deg[1:]]
        assert emulator.axes[0] == pytest.approx(np.radians(10.0), abs=1e-4)
