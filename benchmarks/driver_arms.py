"""Arms behind one port, simulated and real with their emulators, for the benchmark of drivers."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass

import msgspec
import numpy as np

from benchmarks.driver_figures import Figures, until
from engine.cell.drivers import DeviceReport
from engine.clock import new_clock
from engine.messages import Pose
from robots.drivers.abb.new_abb_irc5 import new_abb_irc5
from robots.drivers.arm.arm_connection import ArmConnection
from robots.drivers.arm.arm_process_messages import OpenController
from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions
from robots.model import robot_model
from robots.model.robot_model import JointLimits
from robots.port import ArmPort, Array, JointTrajectory, Motion, MotionReport, Tolerance
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.drivers.abb.emulated_irc5 import ARM, HOME
from tests.robots.drivers.abb.emulated_irc5 import emulated as emulated_irc5
from tests.robots.drivers.arm_under_test import FAR, MODEL, NEAR, START, UR10, WIDE, connected
from tests.robots.drivers.franka.emulated_cabinet import (
    FR3_FAR,
    FR3_MODEL,
    FR3_NEAR,
    FR3_START,
    connected_fr3,
    emulated_cabinet,
)
from tests.robots.drivers.franka.faulty_fr3 import FaultyFr3
from tests.robots.drivers.servo_arm.emulated_arm import emulated_servo_arm
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController
from tests.robots.sim.sim_cell import smooth

_PATIENT_SILENCE_S = 1.0
_NARROW = Tolerance(path_rad=0.2, goal_rad=0.02)


@dataclass(frozen=True, kw_only=True)
class Link:
    """The link to an emulated device; times are those of the emulator."""

    connection: ArmConnection
    cut: Callable[[], object]
    restore: Callable[[], object]
    time_s: Callable[[], float]
    rest_time_s: Callable[[], float]
    """Waits for rest, in a thread of its own, and returns when the device came to rest."""


@dataclass(frozen=True, kw_only=True)
class Subject:
    """One arm at rest at `start` that may move.

    `beats` returns number and time of its latest measurement; None for an arm without streams. `follows` is whether
    it has a set point that it can be compared with.
    """

    port: ArmPort
    start: Array
    near: Array
    far: Array
    limits: JointLimits
    period_s: float = 0.0
    tolerance: Tolerance = WIDE
    beats: Callable[[], tuple[int, float]] | None = None
    follows: bool = True
    link: Link | None = None

    async def go(self, goal: Array, duration_s: float = 1.0) -> MotionReport:
        """Go to joint angles and wait for the end."""
        report = await self.move(goal, duration_s).report()
        if report.reason:
            raise SystemExit(f"the arm did not reach its goal: {report.reason}")
        return report

    def move(self, goal: Array, duration_s: float) -> Motion:
        """Start a smooth motion from the set point."""
        return self.port.follow(self.path(goal, duration_s), tolerance=self.tolerance)

    def path(self, goal: Array, duration_s: float) -> JointTrajectory:
        """Return a smooth path from the set point."""
        return smooth(np.asarray(self.port.sample().desired_rad), goal, duration_s, limits=self.limits)


@asynccontextmanager
async def simulated() -> AsyncGenerator[Subject]:
    """Yield the simulated arm, in its process and in real time."""
    scene = SimScene(arms=(UR10,), engine_silence_s=_PATIENT_SILENCE_S, world_silence_s=5.0)
    host = ProcessHost(scene)
    async with SimWorld(scene, host=host) as world:
        port = world.arm("arm")

        def beats() -> tuple[int, float]:
            steps = host.timing().steps
            return steps, port.sample().time_s

        subject = _ur10(port, scene.step_s, beats)
        await subject.go(START, 3.0)
        yield subject


@asynccontextmanager
async def universal_robots(series: str) -> AsyncGenerator[Subject]:
    """Yield an emulated Universal Robots arm behind its driver."""
    with EmulatedController(series=series) as controller:
        async with connected(
            controller, engine_silence_s=_PATIENT_SILENCE_S, stale_s=1.0, watchdog_hz=10.0, process_silence_s=2.0
        ) as connection:
            await connection.enable()
            link = Link(
                connection=connection,
                cut=lambda: controller.ask("cut"),
                restore=lambda: controller.ask("restore"),
                time_s=lambda: float(controller.state()["time_s"]),
                rest_time_s=lambda: float(controller.wait("at_rest")["time_s"]),
            )
            yield _ur10(connection.port, 0.002 if series == "e" else 0.008, _readings(connection), link)


@asynccontextmanager
async def abb_irc5() -> AsyncGenerator[Subject]:
    """Yield an emulated IRC5 behind its driver: it is downloaded to, and has no streams and no set points."""
    model, start = robot_model("irb4600"), np.array(HOME)
    with emulated_irc5() as emulator:
        options = emulator.driver_options(stale_s=1.0, timeout_s=1.0)
        connection = new_abb_irc5(
            options, name=ARM, clock=new_clock(), model=model, engine_silence_s=_PATIENT_SILENCE_S
        )
        async with _enabled(connection):
            yield Subject(
                port=connection.port,
                start=start,
                near=start + np.array((0.3, 0.1, -0.1, 0.0, 0.1, 0.2)),
                far=start + np.array((1.6, 0.2, -0.2, 0.0, 0.0, 0.0)),
                limits=model.limits,
                follows=False,
                link=_link(connection, emulator.do, moving="in_motion", rested="rested_s"),
            )


@asynccontextmanager
async def servo_arm() -> AsyncGenerator[Subject]:
    """Yield an emulated board with two servos behind its driver, over a socket as a serial line."""
    model, start = robot_model("servo_arm", gripper=None), np.radians((0.0, 10.0))
    with emulated_servo_arm("tcp") as emulator:
        options = ServoArmOptions(device=emulator.serial_device, stale_s=1.0, process_silence_s=2.0)
        request = OpenController(
            arm=ArmPlacement(name=ARM, model="servo_arm", base=Pose(xyz=(0.0, 0.0, 0.0)), gripper=None),
            controller="robots.drivers.servo_arm.servo_arm_controller:new_servo_arm_controller",
            options=msgspec.json.encode(options),
            stale_s=options.stale_s,
            engine_silence_s=_PATIENT_SILENCE_S,
        )
        connection = ProcessArmConnection(
            request,
            model=model,
            address=options.device,
            about=DeviceReport(device=ARM, driver="servo_arm", address=options.device),
            silence_s=options.process_silence_s,
            new_stop_line=None,
            outputs=1,
        )
        async with _enabled(connection):
            yield Subject(
                port=connection.port,
                start=start,
                near=start + np.array((0.3, -0.2)),
                far=start + np.array((1.2, -0.4)),
                limits=model.limits,
                period_s=options.period_s,
                beats=_readings(connection),
                link=_link(connection, emulator.do, moving="moving", rested="moved_s"),
            )


@asynccontextmanager
async def franka() -> AsyncGenerator[Subject]:
    """Yield an FR3 of franky-sim behind its driver, `pylibfranka` and the proxy; times are those of this machine."""
    with emulated_cabinet() as cabinet:
        async with connected_fr3(
            cabinet, engine_silence_s=_PATIENT_SILENCE_S, stale_s=1.0, process_silence_s=2.0
        ) as connection:
            await connection.enable()
            arm = FaultyFr3(cabinet)
            link = Link(
                connection=connection,
                cut=lambda: cabinet.do("cut"),
                restore=lambda: cabinet.do("restore"),
                time_s=arm.time_s,
                rest_time_s=arm.await_rest,
            )
            yield Subject(
                port=connection.port,
                start=FR3_START,
                near=FR3_NEAR,
                far=FR3_FAR,
                limits=FR3_MODEL.limits,
                period_s=0.001,
                beats=_readings(connection),
                link=link,
            )


async def lose_link(subject: Subject, figures: Figures) -> None:
    """Cut the link in a motion, restore it, and permit motion again."""
    link = subject.link
    assert link is not None
    motion = subject.move(subject.far, 3.0)
    await until(lambda: motion.progress > 0.3)
    cut_s, cut_device_s = time.perf_counter(), link.time_s()
    link.cut()
    resting = asyncio.create_task(asyncio.to_thread(link.rest_time_s))
    await until(lambda: bool(link.connection.lost_reason))
    figures.cut_named_s.append(time.perf_counter() - cut_s)
    figures.cut_rest_s.append(await resting - cut_device_s)
    await motion.report()
    link.restore()
    restored_s = time.perf_counter()
    await until(lambda: not link.connection.lost_reason)
    figures.reading_again_s.append(time.perf_counter() - restored_s)
    await link.connection.enable()
    await subject.go(subject.start, 3.0)


@asynccontextmanager
async def _enabled(connection: ArmConnection) -> AsyncGenerator[None]:
    """Open a connection, permit motion, and close it afterwards."""
    await connection.open()
    try:
        await connection.enable()
        yield
    finally:
        await connection.close()


def _ur10(port: ArmPort, period_s: float, beats: Callable[[], tuple[int, float]], link: Link | None = None) -> Subject:
    return Subject(
        port=port, start=START, near=NEAR, far=FAR, limits=MODEL.limits, period_s=period_s, beats=beats, link=link
    )


def _readings(connection: ProcessArmConnection) -> Callable[[], tuple[int, float]]:
    def beats() -> tuple[int, float]:
        state = connection.state()
        return state.readings, state.read_at_s

    return beats


def _link(connection: ArmConnection, do: Callable[[str], Mapping[str, object]], *, moving: str, rested: str) -> Link:
    def rest_time_s() -> float:
        # An emulator tells nobody that its device rests: it can only be asked.
        while (state := do("state"))[moving]:
            pass
        return float(str(state[rested]))

    return Link(
        connection=connection,
        cut=lambda: do("cut"),
        restore=lambda: do("restore"),
        time_s=lambda: float(str(do("state")["time_s"])),
        rest_time_s=rest_time_s,
    )
