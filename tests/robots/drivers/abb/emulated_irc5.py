"""An emulated IRC5 as a program of its own, its side channel, and the driver on it."""

from __future__ import annotations

import json
import subprocess
from collections.abc import AsyncGenerator, Generator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass
from typing import Any

import msgspec
import numpy as np

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.messages import Pose
from robots.arm import ArmServer
from robots.arm.services.output_services import OutputServices
from robots.drivers.abb.abb_connection import AbbConnection
from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.new_abb_irc5 import new_abb_irc5
from robots.drivers.arm.arm_connection import ArmConnection
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.model import RobotModel, robot_model
from robots.port import Array, JointTrajectory, Tolerance
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.emulated_gripper import EmulatedProcess
from tests.robots.own_address import own_address

ARM = "arm"
HOME = (0.0, 0.0, 0.0, 0.0, 0.5, 0.0)
TOLERANCE = Tolerance(path_rad=0.05, goal_rad=0.005)
EGM_PORT = 6510


@dataclass
class EmulatedIrc5(EmulatedProcess):
    """One running emulator."""

    def driver_options(self, **options: object) -> AbbOptions:
        """Return the options of the driver; a loaded machine gets more time than a cell by default."""
        ports = {key: self.place[key] for key in ("motion_port", "state_port")}
        given = {"kind": "abb_irc5", "host": self.place["host"], **ports, "stale_s": 1.0, "timeout_s": 1.0, **options}
        return msgspec.convert(given, AbbOptions)

    def gripper(self, **options: object) -> dict[str, Any]:
        """Return the options of its gripper."""
        return {"port": self.place["gripper_port"], **options}

    @property
    def axes(self) -> Array:
        """Where its axes are."""
        return np.array(self.do("state")["joints_rad"])


@contextmanager
def emulated(*, egm: bool = False, **options: object) -> Generator[EmulatedIrc5]:
    """Start an emulator on a loopback address of its own."""
    host = own_address()
    given = [f"egm_client={host}:{EGM_PORT}"] if egm else []
    given += [f"host={host}", *(f"{name}={value}" for name, value in options.items())]
    with subprocess.Popen([FLEXCELL, "emulate", "abb_irc5", *given], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            place = json.loads(process.stdout.readline())["ready"]
            yield EmulatedIrc5(place=place, process=process, side_host=host)
        finally:
            process.terminate()
            process.wait(20.0)


@asynccontextmanager
async def connected(
    emulator: EmulatedIrc5,
    *,
    enable: bool = True,
    model: RobotModel | None = None,
    engine_silence_s: float = 1.0,
    capture: WireCapture = NO_CAPTURE,
    **options: object,
) -> AsyncGenerator[AbbConnection]:
    """The driver on an emulator, which an operator has made ready before; a loaded machine may be silent longer."""
    emulator.do("restore")
    emulator.do("go_on")
    connection = new_abb_irc5(
        emulator.driver_options(**options),
        name=ARM,
        clock=new_clock(),
        model=model or robot_model("irb4600"),
        engine_silence_s=engine_silence_s,
        capture=capture,
    )
    await connection.open()
    try:
        while emulator.do("state")["in_motion"]:
            await connection.report(readings=1)
        if enable:
            await connection.enable()
        yield connection
    finally:
        await connection.close()


@asynccontextmanager
async def served(emulator: EmulatedIrc5, **options: Any) -> AsyncGenerator[tuple[SkillBus, AbbConnection]]:
    """The driver behind the server of arms, with its skills on a bus."""
    model = robot_model("irb4600")
    async with connected(emulator, model=model, **options) as connection:
        device: ArmConnection = connection
        outputs = device.outputs
        arm = ArmServer(
            name=ARM,
            model=model,
            base=Pose(xyz=(0.0, 0.0, 0.0)),
            port=device.port,
            clock=new_clock(),
            outputs=OutputServices(ARM, outputs, uses={"gripper": 0}) if outputs is not None else None,
        )
        async with SkillBus(new_clock()) as bus, arm:
            arm.register(bus)
            yield bus, connection


def straight(start: Array, goal: Array, *, duration_s: float, dt_s: float = 0.01) -> JointTrajectory:
    """Return a straight trajectory of joints, at rest at both ends."""
    share = np.linspace(0.0, 1.0, round(duration_s / dt_s) + 1)
    eased = (3.0 * share**2 - 2.0 * share**3)[:, None]
    position = start + eased * (goal - start)
    return JointTrajectory(dt_s=dt_s, position_rad=position, velocity_rad_s=np.gradient(position, dt_s, axis=0))
