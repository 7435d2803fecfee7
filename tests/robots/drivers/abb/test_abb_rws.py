"""Robot Web Services of the ABB driver on the emulator: causes by name, recovery by a person, loss, and the report."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable, Generator
from typing import Any

import numpy as np
import pytest

from engine.errors import CellError, RobotError
from robots.drivers.abb.abb_connection import AbbConnection
from robots.drivers.abb.abb_faults import AbbFault
from robots.port import MotionEnd
from tests.robots.drivers.abb.emulated_irc5 import HOME, TOLERANCE, EmulatedIrc5, connected, emulated, straight

AWAY = np.array([1.0, *HOME[1:]])
PATIENT_S = 30.0


@pytest.fixture(scope="module")
def emulator() -> Generator[EmulatedIrc5]:
    """The emulator of this file."""
    with emulated() as started:
        yield started


async def until(connection: AbbConnection, reached: Callable[[], bool]) -> None:
    """Wait for what readings bring."""
    async with asyncio.timeout(PATIENT_S):
        while not reached():
            await connection.report(readings=1)


def rws(emulator: EmulatedIrc5, **options: object) -> dict[str, Any]:
    """Return the options of the service; a loaded machine gets more time."""
    return {"port": emulator.place["rws_port"], "timeout_s": 5.0, "stale_s": 10.0, **options}


def farther(connection: AbbConnection, duration_s: float = 8.0) -> Any:
    """Begin a motion of the first axis to the other end."""
    start = connection.port.sample().position_rad
    goal = AWAY if start[0] < 0.5 else np.array(HOME)
    return connection.port.follow(straight(start, goal, duration_s=duration_s), tolerance=TOLERANCE)


@pytest.mark.parametrize(
    ("do", "values", "fault", "text"),
    [
        ("guard", {"on": True}, AbbFault.GUARD_STOP, "guard stop: a safeguard is open; event 20205: Auto stop open"),
        (
            "estop",
            {"on": True},
            AbbFault.EMERGENCY_STOP,
            "emergency stop: the emergency stop is active; event 20202: Emergency stop open",
        ),
        ("mode", {"mode": "manual"}, AbbFault.MANUAL_MODE, "manual mode: manual with reduced speed"),
        ("mode", {"mode": "manual_full"}, AbbFault.MANUAL_MODE, "manual mode: manual with full speed"),
        ("program", {"on": False}, AbbFault.PROGRAM_STOPPED, "program stopped: RAPID is stopped"),
        ("drives", {"on": False}, AbbFault.DRIVES_OFF, "drives off: the motors are off"),
    ],
)
def test_a_stop_in_a_motion_has_the_name_that_the_controller_gives_it(
    emulator: EmulatedIrc5, do: str, values: dict[str, object], fault: AbbFault, text: str
) -> None:
    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator)) as connection:
            motion = farther(connection)
            await until(connection, lambda: motion.progress > 0.1)
            stops = len(emulator.do("state")["stop_requests"])
            emulator.do(do, **values)
            report = await motion.report()
            assert (report.end, report.at_rest) == (MotionEnd.FAILED, True)
            await until(connection, lambda: connection.fault is fault)
            assert connection.problem.startswith(text)
            assert connection.facts().safety == text
            assert (await connection.report(readings=1)).fault == text
            assert len(emulator.do("state")["stop_requests"]) > stops
            assert emulator.do("state")["in_motion"] is False

    asyncio.run(scenario())


def test_the_reason_of_the_motion_is_the_name_too(emulator: EmulatedIrc5) -> None:
    """simple_message says that the drives are off; the guard is named before the arm is at rest."""

    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator)) as connection:
            motion = farther(connection)
            await until(connection, lambda: motion.progress > 0.1)
            emulator.do("guard", on=True)
            reason = (await motion.report()).reason
            assert reason.startswith(("guard stop: a safeguard is open", "drives off: the motors are off"))

    asyncio.run(scenario())


@pytest.mark.parametrize(
    ("do", "values", "message"),
    [
        ("guard", {"on": True}, "cannot be enabled: guard stop"),
        ("estop", {"on": True}, "cannot be enabled: emergency stop: the emergency stop is active"),
        ("estop", {"on": False}, "cannot be enabled: emergency stop: the button is released, and the stop is not conf"),
        ("mode", {"mode": "manual"}, "cannot be enabled: manual mode: manual with reduced speed"),
    ],
)
def test_what_needs_a_person_at_the_controller_is_not_recovered(
    emulator: EmulatedIrc5, do: str, values: dict[str, object], message: str
) -> None:
    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator)) as connection:
            asked = emulator.do("state")["asked"]
            emulator.do(do, **values)
            await until(connection, lambda: bool(connection.problem))
            with pytest.raises(RobotError, match=message):
                await connection.enable()
            assert emulator.do("state")["asked"] == asked

    asyncio.run(scenario())


def test_enabling_switches_motors_on_and_starts_at_main_and_the_old_path_is_gone(
    emulator: EmulatedIrc5, caplog: pytest.LogCaptureFixture
) -> None:
    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator)) as connection:
            motion = farther(connection)
            await until(connection, lambda: motion.progress > 0.1)
            emulator.do("guard", on=True)
            assert (await motion.report()).end is MotionEnd.FAILED
            emulator.do("guard", on=False)
            before = emulator.do("state")
            await connection.report(readings=10)
            assert emulator.do("state")["asked"] == before["asked"], "nothing is recovered without a person"
            with caplog.at_level(logging.WARNING, "flexcell.devices"):
                await connection.enable()
            after = emulator.do("state")
            assert after["asked"][len(before["asked"]) :] == ["motoron", "resetpp", "start"]
            assert (after["started"], after["travel_rad"]) == (before["started"], before["travel_rad"])
            lines = [record.getMessage() for record in caplog.records]
            assert [line for line in lines if "over RWS" in line] == [
                "arm: switch the motors on, over RWS",
                "arm: move the program pointer to main, over RWS",
                "arm: start the program, over RWS",
            ]
            assert (connection.problem, connection.fault) == ("", None)
            assert (await farther(connection, 2.0).report()).end is MotionEnd.REACHED

    asyncio.run(scenario())


def test_enabling_a_controller_that_is_ready_asks_it_for_nothing(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        asked = emulator.do("state")["asked"]
        async with connected(emulator, rws=rws(emulator)) as connection:
            assert connection.problem == ""
            assert emulator.do("state")["asked"] == asked

    asyncio.run(scenario())


def test_a_recovery_that_the_controller_refuses_permits_no_motion(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator)) as connection:
            emulator.do("drives", on=False)
            await until(connection, lambda: bool(connection.problem))
            emulator.do("rws_refuse", text="user has no grant")
            with pytest.raises(RobotError, match="does not switch the motors on: HTTP 400 user has no grant"):
                await connection.enable()
            assert connection.problem

    asyncio.run(scenario())


def test_the_speed_of_the_panel_stretches_a_motion_and_is_reported(emulator: EmulatedIrc5) -> None:
    """Without it, a motion of this time at 10 % would count as one that takes too long."""

    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator)) as connection:
            emulator.do("speed", percent=10)
            await until(connection, lambda: connection.facts().speed_scaling == 0.1)
            start = connection.port.sample().position_rad
            goal = start + np.array([0.1 if start[0] < 0.5 else -0.1, 0.0, 0.0, 0.0, 0.0, 0.0])
            motion = connection.port.follow(straight(start, goal, duration_s=1.0), tolerance=TOLERANCE)
            assert (await motion.report()).end is MotionEnd.REACHED
            assert (await connection.report(readings=1)).readings["speed_ratio"] == 0.1

    asyncio.run(scenario())


def test_a_panel_at_no_speed_holds_a_motion_without_failing_it(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator)) as connection:
            motion = farther(connection, 4.0)
            await until(connection, lambda: motion.progress > 0.1)
            emulator.do("speed", percent=0)
            await until(connection, lambda: connection.facts().speed_scaling == 0.0)
            await connection.report(readings=30)
            assert not motion.ended
            emulator.do("speed", percent=100)
            assert (await motion.report()).end is MotionEnd.REACHED

    asyncio.run(scenario())


@pytest.mark.parametrize(
    ("do", "values", "cause"),
    [
        ("close_port", {"port": "rws"}, "link cut: RWS cannot be reached"),
        ("rws_fault", {"fault": "freeze"}, "controller silent: RWS did not answer within 1 s"),
        ("rws_fault", {"fault": "garbage"}, "garbage: RWS sent no HTTP"),
        ("rws_fault", {"fault": "refuse"}, "refused: RWS has no free session"),
    ],
)
def test_a_lost_service_is_named_and_stops_no_motion(
    emulator: EmulatedIrc5, do: str, values: dict[str, object], cause: str
) -> None:
    async def scenario() -> None:
        async with connected(emulator, rws=rws(emulator, timeout_s=1.0, stale_s=1.0)) as connection:
            motion = farther(connection, 6.0)
            emulator.do(do, **values)
            await until(connection, lambda: "RWS is lost" in connection.facts().safety)
            assert connection.facts().safety.startswith(f"normal (RWS is lost: {cause}")
            assert (await motion.report()).end is MotionEnd.REACHED
            assert connection.problem == ""
            await connection.enable()
            emulator.do("drives", on=False)
            await until(connection, lambda: connection.fault is AbbFault.DRIVES_OFF)
            with pytest.raises(RobotError, match="cannot be enabled: drives off"):
                await connection.enable()
            emulator.do("restore")
            await until(connection, lambda: connection.facts().safety.startswith("drives off: the motors are off"))
            await until(connection, lambda: "RWS is lost" not in connection.facts().safety)
            await connection.enable()
            assert connection.problem == ""

    asyncio.run(scenario())


def test_the_report_has_what_the_controller_is(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator, enable=False, rws=rws(emulator)) as connection:
            report = await connection.report(readings=2)
            assert report.firmware == (
                "RobotWare 6.15.0000, system emulated, controller IRC5_EMULATED, serial 4600-501234"
            )
            assert report.state == "ready, AUTO mode, at rest, RAPID running"
            assert connection.facts().firmware == report.firmware

    asyncio.run(scenario())


def test_a_wrong_password_is_refused_by_name(emulator: EmulatedIrc5, monkeypatch: pytest.MonkeyPatch) -> None:
    async def scenario() -> None:
        monkeypatch.setenv("ABB_TEST_PASSWORD", "wrong")
        with pytest.raises(RobotError, match="refused: RWS refuses user or password") as refused:
            async with connected(emulator, rws=rws(emulator, stale_s=1.0, password="${ABB_TEST_PASSWORD}")):
                pass
        assert "check `user` and `password` of `rws`" in str(refused.value)

    asyncio.run(scenario())


def test_a_password_that_is_not_set_is_an_error_of_the_cell(
    emulator: EmulatedIrc5, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def scenario() -> None:
        monkeypatch.delenv("ABB_TEST_PASSWORD", raising=False)
        with pytest.raises(CellError, match="ABB_TEST_PASSWORD"):
            async with connected(emulator, rws=rws(emulator, password="${ABB_TEST_PASSWORD}")):
                pass

    asyncio.run(scenario())
