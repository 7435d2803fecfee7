"""A person enables a Universal Robots arm: twice at once, and while its controller stops."""

from __future__ import annotations

import asyncio
import os
import signal
import threading

import pytest

from engine.errors import RobotError
from tests.robots.drivers.arm_under_test import CLIENTS, connected
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController
from tests.robots.drivers.universal_robots.faulty_ur_arm import press, start_other
from tests.robots.sim.sim_cell import until


@pytest.fixture(params=CLIENTS)
def client(request: pytest.FixtureRequest) -> str:
    """The client of the driver."""
    return str(request.param)


async def test_closing_leaves_the_program_that_a_person_has_started_meanwhile(client: str) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client) as connection:
            await connection.enable()
            await asyncio.to_thread(press, controller.host, "stop")
            await until(lambda: connection.problem.startswith("program ended: "))
            await asyncio.to_thread(start_other, controller)
            await connection.report(readings=5)
        state = controller.state()
        assert (state["program"], state["runtime_state"]) == ("other", "PLAYING")


async def test_a_lost_process_leaves_the_program_that_a_person_has_started_meanwhile(client: str) -> None:
    """The engine stops the arm by the dashboard only where it may move: what runs else is not ours."""
    with EmulatedController() as controller:
        async with connected(controller, client=client) as connection:
            await connection.enable()
            await asyncio.to_thread(press, controller.host, "stop")
            await until(lambda: connection.problem.startswith("program ended: "))
            await asyncio.to_thread(start_other, controller)
            os.kill(connection.process_id, signal.SIGKILL)
            await until(lambda: bool(connection.lost_reason))
            await until(lambda: not connection.lost_reason)
        state = controller.state()
        assert (state["program"], state["runtime_state"]) == ("other", "PLAYING")


async def test_the_script_client_sees_that_another_program_has_replaced_its_own() -> None:
    """The library does not; there the arm is off its path when a motion begins."""
    with EmulatedController() as controller:
        async with connected(controller, client="script") as connection:
            await connection.enable()
            await asyncio.to_thread(start_other, controller)
            await until(lambda: connection.problem.startswith("program ended: another program"))
        state = controller.state()
        assert (state["program"], state["runtime_state"]) == ("other", "PLAYING")


async def test_two_who_enable_at_once_leave_no_pulse_that_ends_the_next_process(client: str) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client, process_silence_s=4.0) as connection:
            await asyncio.gather(connection.enable(), connection.enable())
            os.kill(connection.process_id, signal.SIGKILL)
            await until(lambda: bool(connection.lost_reason))
            await until(lambda: not connection.lost_reason)
            process = connection.process_id
            await connection.report(readings=200)
            assert connection.process_id == process


async def test_a_stop_of_the_controller_that_comes_with_the_answer_is_not_forgotten(client: str) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client) as connection:
            asked: list[object] = []

            def stop_at_once() -> None:
                """Let the answer and the stop arrive together: the event loop waits for both."""
                if not connection.problem and not asked:
                    asked.append(controller.ask("protective_stop"))
                    threading.Event().wait(0.5)

            connection.when_changed(stop_at_once)
            with pytest.raises(RobotError, match="protective stop"):
                await connection.enable()
            assert asked
            await connection.report(readings=10)
            assert "protective stop" in connection.problem


async def test_a_control_script_that_starts_late_is_waited_for_and_has_its_tool_set(client: str) -> None:
    """The library gives up after 4 s."""
    with EmulatedController() as controller:
        tcp = (0.0, 0.0, 0.15, 0.0, 0.0, 0.0)
        async with connected(controller, client=client, tcp=tcp, payload_kg=1.5) as connection:
            controller.ask("slow_start", value=5.5)
            await connection.enable()
            assert not connection.problem
            state = controller.state()
            assert (state["payload_kg"], state["tcp_offset"]) == (1.5, [0.0, 0.0, 0.15, 0.0, 0.0, 0.0])


async def test_a_script_that_hangs_after_it_was_uploaded_again_is_named_and_enabled_again_later() -> None:
    """The library waits for 4 s for each command, or for minutes where it believes that the script has taken one.

    It may believe so because the script that ran before has left behind that it is ready. The process is ended then, and
    another one reads.
    """
    with EmulatedController() as controller:
        async with connected(controller, client="ur_rtde", start_s=5.0) as connection:
            await connection.enable()
            await asyncio.to_thread(press, controller.host, "stop")
            await until(lambda: connection.problem.startswith("program ended: "))
            controller.ask("slow_start", value=1000.0)
            with pytest.raises(
                RobotError, match=r"program not ready: setTcp was refused|enabling hangs: .* was killed"
            ):
                await connection.enable()
            controller.ask("slow_start", value=0.0)
            await asyncio.to_thread(press, controller.host, "stop")
            controller.wait("stopped")
            await until(lambda: not connection.lost_reason)
            await connection.report(readings=5)
            await connection.enable()
            assert connection.problem == ""


async def test_a_control_script_that_does_not_start_in_its_time_is_named_with_what_the_controller_says(
    client: str,
) -> None:
    with EmulatedController() as controller:
        async with connected(controller, client=client, start_s=1.0) as connection:
            controller.ask("slow_start", value=1000.0)
            with pytest.raises(RobotError, match="program not ready: ") as refused:
                await connection.enable()
            assert refused.value.message.endswith("the controller says that a program runs, and that the arm may move")
            assert refused.value.where == controller.host
            assert "`start_s`" in (refused.value.hint or "")
            controller.ask("slow_start", value=0.0)
            await asyncio.to_thread(press, controller.host, "stop")
            controller.wait("stopped")
            await connection.report(readings=5)
            await connection.enable()
            assert not connection.problem
