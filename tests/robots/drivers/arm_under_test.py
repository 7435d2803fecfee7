"""Arms behind the same port, simulated and real with its emulator, for the tests that all of them pass."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable
from contextlib import AbstractContextManager, asynccontextmanager
from dataclasses import dataclass, field

import msgspec
import numpy as np
import pytest

from engine.cell.drivers import DeviceReport
from engine.messages import Pose, Vector3
from robots.drivers.arm.arm_process_messages import OpenController
from robots.drivers.arm.process_arm_connection import NewStopLine, ProcessArmConnection
from robots.drivers.universal_robots.new_universal_robot import CONTROLLERS
from robots.drivers.universal_robots.ur_dashboard import ask_dashboard
from robots.drivers.universal_robots.ur_options import UrOptions
from robots.model.registry import robot_model
from robots.model.robot_model import RobotModel
from robots.port import ArmPort, Array, JointTrajectory, MotionEnd, MotionReport, Tolerance
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.drivers.abb.emulated_irc5 import EmulatedIrc5
from tests.robots.drivers.abb.emulated_irc5 import emulated as emulated_irc5
from tests.robots.drivers.abb.guided_irc5 import GUIDED_FAR, GUIDED_MODEL, GUIDED_NEAR, GUIDED_START, guided
from tests.robots.drivers.emulated_device import EmulatedProcess, Emulators
from tests.robots.drivers.franka.emulated_cabinet import (
    FR3_FAR,
    FR3_MODEL,
    FR3_NEAR,
    FR3_START,
    connected_fr3,
    emulated_cabinet,
    needs_franka,
)
from tests.robots.drivers.universal_robots.client_library import needs_client_library
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController
from tests.robots.sim.sim_cell import PATIENT_S, smooth, until

UR10 = ArmPlacement(name="arm", model="ur10", base=Pose(xyz=(0.0, 0.0, 0.0)), gripper=None)
MODEL = robot_model("ur10", gripper=None)
START: Array = np.array((0.0, -np.pi / 2, np.pi / 2, -np.pi / 2, -np.pi / 2, 0.0))
"""Where the emulated arm stands when it is switched on."""
NEAR: Array = START + np.array((0.3, 0.1, -0.1, 0.0, 0.1, 0.2))
FAR: Array = START + np.array((1.6, 0.2, -0.2, 0.0, 0.0, 0.0))
WIDE = Tolerance(path_rad=0.4)
"""Set points are followed later by the lookahead, and late on a loaded machine."""
ARMS = (
    pytest.param("simulated", id="simulated"),
    pytest.param("ur_rtde", id="ur_rtde", marks=needs_client_library),
    pytest.param("script", id="script"),
    pytest.param("franka", id="franka", marks=needs_franka),
)
FOLLOWERS = (*ARMS[:-1], pytest.param("egm", id="egm"), ARMS[-1])
"""With those that measure no contact."""
CLIENTS = ARMS[1:3]
"""Both clients of the driver `universal_robots`."""
# A loaded machine may keep a process waiting for seconds; what is to be noticed sooner says so.
PATIENT = {"stale_s": 5.0, "watchdog_hz": 1.0, "process_silence_s": 10.0}


@dataclass(frozen=True, kw_only=True)
class ArmUnderTest:
    """One arm that may move; `push` has the environment push its tool, in world axes."""

    port: ArmPort
    push: Callable[[Vector3], object]
    model: RobotModel = MODEL
    start: Array = field(default_factory=lambda: START)
    near: Array = field(default_factory=lambda: NEAR)
    far: Array = field(default_factory=lambda: FAR)

    async def move(self, goal: Array, duration_s: float = 1.0) -> MotionReport:
        """Go to joint angles and return the report."""
        return await self.port.follow(self.path(goal, duration_s), tolerance=WIDE).report()

    def path(self, goal: Array, duration_s: float = 1.0) -> JointTrajectory:
        """Return a smooth path from the set point."""
        return smooth(np.asarray(self.port.sample().desired_rad), goal, duration_s, limits=self.model.limits)

    async def settled(self) -> Array:
        """Return the measured joints, once they rest."""
        await until(lambda: bool((np.abs(self.port.sample().velocity_rad_s) < 0.01).all()))
        return np.array(self.port.sample().position_rad)


def new_connection(
    host: str, *, new_stop_line: NewStopLine | None = None, engine_silence_s: float = PATIENT_S, **options: object
) -> ProcessArmConnection:
    """Return the connection to an emulated controller, not yet open."""
    given = msgspec.convert({"kind": "universal_robots", "host": host, **PATIENT, **options}, UrOptions)
    request = OpenController(
        arm=UR10,
        controller=CONTROLLERS[given.client],
        options=msgspec.json.encode(given),
        stale_s=given.stale_s,
        engine_silence_s=engine_silence_s,
    )
    return ProcessArmConnection(
        request,
        model=MODEL,
        address=host,
        about=DeviceReport(device="arm", driver="universal_robots", address=host),
        silence_s=given.process_silence_s,
        new_stop_line=new_stop_line,
        stop_past_process=lambda: ask_dashboard(host, "stop", limit_s=1.0),
    )


@asynccontextmanager
async def connected(
    controller: EmulatedController, *, new_stop_line: NewStopLine | None = None, **options: object
) -> AsyncGenerator[ProcessArmConnection]:
    """Return an open connection; it is closed afterwards."""
    silence_s = options.pop("engine_silence_s", PATIENT_S)
    assert isinstance(silence_s, float)
    connection = new_connection(controller.host, new_stop_line=new_stop_line, engine_silence_s=silence_s, **options)
    await connection.open()
    try:
        yield connection
    finally:
        await connection.close()


@asynccontextmanager
async def arm_under_test(kind: str, emulators: Emulators, *, series: str = "cb3") -> AsyncGenerator[ArmUnderTest]:
    """Return an arm at rest at its `start` that may move; `emulators` are those that outlive a test."""
    if kind == "simulated":
        scene = SimScene(arms=(UR10,), engine_silence_s=PATIENT_S, world_silence_s=PATIENT_S)
        async with SimWorld(scene, host=ProcessHost(scene)) as world:
            arm = ArmUnderTest(
                port=world.arm("arm"),
                # For longer than a motion and its settling: an arm that is let go swings back.
                push=lambda force_n: world.push("arm/tool0", force_n=force_n, duration_s=3.0),
            )
            await arm.move(START)
            yield arm
        return
    if kind == "franka":
        cabinet = emulators.of(kind)
        cabinet.do("force", force_n=None)
        async with connected_fr3(cabinet) as connection:
            await connection.enable()
            fr3 = ArmUnderTest(
                port=connection.port,
                push=lambda force_n: cabinet.do("force", force_n=[*force_n, 0.0, 0.0, 0.0]),
                model=FR3_MODEL,
                start=FR3_START,
                near=FR3_NEAR,
                far=FR3_FAR,
            )
            assert (await fr3.move(FR3_START)).end is MotionEnd.REACHED
            yield fr3
        return
    if kind == "egm":
        irc5 = emulators.of(kind)
        assert isinstance(irc5, EmulatedIrc5)
        async with guided(irc5) as guided_arm:
            egm = ArmUnderTest(
                port=guided_arm.port,
                push=lambda _force_n: None,
                model=GUIDED_MODEL,
                start=GUIDED_START,
                near=GUIDED_NEAR,
                far=GUIDED_FAR,
            )
            assert (await egm.move(GUIDED_START)).end is MotionEnd.REACHED
            yield egm
        return
    with EmulatedController(series=series) as controller:
        async with connected(controller, client=kind) as connection:
            await connection.enable()

            def push(force_n: Vector3) -> None:
                # The controller's base is half a turn off the base link.
                x, y, z = force_n
                controller.ask("force", force_n=[-x, -y, z, 0.0, 0.0, 0.0])

            yield ArmUnderTest(port=connection.port, push=push)


def lasting_emulators() -> Emulators:
    """Return the emulators that serve all tests of a file: those that start slowly."""

    def start(kind: str) -> AbstractContextManager[EmulatedProcess]:
        return emulated_irc5(egm=True, comm_timeout_s=5.0) if kind == "egm" else emulated_cabinet()

    return Emulators(start)
