"""The gripper texts: confirmed, silent, refused and lost, against the emulated gripper program."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Generator
from typing import Any

import pytest

from engine.errors import RobotError
from robots.drivers.abb import gripper_switch
from robots.drivers.abb.abb_options import GripperStrings
from robots.drivers.abb.gripper_switch import GripperSwitch
from robots.drivers.abb.state_transport import connected as new_connection
from robots.io.wire.tcp_connection import TcpConnection
from tests.robots.drivers.abb.emulated_irc5 import EmulatedIrc5, connected, emulated


@pytest.fixture(scope="module")
def emulator() -> Generator[EmulatedIrc5]:
    """The emulator of this file."""
    with emulated() as started:
        yield started


@pytest.mark.parametrize(("reply", "expected"), [("", "none"), ("ON", "any"), ("done", "done"), ("x", "none")])
def test_a_switch_is_sent_and_confirmed_as_configured(emulator: EmulatedIrc5, reply: str, expected: str) -> None:
    async def scenario() -> None:
        emulator.do("gripper_reply", text=reply)
        async with connected(emulator, gripper=emulator.gripper(reply=expected)) as connection:
            outputs = connection.outputs
            assert isinstance(outputs, GripperSwitch)
            for on in (True, False, True):
                outputs.set(0, on=on)
                await outputs.confirmed()
                assert outputs.values == (on,)
                await connection.report(readings=1)
                assert emulator.do("state")["gripper_on"] is on

    asyncio.run(scenario())


@pytest.mark.parametrize(
    ("reply", "expected", "reason"),
    [
        ("", "any", "gripperON was not confirmed: controller silent: no reply within 0.5 s"),
        ("", "done", "gripperON was not confirmed: controller silent: no reply within 0.5 s"),
        ("fault", "done", "gripperON was not confirmed: refused: the reply was 'fault', expected 'done'"),
    ],
)
def test_a_missing_or_other_reply_is_an_error_and_needs_a_person(
    emulator: EmulatedIrc5, reply: str, expected: str, reason: str
) -> None:
    async def scenario() -> None:
        emulator.do("gripper_reply", text=reply)
        async with connected(emulator, gripper=emulator.gripper(reply=expected, reply_s=0.5)) as connection:
            outputs = connection.outputs
            assert isinstance(outputs, GripperSwitch)
            outputs.set(0, on=True)
            with pytest.raises(RobotError) as refused:
                await outputs.confirmed()
            assert refused.value.message == f"{reason}; the gripper may have switched"
            assert outputs.values == (False,)
            emulator.do("gripper_reply", text="done")
            switched = emulator.do("state")["switched"]
            with pytest.raises(RobotError):
                outputs.set(0, on=True)
            assert emulator.do("state")["switched"] == switched
            await connection.enable()
            outputs.set(0, on=True)
            if expected == "done":
                await outputs.confirmed()
                assert outputs.values == (True,)

    asyncio.run(scenario())


def test_only_output_0_exists_and_only_while_motion_is_enabled(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        emulator.do("gripper_reply", text="")
        async with connected(emulator, enable=False, gripper=emulator.gripper()) as connection:
            outputs = connection.outputs
            assert isinstance(outputs, GripperSwitch)
            with pytest.raises(RobotError, match="motion is not enabled"):
                outputs.set(0, on=True)
            await connection.enable()
            with pytest.raises(RobotError, match="there is no output 1"):
                outputs.set(1, on=True)
            outputs.set(0, on=True)
            emulator.do("estop", on=True)
            await connection.report(readings=3)
            with pytest.raises(RobotError, match="emergency stop, and motion was not enabled since"):
                outputs.set(0, on=False)
            assert outputs.values == (True,)

    asyncio.run(scenario())


def test_a_fault_while_a_reply_is_awaited_ends_the_waiting(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        emulator.do("gripper_reply", text="")
        async with connected(emulator, gripper=emulator.gripper(reply="any", reply_s=10.0)) as connection:
            outputs = connection.outputs
            assert isinstance(outputs, GripperSwitch)
            outputs.set(0, on=True)
            awaited = asyncio.ensure_future(outputs.confirmed())
            emulator.do("drives", on=False)
            with pytest.raises(RobotError, match="gripperON was not confirmed: link cut: drives off"):
                await awaited

    asyncio.run(scenario())


def test_a_gripper_that_is_not_there_forbids_nothing_silently(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator, enable=False, gripper=emulator.gripper()) as connection:
            emulator.do("close_port", port="gripper")
            with pytest.raises(RobotError, match="link cut: cannot connect"):
                await connection.enable()
            assert connection.problem == "motion is not enabled"
            emulator.do("restore")
            await connection.enable()

    asyncio.run(scenario())


def test_without_gripper_options_there_are_no_outputs(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with connected(emulator, enable=False) as connection:
            assert connection.outputs is None

    asyncio.run(scenario())


def test_a_switch_that_is_given_up_while_it_is_connected_switches_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fault is noticed on the event loop, and connecting has a thread of its own."""

    def connected_late(*where: Any) -> TcpConnection:
        connection = new_connection(*where)
        switch.close("emergency stop, and motion was not enabled since")
        return connection

    with socket.create_server(("127.0.0.1", 0)) as listener:
        strings = GripperStrings(port=listener.getsockname()[1])
        switch = GripperSwitch("127.0.0.1", strings, timeout_s=30.0)
        monkeypatch.setattr(gripper_switch, "connected", connected_late)
        with pytest.raises(RobotError, match="given up while it was connected: emergency stop"):
            switch.connect()
        with pytest.raises(RobotError, match="emergency stop, and motion was not enabled since"):
            switch.set(0, on=True)
        with listener.accept()[0] as client:
            client.settimeout(30.0)
            assert client.recv(100) == b""
