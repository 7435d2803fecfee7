"""The process of the client library and its supervisor against the emulator: faults with causes and recoveries."""

from __future__ import annotations

import asyncio
import math
import os
import signal
import socket
import time
from collections.abc import Callable

import pytest

from robots.drivers.universal_robots.ur_faults import UrFault, UrFaultError
from robots.drivers.universal_robots.ur_messages import EnableMotion, SixNumbers
from robots.drivers.universal_robots.ur_supervisor import UrSupervisor
from tests.robots.drivers.universal_robots.client_library import ClientLibrary, needs_client_library
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController

pytestmark = needs_client_library
HOME: SixNumbers = (0.0, -math.pi / 2, math.pi / 2, -math.pi / 2, -math.pi / 2, 0.0)
FAR: SixNumbers = (2.8, *HOME[1:])
NEAR: SixNumbers = (0.3, *HOME[1:])
# A busy machine may keep a process waiting for tenths of a second.
TOOL = EnableMotion(tcp_offset=(0.0, 0.0, 0.15, 0.0, 0.0, 0.0), payload_kg=1.5, watchdog_hz=1.0)
SILENCE_S = 2.0
Cause = Callable[[EmulatedController, UrSupervisor], object]


async def start_motion(controller: EmulatedController, supervisor: UrSupervisor) -> asyncio.Task[None]:
    """Return a motion that is under way."""
    await supervisor.enable_motion(TOOL)
    motion = asyncio.create_task(supervisor.move_joints(FAR, speed_rad_s=0.8, acceleration_rad_s2=4.0))
    await asyncio.to_thread(controller.wait, "moving")
    return motion


async def fault_of(motion: asyncio.Task[None]) -> UrFault:
    """Return why a motion has failed."""
    with pytest.raises(UrFaultError) as caught:
        await motion
    return caught.value.fault


async def read_again(supervisor: UrSupervisor) -> None:
    """Wait until the controller is read."""
    async with supervisor.readings:
        await supervisor.readings.wait_for(lambda: supervisor.latest is not None)


def press(host: str, command: str) -> str:
    """Do what a person does at the dashboard."""
    with socket.create_connection((host, 29999), timeout=30) as connection, connection.makefile("rw") as lines:
        lines.readline()
        lines.write(f"{command}\n")
        lines.flush()
        return lines.readline().strip()


async def test_a_motion_ends_at_its_target_with_tool_and_payload_set() -> None:
    """And it is refused before it is enabled."""
    with EmulatedController() as controller:
        async with UrSupervisor(controller.host, silence_s=SILENCE_S) as supervisor:
            refused = asyncio.create_task(supervisor.move_joints(NEAR, speed_rad_s=1.0, acceleration_rad_s2=4.0))
            assert await fault_of(refused) is UrFault.NOT_ENABLED
            await supervisor.enable_motion(TOOL)
            await supervisor.move_joints(NEAR, speed_rad_s=1.0, acceleration_rad_s2=4.0)
            assert supervisor.latest is not None
            state = controller.state()
    assert state["q"] == pytest.approx(NEAR)
    assert state["payload_kg"] == 1.5
    assert state["tcp_offset"] == list(TOOL.tcp_offset)


async def test_a_stop_ends_a_motion_on_its_path_and_the_next_one_follows() -> None:
    """Without enabling it again."""
    with EmulatedController() as controller:
        async with UrSupervisor(controller.host, silence_s=SILENCE_S) as supervisor:
            motion = await start_motion(controller, supervisor)
            supervisor.stop()
            assert await fault_of(motion) is UrFault.STOPPED
            assert 0.0 < controller.state()["q"][0] < FAR[0]
            await supervisor.move_joints(NEAR, speed_rad_s=1.0, acceleration_rad_s2=4.0)
            assert controller.state()["q"] == pytest.approx(NEAR)


async def test_a_hard_stop_ends_the_program_on_a_path_of_its_own() -> None:
    """By the dashboard; motion has to be enabled again."""
    with EmulatedController() as controller:
        async with UrSupervisor(controller.host, silence_s=SILENCE_S) as supervisor:
            motion = await start_motion(controller, supervisor)
            assert await supervisor.hard_stop() == "Stopped"
            assert await fault_of(motion) is UrFault.PROGRAM_ENDED
            assert not supervisor.is_motion_enabled
            await supervisor.enable_motion(TOOL)
            await supervisor.move_joints(NEAR, speed_rad_s=1.0, acceleration_rad_s2=4.0)


LOSSES: dict[str, tuple[UrFault, float, Cause]] = {
    "drop": (UrFault.LINK_CUT, 1.5, lambda controller, _s: controller.ask("drop")),
    "cut": (UrFault.LINK_CUT, 1.5, lambda controller, _s: controller.ask("cut")),
    "freeze": (UrFault.CONTROLLER_SILENT, 4.0, lambda controller, _s: controller.ask("freeze")),
    "killed process": (UrFault.PROCESS_ENDED, 1.5, lambda _c, s: os.kill(s.process_id, signal.SIGKILL)),
    "hanging process": (UrFault.PROCESS_SILENT, 4.0, lambda _c, s: os.kill(s.process_id, signal.SIGSTOP)),
}
"""Cause, how soon it is noticed on a busy machine, and how it comes about."""


@pytest.mark.parametrize("loss", LOSSES)
async def test_after_a_loss_the_arm_is_at_rest_and_only_reading_is_restored(loss: str) -> None:
    """The motion fails with the cause; the next one needs a person to enable it."""
    fault, limit_s, cause = LOSSES[loss]
    reported: list[UrFault] = []
    with EmulatedController() as controller:
        async with UrSupervisor(controller.host, silence_s=SILENCE_S, on_fault=reported.append) as supervisor:
            motion = await start_motion(controller, supervisor)
            first_process = supervisor.process_id
            before_s = time.monotonic()
            cause(controller, supervisor)
            assert await fault_of(motion) is fault
            noticed_s = time.monotonic() - before_s
            assert reported == [fault]
            lost = await asyncio.to_thread(controller.ask, "state")
            if loss == "freeze":
                # The time of the controller stands still as well.
                await asyncio.to_thread(controller.ask, "restore")
            rest = await asyncio.to_thread(controller.wait, "at_rest")
            await asyncio.to_thread(controller.ask, "restore")
            await read_again(supervisor)
            assert supervisor.process_id not in (0, first_process)
            assert not supervisor.is_motion_enabled
            again = asyncio.create_task(supervisor.move_joints(NEAR, speed_rad_s=1.0, acceleration_rad_s2=4.0))
            assert await fault_of(again) is UrFault.NOT_ENABLED
            assert controller.state()["q"] == rest["q"]
            await supervisor.enable_motion(TOOL)
            await supervisor.move_joints(NEAR, speed_rad_s=1.0, acceleration_rad_s2=4.0)
            assert controller.state()["q"] == pytest.approx(NEAR)
    assert noticed_s < limit_s
    assert rest["q"][0] < FAR[0] - 0.5
    # Where nothing else reaches the controller, its watchdog stops the arm.
    assert loss != "cut" or "watchdog of input_int_register_0: stop" in rest["messages"]
    # The period of the watchdog, and the braking.
    assert rest["time_s"] - lost["time_s"] < 1.5


STOPS = {
    "protective_stop": (UrFault.PROTECTIVE_STOP, "unlockable", ("unlock protective stop",)),
    "emergency_stop": (UrFault.EMERGENCY_STOP, "at_rest", ("power on", "brake release")),
}


@pytest.mark.parametrize("stop", STOPS)
async def test_a_stop_of_the_controller_is_named_and_ended_by_a_person_alone(stop: str) -> None:
    """Motion cannot be enabled before."""
    fault, until, commands = STOPS[stop]
    with EmulatedController() as controller:
        async with UrSupervisor(controller.host, silence_s=SILENCE_S) as supervisor:
            motion = await start_motion(controller, supervisor)
            controller.ask(stop)
            assert await fault_of(motion) is fault
            with pytest.raises(UrFaultError) as caught:
                await supervisor.enable_motion(TOOL)
            assert caught.value.fault is fault
            assert caught.value.hint
            assert not supervisor.is_motion_enabled
            state = await asyncio.to_thread(controller.wait, until)
            assert state["safety_mode"] != "NORMAL"
            controller.ask("release_emergency_stop")
            for command in commands:
                press(controller.host, command)
            async with supervisor.readings:
                await supervisor.readings.wait_for(
                    lambda: (
                        supervisor.latest is not None
                        and supervisor.latest.robot_mode == 7
                        and supervisor.latest.safety_bits == 1
                    )
                )
            await supervisor.enable_motion(TOOL)
            await supervisor.move_joints(NEAR, speed_rad_s=1.0, acceleration_rad_s2=4.0)
            assert controller.state()["q"] == pytest.approx(NEAR)


async def test_a_second_client_and_local_control_are_named() -> None:
    """By what the library says of them."""
    with EmulatedController(series="e", model="ur10e") as controller:
        async with UrSupervisor(controller.host, silence_s=SILENCE_S) as supervisor:
            controller.ask("remote", value=0)
            with pytest.raises(UrFaultError) as local:
                await supervisor.enable_motion(TOOL)
            controller.ask("remote", value=1)
            with ClientLibrary(controller.host) as other:
                await asyncio.to_thread(other.call, "control.open")
                with pytest.raises(UrFaultError) as used:
                    await supervisor.enable_motion(TOOL)
    assert (local.value.fault, used.value.fault) == (UrFault.LOCAL_CONTROL, UrFault.IN_USE)


async def test_a_controller_that_is_not_there_is_named() -> None:
    """Where nobody listens."""
    with pytest.raises(UrFaultError) as caught:
        async with UrSupervisor("127.0.0.254"):
            pass
    assert caught.value.fault is UrFault.UNREACHABLE_CONTROLLER
