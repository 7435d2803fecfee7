"""Externally Guided Motion on the emulator: faults by name, rest without answers, recovery by a person, refusals."""

from __future__ import annotations

import asyncio
import dataclasses
import os
import signal
import socket
from collections.abc import Generator

import msgspec
import numpy as np
import pytest

from engine.errors import RobotError
from robots.drivers.abb.abb_driver import ABB_IRC5
from robots.drivers.abb.egm.egm_controller import held_deg
from robots.drivers.abb.egm.egm_messages import EgmMeasurement, MciState, MotorState, RapidState, encode_measurement
from robots.port import ConfirmedOutputs, JointTrajectory, MotionEnd, Tolerance
from tests.robots.drivers.abb.egm_fault_cases import CASES, COMM_TIMEOUT
from tests.robots.drivers.abb.emulated_irc5 import EGM_PORT, EmulatedIrc5, connected, emulated
from tests.robots.drivers.abb.guided_irc5 import (
    GUIDED_FAR,
    GUIDED_MODEL,
    GUIDED_NEAR,
    GUIDED_START,
    FaultyGuidedArm,
    guided,
    guided_connection,
)
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_process_arm import faulty_process_arm
from tests.robots.sim.sim_cell import smooth, until

WIDE = Tolerance(path_rad=0.4)


@pytest.fixture(scope="module")
def emulator() -> Generator[EmulatedIrc5]:
    """The emulator of this file; a loaded machine keeps it waiting for longer than a controller would."""
    with emulated(egm=True, comm_timeout_s=1.0) as started:
        yield started


def path(start: object, goal: object, duration_s: float = 1.0) -> JointTrajectory:
    """Return a smooth path."""
    return smooth(np.asarray(start), np.asarray(goal), duration_s, limits=GUIDED_MODEL.limits)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
async def test_a_fault_is_named_and_nothing_moves_until_a_person_permits_it(
    emulator: EmulatedIrc5, case: FaultCase
) -> None:
    before = emulator.do("state")["egm"]["comm_timeouts"]
    outcome = await faulty_process_arm(FaultyGuidedArm(emulator), case)
    assert outcome.end is MotionEnd.FAILED
    assert any(cause in outcome.cause for cause in case.cause), outcome.cause
    assert bool(outcome.lost_reason) is case.lost
    assert outcome.problem
    assert outcome.rest_rad[0] < GUIDED_FAR[0] - 0.1
    assert outcome.refused
    assert outcome.moved_rad < 1e-6
    assert outcome.moves_again, outcome.last_cause
    if case.meanwhile is COMM_TIMEOUT:
        assert emulator.do("state")["egm"]["comm_timeouts"] > before


async def test_reading_answers_nothing(emulator: EmulatedIrc5) -> None:
    async with guided(emulator, enable=False) as connection:
        before = emulator.do("state")
        await connection.report(readings=20)
        after = emulator.do("state")
        assert after["egm"]["heard"] == before["egm"]["heard"]
        assert after["travel_rad"] == before["travel_rad"]
        with pytest.raises(RobotError, match="motion is not enabled"):
            connection.port.stream("joint_velocity", watchdog_s=0.5)


async def test_measurements_that_come_twice_or_late_are_passed_over(emulator: EmulatedIrc5) -> None:
    async with guided(emulator) as connection:
        emulator.do("egm_fault", fault="repeats")
        for goal in (GUIDED_NEAR, GUIDED_START):
            start = connection.port.sample().desired_rad
            report = await connection.port.follow(path(start, goal), tolerance=WIDE).report()
            assert (report.end, report.reason) == (MotionEnd.REACHED, "")


async def test_measurements_of_another_sender_move_nothing(emulator: EmulatedIrc5) -> None:
    foreign = EgmMeasurement(
        number=2**31,
        time_ms=0,
        measured_deg=(90.0,) * 6,
        motors=MotorState.ON,
        mci=MciState.RUNNING,
        rapid=RapidState.RUNNING,
    )
    async with guided(emulator) as connection:
        before = connection.port.sample().position_rad
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
            other.bind(("127.0.0.1", 0))
            for _ in range(50):
                other.sendto(encode_measurement(foreign), (str(emulator.place["host"]), EGM_PORT))
                await connection.report(readings=1)
        assert connection.problem == ""
        assert connection.port.sample().position_rad == pytest.approx(before, abs=1e-6)


async def test_with_rws_a_stop_has_its_name_and_enabling_recovers_the_controller(emulator: EmulatedIrc5) -> None:
    async with guided(emulator, rws=True) as connection:
        motion = connection.port.follow(path(connection.port.sample().desired_rad, GUIDED_FAR, 8.0), tolerance=WIDE)
        await until(lambda: motion.progress > 0.1)
        emulator.do("guard", on=True)
        assert (await motion.report()).end is MotionEnd.FAILED
        await until(lambda: connection.problem.startswith("guard stop: a safeguard is open"))
        assert connection.facts().safety.startswith("guard stop: a safeguard is open")
        with pytest.raises(RobotError, match="cannot be enabled: guard stop"):
            await connection.enable()
        asked = len(emulator.do("state")["asked"])
        emulator.do("guard", on=False)
        await connection.enable()
        assert emulator.do("state")["asked"][asked:] == ["motoron", "resetpp", "start"]
        assert connection.problem == ""
        start = connection.port.sample().desired_rad
        assert (await connection.port.follow(path(start, GUIDED_START), tolerance=WIDE).report()).end is (
            MotionEnd.REACHED
        )


async def test_a_lost_rws_stops_no_guided_motion(emulator: EmulatedIrc5) -> None:
    async with guided(emulator, rws=True) as connection:
        start = connection.port.sample().desired_rad
        goal = GUIDED_NEAR if abs(start[0] - GUIDED_NEAR[0]) > 0.1 else GUIDED_START
        motion = connection.port.follow(path(start, goal, 3.0), tolerance=WIDE)
        emulator.do("close_port", port="rws")
        assert (await motion.report()).end is MotionEnd.REACHED
        assert connection.problem == ""


async def test_a_load_cannot_be_set(emulator: EmulatedIrc5) -> None:
    async with guided(emulator) as connection:
        connection.port.configure(msgspec.structs.replace(connection.port.settings, load_kg=1.0))
        await until(lambda: connection.problem.startswith("the load cannot be set from here"))


async def test_the_gripper_is_switched_besides(emulator: EmulatedIrc5) -> None:
    options = emulator.driver_options(gripper=emulator.gripper())
    async with guided(emulator) as connection:
        assert connection.outputs is None
    async with guided(emulator, gripper=options.gripper) as connection:
        outputs = connection.outputs
        assert outputs is not None
        outputs.set(0, on=True)
        assert isinstance(outputs, ConfirmedOutputs)
        await outputs.confirmed()
        await until(lambda: bool(emulator.do("state")["gripper_on"]))


async def test_a_controller_that_sends_nothing_is_named() -> None:
    with emulated() as silent, pytest.raises(RobotError, match="controller silent: nothing of 127"):
        await guided_connection(silent).open()


async def test_a_port_that_another_program_has_is_named(emulator: EmulatedIrc5) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind((str(emulator.place["host"]), EGM_PORT))
        with pytest.raises(RobotError, match="cannot listen on UDP port 6510"):
            await guided_connection(emulator).open()


def test_streams_are_a_capability_with_egm_only(emulator: EmulatedIrc5) -> None:
    plain = ABB_IRC5.configured(emulator.driver_options())
    assert (
        plain.lacks("stream")
        == "the driver abb_irc5 has no streamed set points, only sampled trajectories, digital outputs"
    )
    assert ABB_IRC5.configured(emulator.driver_options(egm={})).lacks("stream") == ""

    async def scenario() -> None:
        async with connected(emulator) as connection:
            with pytest.raises(RobotError, match="has no streamed set points"):
                connection.port.stream("joint_velocity", watchdog_s=0.5)

    asyncio.run(scenario())


async def test_rapid_is_stopped_where_the_process_of_a_moving_arm_is_lost(emulator: EmulatedIrc5) -> None:
    async with guided(emulator, rws=True) as connection:
        start = connection.port.sample().desired_rad
        goal = GUIDED_NEAR if abs(start[0] - GUIDED_NEAR[0]) > 0.1 else GUIDED_START
        motion = connection.port.follow(path(start, goal, 8.0), tolerance=WIDE)
        await until(lambda: motion.progress > 0.1)
        asked = len(emulator.do("state")["asked"])
        os.kill(connection.process_id, signal.SIGKILL)
        assert (await motion.report()).end is MotionEnd.FAILED
        await until(lambda: emulator.do("state")["asked"][asked:] == ["stop"])
        await until(lambda: not connection.lost_reason)
        await until(lambda: connection.problem.startswith("program stopped: RAPID is stopped"))
        await connection.enable()
        assert emulator.do("state")["asked"][asked:] == ["stop", "resetpp", "start"]
        assert connection.problem == ""


def test_what_is_planned_elsewhere_is_not_held() -> None:
    """Motion begins where the arm is held: that must not be an old plan of the controller."""
    there = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0)
    near = EgmMeasurement(number=1, time_ms=4, measured_deg=there, planned_deg=(1.1, *there[1:]))
    assert held_deg(near) == (1.1, *there[1:])
    assert held_deg(dataclasses.replace(near, planned_deg=(0.0,) * 6)) is None
    assert held_deg(dataclasses.replace(near, planned_deg=None)) is None
