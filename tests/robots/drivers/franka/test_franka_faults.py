"""A Franka arm and its emulator: each fault has a name, the arm rests, and a person permits motion again.

Reflexes and stops by a person are made by the proxy before franky-sim, which judges nothing; the library, and so the
driver, receives the messages of a robot.
"""

from __future__ import annotations

import asyncio
import json
import os
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Generator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.errors import RobotError
from engine.stop import StopRelay
from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.port import DelayedSettings, Motion, MotionEnd
from tests.engine.stop.device import endpoint_of, post
from tests.robots.drivers.arm_under_test import WIDE, lasting_emulators
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.franka.emulated_cabinet import (
    FR3_FAR,
    FR3_MODEL,
    FR3_NEAR,
    FR3_START,
    connected_fr3,
    measured,
    needs_franka,
    new_fr3_connection,
)
from tests.robots.drivers.franka.fr3_fault_cases import CASES
from tests.robots.sim.sim_cell import smooth, until
from tests.tiers import ROOT

pytestmark = needs_franka
ENGINE = Path(__file__).with_name("moving_fr3_engine_main.py")


@pytest.fixture(scope="module")
def cabinet() -> Generator[EmulatedProcess]:
    """Return the emulator of this file."""
    with lasting_emulators() as started:
        yield started.of("franka")


@pytest.fixture(autouse=True)
def restored(cabinet: EmulatedProcess) -> None:
    """Begin without faults, also after a test that has failed."""
    cabinet.do("restore")


def follow(connection: ProcessArmConnection, goal: object = FR3_FAR, duration_s: float = 4.0) -> Motion:
    """Start a motion from the set point."""
    port = connection.port
    start = np.asarray(port.sample().desired_rad)
    return port.follow(smooth(start, np.asarray(goal), duration_s, limits=FR3_MODEL.limits), tolerance=WIDE)


async def moving(connection: ProcessArmConnection, goal: object = FR3_FAR) -> Motion:
    """Return a long motion that is under way."""
    await connection.enable()
    motion = follow(connection, goal)
    await until(lambda: motion.progress > 0.1, within_s=90.0)
    return motion


async def ask(cabinet: EmulatedProcess, what: str, **values: object) -> dict[str, Any]:
    """Execute a request of the side channel without blocking the event loop."""
    return await asyncio.to_thread(lambda: cabinet.do(what, **values))


async def moves_again(connection: ProcessArmConnection, cabinet: EmulatedProcess) -> None:
    """Require that a person who enables it has an arm that moves, and that the robot was set up again."""
    with pytest.raises(RobotError):
        follow(connection)
    settings = (await ask(cabinet, "state"))["settings"]
    await connection.enable()
    state = await ask(cabinet, "state")
    assert state["settings"] == settings + 1
    assert state["reflex_torque_nm"] == [20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0]
    goal = np.asarray(connection.sample().position_rad) + 0.02
    assert (await follow(connection, goal, 0.3).report()).end is MotionEnd.REACHED


async def test_a_stop_of_the_robot_has_a_name_and_a_person_ends_it(cabinet: EmulatedProcess) -> None:
    """One after the other on one connection: each leaves the arm enabled and moving for the next."""
    async with connected_fr3(cabinet) as connection:
        for number, stop in enumerate(case for case in CASES if not case.lost):
            is_released = stop.restore[0] == stop.do
            motion = await moving(connection, FR3_FAR if number % 2 == 0 else FR3_START)
            await ask(cabinet, stop.do, **stop.values)
            report = await motion.report()
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, True), report
            assert stop.cause[0] in connection.problem
            assert stop.cause[0] in report.reason
            assert connection.lost_reason == ""
            recoveries = (await ask(cabinet, "state"))["recoveries"]
            await measured(connection)
            # Neither reading nor waiting recovers.
            assert (await ask(cabinet, "state"))["recoveries"] == recoveries
            if is_released:
                with pytest.raises(RobotError, match=stop.cause[0]) as refused:
                    await connection.enable()
                assert refused.value.hint
                await ask(cabinet, stop.restore[0], **stop.restore[1])
            await moves_again(connection, cabinet)
            assert (await ask(cabinet, "state"))["recoveries"] == recoveries + (0 if is_released else 1)


@pytest.mark.parametrize("case", [case for case in CASES if case.lost], ids=lambda case: case.name)
async def test_a_lost_connection_has_a_name_and_only_reading_comes_back(
    cabinet: EmulatedProcess, case: FaultCase
) -> None:
    async with connected_fr3(cabinet) as connection:
        goal = FR3_FAR if connection.sample().position_rad[0] < 0.7 else FR3_START
        motion = await moving(connection, goal)
        first_process = connection.process_id
        if case.do == "kill process":
            os.kill(connection.process_id, signal.SIGKILL)
        else:
            await ask(cabinet, case.do, **case.values)
        report = await motion.report()
        assert (report.end, report.at_rest) == (MotionEnd.FAILED, False)
        assert any(cause in report.reason for cause in case.cause)
        await until(lambda: bool(connection.lost_reason) or connection.process_id != first_process)
        await ask(cabinet, "restore")
        await until(lambda: not connection.lost_reason and connection.process_id not in (0, first_process))
        assert "motion was not permitted since" in connection.problem
        state = await ask(cabinet, "wait", until="at_rest")
        assert not state["is_controlled"]
        assert np.abs(np.array(state["q"]) - goal).max() > 0.1
        await moves_again(connection, cabinet)


async def test_lost_set_points_end_a_motion_by_the_robot_itself(cabinet: EmulatedProcess) -> None:
    """The process of the arm hangs, as on a computer that is overloaded."""
    async with connected_fr3(cabinet) as connection:
        goal = FR3_FAR if connection.sample().position_rad[0] < 0.7 else FR3_START
        motion = await moving(connection, goal)
        # Far more than the 20 of a robot: a loaded machine delays more than these.
        await ask(cabinet, "lost_packets", count=1000)
        os.kill(connection.process_id, signal.SIGSTOP)
        await ask(cabinet, "wait", until="free")
        os.kill(connection.process_id, signal.SIGCONT)
        report = await motion.report()
        assert report.end is MotionEnd.FAILED
        assert "communication constraints violation" in report.reason
        await ask(cabinet, "lost_packets", count=0)
        await moves_again(connection, cabinet)


async def test_a_second_client_and_a_robot_of_another_protocol_are_named(cabinet: EmulatedProcess) -> None:
    host = str(cabinet.place["host"])
    with socket.create_connection((host, 1337), timeout=20.0):
        with pytest.raises(RobotError, match=r"link cut|FCI refused|controller unreachable") as refused:
            await new_fr3_connection(host).open()
        assert refused.value.hint
    await ask(cabinet, "version", version=5)
    with pytest.raises(RobotError, match="wrong version") as refused:
        await new_fr3_connection(host).open()
    assert "FER, Panda" in (refused.value.hint or "")


async def test_stop_reaches_the_arm_while_the_event_loop_is_blocked(cabinet: EmulatedProcess) -> None:
    async with (
        StopRelay(host="127.0.0.1") as relay,
        connected_fr3(cabinet, new_stop_line=relay.new_line) as connection,
    ):
        endpoint = endpoint_of(relay)
        goal = FR3_FAR if connection.sample().position_rad[0] < 0.7 else FR3_START
        motion = await moving(connection, goal)
        # On this thread: the event loop is blocked until the arm rests.
        status: Any = post(endpoint, reason="a hand in the cell").json()
        while not status["at_rest"]:
            status = post(endpoint, path="/status").json()
        report = await motion.report()
        assert (report.end, report.reason) == (MotionEnd.FAILED, "STOP: a hand in the cell; arm came to rest by itself")
        assert np.abs(np.array(cabinet.do("wait", until="at_rest")["q"]) - goal).max() > 0.1


async def test_an_arm_whose_engine_was_killed_comes_to_rest(cabinet: EmulatedProcess) -> None:
    before = await asyncio.to_thread(kill_engine, cabinet)
    assert before["is_controlled"]
    rest = await ask(cabinet, "wait", until="free")
    assert np.abs(np.array(rest["q"]) - FR3_FAR).max() > 0.1
    # By the clock of the robot: the time to notice, and to brake.
    assert rest["time_s"] - before["time_s"] < 1.5


async def test_a_new_load_and_tool_reach_the_robot_at_rest(cabinet: EmulatedProcess) -> None:
    async with connected_fr3(cabinet, payload_kg=0.2) as connection:
        await connection.enable()
        assert (await ask(cabinet, "state"))["load_kg"] == pytest.approx(0.2)
        settings = connection.port.settings
        connection.port.configure(type(settings)(tool_xyz_m=(0.0, 0.0, 0.1), load_kg=0.5))
        await until(lambda: cabinet.do("state")["settings"] > 0 and cabinet.do("state")["load_kg"] > 0.6)
        state = await ask(cabinet, "state")
        assert state["load_kg"] == pytest.approx(0.7)
        assert state["tcp_m"] == pytest.approx([0.0, 0.0, 0.1], abs=1e-6)
        # As `SetLoad` does: the set point is taken anew with tool and load.
        port = connection.port
        assert isinstance(port, DelayedSettings)
        await until(lambda: port.settings_are_applied and cabinet.do("state")["is_controlled"])
        report = await follow(connection, FR3_NEAR, 1.0).report()
        assert report.end is MotionEnd.REACHED, report.reason


def kill_engine(cabinet: EmulatedProcess) -> dict[str, Any]:
    """Kill an engine whose arm moves, and return the state before."""
    command = [sys.executable, str(ENGINE), str(cabinet.place["host"])]
    engine = subprocess.Popen(command, stdout=subprocess.PIPE, env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert engine.stdout is not None
    with engine.stdout:
        assert select.select([engine.stdout], [], [], 60.0)[0]
        assert json.loads(engine.stdout.readline())["process"]
        before = cabinet.do("state")
        engine.kill()
        engine.wait()
    return before
