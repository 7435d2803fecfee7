"""The fault matrix of the ABB driver, in the middle of a motion; stop requests, silence, other clients."""

from __future__ import annotations

import asyncio
import socket
import threading
import time
from collections.abc import Generator

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.errors import RobotError
from robots.drivers.abb.abb_faults import AbbFault
from robots.drivers.abb.motion_link import MotionLink
from robots.port import MotionEnd
from tests.robots.drivers.abb.abb_fault_cases import CASES, COMPLETES, LOSES_PATH, STOPPED
from tests.robots.drivers.abb.emulated_irc5 import HOME, TOLERANCE, EmulatedIrc5, connected, emulated, straight
from tests.robots.drivers.abb.faulty_arm_motion import TARGET_RAD, faulty_arm_motion
from tests.robots.drivers.fault_cases import FaultCase

AWAY = np.array([1.0, *HOME[1:]])


@pytest.fixture(scope="module")
def emulator() -> Generator[EmulatedIrc5]:
    """The emulator of this file."""
    with emulated() as started:
        yield started


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_a_fault_is_named_and_nothing_moves_until_a_person_permits_it(emulator: EmulatedIrc5, case: FaultCase) -> None:
    outcome = asyncio.run(faulty_arm_motion(emulator, case))
    assert outcome.status is GoalStatus.ABORTED
    assert any(cause in outcome.cause for cause in case.cause), outcome.cause
    assert outcome.noticed_s < 20.0
    assert bool(outcome.lost_reason) is case.lost
    assert (abs(outcome.rest_rad - TARGET_RAD) < 1e-6) is (case.meanwhile is COMPLETES)
    if case.meanwhile is not LOSES_PATH:  # after a restart the stop request may arrive or not
        assert (outcome.stop_requests > 0) is (case.meanwhile is not COMPLETES)
    if case.meanwhile is COMPLETES:
        assert "the robot may still be moving" in outcome.cause
    assert all(outcome.refused), "every request before the person's command is refused with a reason"
    assert (outcome.started, outcome.moved_rad) == (0, 0.0)
    assert outcome.moves_again


def test_the_matrix_has_each_reaction_of_a_robot() -> None:
    assert {COMPLETES, STOPPED, LOSES_PATH} < {case.meanwhile for case in CASES}


def test_a_stop_is_requested_within_a_tenth_of_a_second(emulator: EmulatedIrc5) -> None:
    """By the clock of the emulator, which is that of this machine; a loaded machine may be late, but not always."""

    async def scenario() -> list[float]:
        delays_s = list[float]()
        async with connected(emulator) as connection:
            for goal in (AWAY, np.array(HOME), AWAY, np.array(HOME)):
                start = connection.port.sample().position_rad
                motion = connection.port.follow(straight(start, goal, duration_s=15.0), tolerance=TOLERANCE)
                while motion.progress < 0.1:
                    await connection.report(readings=1)
                cancelled_s = time.monotonic()
                motion.cancel()
                assert (await motion.report()).end is MotionEnd.CANCELED
                state = emulator.do("state")
                assert state["in_motion"] is False
                delays_s.append(state["stop_requests"][-1] - cancelled_s)
        return delays_s

    delays_s = asyncio.run(scenario())
    assert min(delays_s) >= 0.0
    assert min(delays_s) < 0.1
    assert max(delays_s) < 2.0


def test_a_cancel_overtakes_the_download(emulator: EmulatedIrc5) -> None:
    """The reply to the point that was sent is two seconds late."""

    async def scenario() -> None:
        async with connected(emulator, timeout_s=5.0, stale_s=10.0) as connection:
            start = connection.port.sample().position_rad
            started = emulator.do("state")["started"]
            emulator.do("slow", seconds=2.0)
            motion = connection.port.follow(straight(start, start + 0.3, duration_s=5.0), tolerance=TOLERANCE)
            while not (await asyncio.to_thread(emulator.do, "state"))["downloaded"]:
                pass
            cancelled_s = time.monotonic()
            motion.cancel()
            while (await asyncio.to_thread(emulator.do, "state"))["downloaded"]:
                pass
            state = emulator.do("state")
            emulator.do("restore")
            assert 0.0 < state["stop_requests"][-1] - cancelled_s < 1.5
            assert (await motion.report()).end is MotionEnd.CANCELED
            assert emulator.do("state")["started"] == started
            assert emulator.axes == pytest.approx(start, abs=1e-6)

    asyncio.run(scenario())


def test_the_arm_is_stopped_while_the_event_loop_is_blocked(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator, engine_silence_s=0.3) as connection:
            start = connection.port.sample().position_rad
            goal = AWAY if start[0] < 0.5 else np.array(HOME)
            motion = connection.port.follow(straight(start, goal, duration_s=6.0), tolerance=TOLERANCE)
            while motion.progress < 0.1:
                await connection.report(readings=1)
            blocked_s = time.monotonic()
            threading.Event().wait(1.5)
            report = await motion.report()
            state = emulator.do("state")
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, True)
            assert "engine silent for" in report.reason
            assert any(blocked_s < requested_s < blocked_s + 1.4 for requested_s in state["stop_requests"])
            assert connection.problem == ""

    asyncio.run(scenario())


def test_a_motion_connection_that_breaks_is_replaced_for_a_stop_request_only(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator) as connection:
            start = connection.port.sample().position_rad
            goal = AWAY if start[0] < 0.5 else np.array(HOME)
            motion = connection.port.follow(straight(start, goal, duration_s=6.0), tolerance=TOLERANCE)
            while motion.progress < 0.1:
                await connection.report(readings=1)
            before = emulator.do("state")
            emulator.do("drop", port="motion")
            report = await motion.report()
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, False)
            assert "link cut: the controller closed the motion connection; the robot may" in report.reason
            async with asyncio.timeout(20.0):
                while emulator.do("state")["in_motion"]:
                    await connection.report(readings=1)
            after = emulator.do("state")
            assert len(after["stop_requests"]) == len(before["stop_requests"]) + 1
            assert after["started"] == before["started"]
            assert abs(after["joints_rad"][0] - goal[0]) > 0.3
            assert connection.fault is AbbFault.LINK_CUT

    asyncio.run(scenario())


def test_a_stale_measurement_keeps_its_time_and_permits_no_motion(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator) as connection:
            changed = asyncio.Event()
            connection.when_changed(changed.set)
            emulator.do("freeze")
            async with asyncio.timeout(20.0):
                await changed.wait()
            sample = connection.port.sample()
            assert time.monotonic() - sample.time_s > 1.0
            assert "controller silent: no state message" in connection.lost_reason
            trajectory = straight(sample.position_rad, sample.position_rad + 0.1, duration_s=1.0)
            with pytest.raises(RobotError, match="controller silent: no state message"):
                connection.port.follow(trajectory, tolerance=TOLERANCE)
            emulator.do("restore")
            await connection.report(readings=3)
            assert connection.lost_reason == ""
            assert connection.problem.startswith("the connection was lost, and motion was not enabled since")

    asyncio.run(scenario())


def test_closing_in_a_motion_brings_the_arm_to_rest(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator) as connection:
            start = connection.port.sample().position_rad
            goal = AWAY if start[0] < 0.5 else np.array(HOME)
            motion = connection.port.follow(straight(start, goal, duration_s=6.0), tolerance=TOLERANCE)
            while motion.progress < 0.1:
                await connection.report(readings=1)
        assert (await motion.report()).end is MotionEnd.CANCELED
        assert emulator.do("state")["in_motion"] is False

    asyncio.run(scenario())


def test_connecting_and_reading_command_nothing(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        before = emulator.do("state")
        async with connected(emulator, enable=False) as connection:
            report = await connection.report(readings=3)
            assert report.state == "ready, auto mode, at rest"
            assert connection.problem == "motion is not enabled"
            trajectory = straight(connection.port.sample().position_rad, AWAY, duration_s=1.0)
            with pytest.raises(RobotError, match="motion is not enabled"):
                connection.port.follow(trajectory, tolerance=TOLERANCE)
            after = emulator.do("state")
            assert after["clients"] == {"motion": 0, "state": 1, "gripper": 0, "rws": 0}
            assert (after["stop_requests"], after["started"]) == (before["stop_requests"], before["started"])

    asyncio.run(scenario())


def test_a_client_that_was_first_keeps_the_port_and_is_named_as_a_possible_cause(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        host, place = str(emulator.place["host"]), emulator.place
        with socket.create_connection((host, place["motion_port"])), pytest.raises(RobotError) as refused:
            async with connected(emulator):
                pass
        assert "controller silent: no reply within 1 s" in str(refused.value)
        assert "no other client is connected" in str(refused.value)
        with socket.create_connection((host, place["state_port"])), pytest.raises(RobotError) as refused:
            async with connected(emulator):
                pass
        assert "the controller does not answer: " in str(refused.value)
        assert "no other client is connected" in str(refused.value)

    asyncio.run(scenario())


def test_a_second_client_waits_and_disturbs_nothing(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        host, place = str(emulator.place["host"]), emulator.place
        async with connected(emulator) as connection:
            start = connection.port.sample().position_rad
            goal = AWAY if start[0] < 0.5 else np.array(HOME)
            motion = connection.port.follow(straight(start, goal, duration_s=2.0), tolerance=TOLERANCE)
            with (
                socket.create_connection((host, place["motion_port"])),
                socket.create_connection((host, place["state_port"])),
            ):
                assert (await motion.report()).end is MotionEnd.REACHED
            assert connection.problem == ""

    asyncio.run(scenario())


@pytest.mark.parametrize("enabled_before", [False, True])
def test_a_connection_that_is_lost_while_it_is_enabled_permits_no_motion(
    emulator: EmulatedIrc5, enabled_before: bool
) -> None:
    async def scenario() -> None:
        async with connected(emulator, enable=enabled_before) as connection:
            enabling = asyncio.create_task(connection.enable())
            await asyncio.sleep(0)
            connection.lost("link cut: a test")
            connection.found()
            with pytest.raises(RobotError, match="the connection was lost, and motion was not enabled since"):
                await enabling
            assert connection.problem.startswith("the connection was lost")
            await connection.enable()
            assert connection.problem == ""

    asyncio.run(scenario())


def test_an_arm_whose_motion_port_is_refused_when_it_is_enabled_again_may_not_move() -> None:
    async def scenario() -> None:
        with emulated() as emulator:
            async with connected(emulator) as connection:
                emulator.do("freeze", port="motion")
                with pytest.raises(RobotError, match="no reply within"):
                    await connection.enable()
                assert connection.problem == "motion is not enabled"
                emulator.do("restore")

    asyncio.run(scenario())


class Deaf:
    """Hears of a motion link, and does nothing."""

    def motion_link_lost(self, reason: str) -> None: ...
    def stopped_by_silence(self, silent_s: float) -> None: ...


def test_a_stop_that_was_requested_is_sent_before_the_link_is_closed(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        options = emulator.driver_options()
        link = MotionLink(
            options.host,
            options.motion_port,
            Deaf(),
            byte_order=options.byte_order,
            timeout_s=options.timeout_s,
            silence_s=1.0,
        )
        await link.connect()
        before = len(emulator.do("state")["stop_requests"])
        stopped = link.stop()
        await link.close()
        await stopped
        assert len(emulator.do("state")["stop_requests"]) == before + 1

    asyncio.run(scenario())


def test_an_arm_that_another_program_moves_at_rest_is_a_fault(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator) as connection:
            changed = asyncio.Event()
            connection.when_changed(changed.set)
            emulator.do("foreign", joints_rad=[0.5, *HOME[1:]], seconds=3.0)
            async with asyncio.timeout(20.0):
                await changed.wait()
            assert connection.fault is AbbFault.FOREIGN_MOTION
            assert connection.problem.startswith("foreign motion: the arm moves, and not by our command")
            with pytest.raises(RobotError, match="cannot be enabled: foreign motion"):
                await connection.enable()

    asyncio.run(scenario())


def test_nothing_goes_on_when_an_operator_starts_the_program_after_an_emergency_stop(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator) as connection:
            start = connection.port.sample().position_rad
            goal = AWAY if start[0] < 0.5 else np.array(HOME)
            motion = connection.port.follow(straight(start, goal, duration_s=5.0), tolerance=TOLERANCE)
            while motion.progress < 0.1:
                await connection.report(readings=1)
            emulator.do("estop", on=True)
            report = await motion.report()
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, True)
            stopped = emulator.axes
            emulator.do("go_on")
            await connection.report(readings=10)
            assert emulator.axes.tolist() == stopped.tolist()
            assert connection.fault is AbbFault.EMERGENCY_STOP

    asyncio.run(scenario())
