"""A Universal Robots arm and its emulator: each fault has a name, the arm rests, and a person permits motion again."""

from __future__ import annotations

import asyncio
import errno
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pytest

from engine.errors import RobotError
from engine.stop import StopRelay
from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.port import Motion, MotionEnd, MotionReport
from robots.port.heartbeat import new_heartbeat_file
from tests.engine.stop.device import endpoint_of, post
from tests.robots.drivers.arm_under_test import CLIENTS, FAR, MODEL, NEAR, START, WIDE, connected, new_connection
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_process_arm import faulty_process_arm
from tests.robots.drivers.universal_robots.client_library import ClientLibrary, needs_client_library
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController, read_line
from tests.robots.drivers.universal_robots.faulty_ur_arm import FaultyUrArm, press, start_other
from tests.robots.drivers.universal_robots.ur_fault_cases import CASES
from tests.robots.sim.sim_cell import smooth, until
from tests.tiers import ROOT

T = TypeVar("T")
ENGINE = Path(__file__).with_name("moving_engine_main.py")


@pytest.fixture(params=CLIENTS)
def client(request: pytest.FixtureRequest) -> str:
    """The client of the driver."""
    return str(request.param)


def follow(connection: ProcessArmConnection, goal: object = FAR, duration_s: float = 8.0) -> Motion:
    """Start a motion from the set point."""
    port = connection.port
    start = np.asarray(port.sample().desired_rad)
    return port.follow(smooth(start, np.asarray(goal), duration_s, limits=MODEL.limits), tolerance=WIDE)


async def moving(connection: ProcessArmConnection) -> Motion:
    """Return a long motion that is under way."""
    await connection.enable()
    motion = follow(connection)
    await until(lambda: motion.progress > 0.2)
    return motion


async def moves_again(connection: ProcessArmConnection, controller: EmulatedController) -> None:
    """Require that a person who enables it has an arm that moves."""
    with pytest.raises(RobotError):
        follow(connection)
    await connection.enable()
    assert (await follow(connection, NEAR, 1.0).report()).end is MotionEnd.REACHED
    assert (await asyncio.to_thread(controller.state))["q"] == pytest.approx(NEAR.tolist(), abs=0.01)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
async def test_a_fault_is_named_and_nothing_moves_until_a_person_permits_it(client: str, case: FaultCase) -> None:
    with EmulatedController() as controller:
        outcome = await faulty_process_arm(FaultyUrArm(controller, client), case)
        assert outcome.end is MotionEnd.FAILED
        assert any(cause in outcome.cause for cause in case.cause), outcome.cause
        # Whether an arm rests that cannot be read is not known.
        assert outcome.is_reported_at_rest is not case.lost
        assert bool(outcome.lost_reason) is case.lost
        assert outcome.problem
        assert outcome.rest_rad[0] < FAR[0] - 0.1
        assert outcome.refused
        assert outcome.moved_rad < 1e-6
        assert outcome.moves_again, outcome.last_cause


@pytest.mark.parametrize("name", ["protective stop", "emergency stop", "power off", "program paused"])
async def test_an_arm_is_not_enabled_while_its_controller_is_stopped(client: str, name: str) -> None:
    """And nothing is unlocked or restarted."""
    case = next(case for case in CASES if case.name == name)
    with EmulatedController() as controller:
        arm = FaultyUrArm(controller, client)
        async with connected(controller, client=client) as connection:
            await connection.enable()
            await asyncio.to_thread(arm.do, case)
            # A set point that is refused may be noticed first.
            await until(lambda: bool(connection.problem))
            if name == "program paused":
                assert name in connection.problem
                # The driver has ended its own program where a set point was refused.
                await asyncio.to_thread(start_other, controller)
                await asyncio.to_thread(press, controller.host, "pause")
                await connection.report(readings=5)
            stopped = controller.state()
            with pytest.raises(RobotError, match=name) as refused:
                await connection.enable()
            assert refused.value.hint
            state = controller.state()
            for key in ("safety_mode", "robot_mode"):
                assert state[key] == stopped[key]


def descriptors() -> int:
    """Return how many this process has open."""
    return len(list(Path("/proc/self/fd").iterdir()))


async def test_an_engine_without_free_descriptors_reads_again_once_it_has_some(
    client: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    failed: list[bool] = []

    def once_none() -> int:
        if not failed:
            failed.append(True)
            raise OSError(errno.EMFILE, "too many open files")
        return new_heartbeat_file()

    with EmulatedController() as controller:
        async with connected(controller, client=client) as connection:
            monkeypatch.setattr("robots.drivers.arm.process_arm_connection.new_heartbeat_file", once_none)
            before = descriptors()
            os.kill(connection.process_id, signal.SIGKILL)
            await until(lambda: bool(connection.lost_reason))
            await until(lambda: not connection.lost_reason)
            assert failed
            assert descriptors() <= before


@needs_client_library
async def test_a_second_client_and_local_control_are_named_when_motion_is_enabled(client: str) -> None:
    with EmulatedController(series="e", model="ur10e") as controller:
        async with connected(controller, client=client) as connection:
            controller.ask("remote", value=0)
            with pytest.raises(RobotError, match="local control"):
                await connection.enable()
            controller.ask("remote", value=1)
            with ClientLibrary(controller.host) as other:
                await asyncio.to_thread(other.call, "control.open")
                with pytest.raises(RobotError, match="inputs in use"):
                    await connection.enable()
            assert connection.problem == "motion is not enabled"


async def test_a_controller_that_is_switched_off_and_on_is_read_again_and_has_its_tool_set_again(client: str) -> None:
    first = EmulatedController()
    with first:
        connection = new_connection(first.host, client=client, tcp=(0.0, 0.0, 0.15, 0.0, 0.0, 0.0), payload_kg=1.5)
        await connection.open()
        try:
            motion = await moving(connection)
            assert first.state()["payload_kg"] == 1.5
            first.restart()
            report = await motion.report()
            assert "link cut" in report.reason
            await until(lambda: not connection.lost_reason and connection.process_id != 0, within_s=60.0)
            await moves_again(connection, first)
            state = await asyncio.to_thread(first.state)
            assert (state["payload_kg"], state["tcp_offset"]) == (1.5, [0.0, 0.0, 0.15, 0.0, 0.0, 0.0])
        finally:
            await connection.close()


async def test_a_controller_that_is_not_there_is_named(client: str) -> None:
    connection = new_connection("127.0.0.254", client=client)
    with pytest.raises(RobotError, match="controller unreachable") as refused:
        await connection.open()
    assert "address" in (refused.value.hint or "")


async def test_an_arm_whose_engine_is_silent_comes_to_rest_and_says_so(client: str) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client, engine_silence_s=0.5) as connection:
            motion = await moving(connection)
            block_loop(lambda: controller.wait("at_rest"))
            report = await motion.report()
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, True)
            assert "the engine has been silent for" in report.reason
            assert connection.problem == ""
            assert (await follow(connection, START, 1.0).report()).end is MotionEnd.REACHED


async def test_stop_reaches_the_arm_while_the_event_loop_is_blocked(client: str) -> None:
    with EmulatedController() as controller:
        async with (
            StopRelay(host="127.0.0.1") as relay,
            connected(controller, client=client, new_stop_line=relay.new_line) as connection,
        ):
            endpoint = endpoint_of(relay)
            motion = await moving(connection)

            def stop_and_wait() -> Any:
                status: Any = post(endpoint, reason="a hand in the cell").json()
                while not status["at_rest"]:
                    status = post(endpoint, path="/status").json()
                return status

            status = block_loop(stop_and_wait)
            assert (status["engine"], status["devices"][0]["name"]) == ("silent", "arm")
            rest = await asyncio.to_thread(controller.wait, "at_rest")
            assert rest["q"][0] < FAR[0] - 0.1
            report = await motion.report()
            assert (report.end, report.reason) == (
                MotionEnd.FAILED,
                "STOP: a hand in the cell; arm came to rest by itself",
            )


async def test_an_arm_whose_engine_was_killed_comes_to_rest(client: str) -> None:
    with EmulatedController() as controller:
        process = await asyncio.to_thread(kill_engine, controller.host, client)
        before = controller.state()
        rest = await asyncio.to_thread(controller.wait, "at_rest")
        assert rest["q"][0] < FAR[0] - 0.1
        # By the clock of the controller: the time to notice, and to brake.
        assert rest["time_s"] - before["time_s"] < 1.5
        await until(lambda: has_ended(process))


@needs_client_library
async def test_the_speed_slider_of_the_controller_stretches_a_motion(client: str) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client) as connection:
            await connection.enable()
            durations_s: list[float] = []
            for goal, fraction in ((NEAR, 1.0), (START, 0.4)):
                with ClientLibrary(controller.host, "io") as slider:
                    assert await asyncio.to_thread(slider.call, "io.setSpeedSlider", fraction)
                await until(lambda fraction=fraction: connection.state().speed_scaling == fraction)
                before_s = connection.sample().time_s
                report: MotionReport = await follow(connection, goal, 1.0).report()
                assert report.end is MotionEnd.REACHED
                durations_s.append(connection.sample().time_s - before_s)
            assert durations_s[1] > 1.5 * durations_s[0]


async def test_outputs_are_set_and_read_back(client: str) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client) as connection:
            outputs = connection.outputs
            assert outputs is not None
            assert outputs.values == (False,) * 10
            for output in (3, 9):
                outputs.set(output, on=True)
            await outputs.confirmed()
            assert [number for number, on in enumerate(outputs.values) if on] == [3, 9]
            assert controller.state()["digital_outputs"] == 1 << 3 | 1 << 17
            outputs.set(3, on=False)
            await outputs.confirmed()
            assert [number for number, on in enumerate(outputs.values) if on] == [9]
            with pytest.raises(RobotError, match="there is no output 10"):
                outputs.set(10, on=True)
            controller.ask("remote", value=0)
            outputs.set(0, on=True)
            with pytest.raises(RobotError, match="output 0 reads back as off"):
                await outputs.confirmed()


async def test_inputs_are_read_without_a_motion_and_unknown_once_the_controller_is_lost(client: str) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client) as connection:
            inputs = connection.inputs
            assert inputs is not None
            assert (inputs.count, inputs.values) == (10, (False,) * 10)
            # Those of the tool are the bits 16 and 17, configurable ones are none of them.
            for bit in (0, 7, 8, 17):
                controller.ask("digital_input", bit=bit, value=1)
            await until(lambda: [number for number, on in enumerate(inputs.values) if on] == [0, 7, 9])
            assert (await connection.report(readings=1)).inputs == inputs.values
            controller.ask("digital_input", bit=7, value=0)
            await until(lambda: [number for number, on in enumerate(inputs.values) if on] == [0, 9])
            controller.ask("cut")
            await until(lambda: bool(inputs.problem))
            assert (inputs.values, "link cut" in inputs.problem) == ((), True)
            controller.ask("restore")
            await until(lambda: inputs.values != () and inputs.values[0], within_s=60.0)


def kill_engine(host: str, client: str) -> int:
    """Kill an engine whose arm moves, and return the id of its control process."""
    command = [sys.executable, str(ENGINE), host, client]
    engine = subprocess.Popen(command, stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert engine.stdout is not None
    with engine.stdout:
        process = int(read_line(engine, "the engine")["process"])
        engine.kill()
        engine.wait()
    return process


def block_loop(call: Callable[[], T]) -> T:
    """Call on another thread, holding this one, the event loop's, until it returns."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(call).result()


def has_ended(process: int) -> bool:
    """Return whether a process is gone."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    return False
