"""An emulated FR3 as a program of its own, and the arm's driver on it."""

from __future__ import annotations

import asyncio
import json
import subprocess
from collections.abc import AsyncGenerator, Generator
from contextlib import asynccontextmanager, contextmanager
from importlib.util import find_spec

import msgspec
import numpy as np
import pytest

from engine.cell.drivers import DeviceReport
from engine.messages import Pose
from robots.drivers.arm.arm_process_messages import OpenController
from robots.drivers.arm.process_arm_connection import NewStopLine, ProcessArmConnection
from robots.drivers.franka.franka_options import FrankaOptions
from robots.model.registry import robot_model
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.own_address import own_address
from tests.robots.sim.sim_cell import PATIENT_S, until

FR3 = ArmPlacement(name="arm", model="fr3", base=Pose(xyz=(0.0, 0.0, 0.0)), gripper=None)
FR3_MODEL = robot_model("fr3", gripper=None)
FR3_START: Array = np.array((0.0, 0.0, 0.0, -1.57, 0.0, 1.57, 0.785))
"""Where the emulated arm stands when it is switched on."""
FR3_NEAR: Array = FR3_START + np.array((0.2, 0.1, -0.1, 0.0, 0.1, 0.2, 0.1))
FR3_FAR: Array = FR3_START + np.array((1.4, 0.2, -0.2, 0.0, 0.0, 0.0, 0.0))
needs_franka = pytest.mark.skipif(
    find_spec("pylibfranka") is None or find_spec("franky_sim") is None,
    reason="pylibfranka and franky-sim are not installed: they have wheels for Linux x86-64 with glibc 2.34 or newer",
)
# A loaded machine may keep a process waiting for seconds; what is to be noticed sooner says so.
PATIENT_OPTIONS = {"real_time": "ignore", "stale_s": 5.0, "process_silence_s": 10.0, "path_tolerance_rad": 0.4}


@contextmanager
def emulated_cabinet(**options: object) -> Generator[EmulatedProcess]:
    """Start an emulator on a loopback address of its own; the simulated robot behind it has another."""
    host = own_address()
    given = [f"host={host}", *(f"{name}={str(value).lower()}" for name, value in options.items())]
    with subprocess.Popen([FLEXCELL, "emulate", "franka", *given], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            place = json.loads(process.stdout.readline())["ready"]
            yield EmulatedProcess(place=place, process=process, side_host=host)
        finally:
            process.terminate()
            process.wait(30.0)


def new_fr3_connection(
    host: str, *, new_stop_line: NewStopLine | None = None, engine_silence_s: float = PATIENT_S, **options: object
) -> ProcessArmConnection:
    """Return the connection to an emulated robot, not yet open."""
    given = msgspec.convert({"kind": "franka", "host": host, **PATIENT_OPTIONS, **options}, FrankaOptions)
    request = OpenController(
        arm=FR3,
        controller="robots.drivers.franka.franka_joint_controller:new_franka_controller",
        options=msgspec.json.encode(given),
        stale_s=given.stale_s,
        engine_silence_s=engine_silence_s,
    )
    return ProcessArmConnection(
        request,
        model=FR3_MODEL,
        address=host,
        about=DeviceReport(device="arm", driver="franka", address=host),
        silence_s=given.process_silence_s,
        new_stop_line=new_stop_line,
        outputs=0,
    )


@asynccontextmanager
async def connected_fr3(
    cabinet: EmulatedProcess, *, new_stop_line: NewStopLine | None = None, **options: object
) -> AsyncGenerator[ProcessArmConnection]:
    """Return an open connection; it is closed afterwards."""
    silence_s = options.pop("engine_silence_s", PATIENT_S)
    assert isinstance(silence_s, float)
    host = str(cabinet.place["host"])
    connection = new_fr3_connection(host, new_stop_line=new_stop_line, engine_silence_s=silence_s, **options)
    await connection.open()
    try:
        # A simulated robot holds where it stands when its client changes, and sags a little again.
        await until(lambda: bool((np.abs(connection.sample().velocity_rad_s) < 0.005).all()))
        yield connection
    finally:
        await connection.close()
        await asyncio.to_thread(cabinet.do, "wait", until="free")


async def measured(connection: ProcessArmConnection) -> None:
    """Return once the arm was measured again."""
    readings = connection.state().readings
    await until(lambda: connection.state().readings > readings + 3)
