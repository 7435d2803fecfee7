"""Arms on captures of their connections: an IRC5 with its ports, and a servo arm that its watchdog stops."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import msgspec
import numpy as np
import pytest
from msgspec.structs import replace

from engine.clock import new_clock
from robots.drivers.abb.abb_options import AbbOptions, GripperStrings
from robots.drivers.abb.new_abb_irc5 import new_abb_irc5
from robots.drivers.arm.joint_controller import MotionRefused
from robots.drivers.servo_arm.servo_arm_controller import ServoArmController
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.model import robot_model
from robots.port import MotionEnd
from tests.robots.drivers.abb.emulated_irc5 import ARM, TOLERANCE, emulated, straight
from tests.robots.drivers.emulated_device import replayed
from tests.robots.drivers.servo_arm.emulated_arm import emulated_servo_arm, enabled, read

Inject = Callable[[], object]


def nothing() -> None:
    """What happened is in the capture already."""


def captured(folder: Path, protocol: str) -> Path:
    (file,) = folder.glob(f"arm.{protocol}.*")
    return file


async def move_until_fault(options: AbbOptions, capture: WireCapture, inject: Inject) -> tuple[MotionEnd, str]:
    """Switch the gripper, then move; something happens in the middle."""
    connection = new_abb_irc5(
        options, name=ARM, clock=new_clock(), model=robot_model("irb4600"), engine_silence_s=5.0, capture=capture
    )
    await connection.open()
    try:
        await connection.enable()
        assert connection.outputs is not None
        connection.outputs.set(0, on=True)
        # States come unasked: a replay has them at their times, and the motion has to start at the same one.
        await connection.report(readings=5)
        start = connection.port.sample().position_rad
        motion = connection.port.follow(straight(start, start + 0.4, duration_s=4.0), tolerance=TOLERANCE)
        while connection.port.sample().position_rad[0] < start[0] + 0.1:
            await connection.report(readings=1)
        inject()
        report = await motion.report()
        return report.end, report.reason
    finally:
        await connection.close()


def test_an_irc5_with_an_emergency_stop_has_it_again(tmp_path: Path) -> None:
    """The download has the same points again, as the arm starts where it was measured."""
    capture = WireCapture(tmp_path, device=ARM)
    with emulated() as irc5:
        options = irc5.driver_options(gripper=irc5.gripper(), stale_s=3.0, timeout_s=2.0)
        before = asyncio.run(move_until_fault(options, capture, lambda: irc5.do("estop", on=True)))
    capture.close()
    with ExitStack() as stack:
        motion, state, switch = (
            stack.enter_context(replayed(captured(tmp_path, protocol), pace=1.0, host=irc5.place["host"]))
            for protocol in ("simple_message_motion", "simple_message_state", "gripper_text")
        )
        options = replace(
            options,
            motion_port=motion.place["port"],
            state_port=state.place["port"],
            gripper=GripperStrings(port=switch.place["port"]),
        )
        after = asyncio.run(move_until_fault(options, NO_CAPTURE, nothing))
        found = motion.do("state")
        assert (found["mismatch"], found["remaining_commands"]) == ("", 0)
        assert switch.do("state")["answered"] == 1
    assert before[0] is MotionEnd.FAILED
    assert before[1].startswith("emergency stop: ")
    assert after == before


def halt_in_motion(device: str, capture: WireCapture, inject: Inject) -> tuple[str, list[float]]:
    """Enable, move, and move again after something has happened; return why that was refused, and the angles."""
    given = {"kind": "servo_arm", "device": device, "boot_s": 2.0, "stale_s": 2.0}
    controller = ServoArmController(msgspec.convert(given, ServoArmOptions), tap=capture.tap("servo_lines"))
    controller.connect()
    try:
        enabled(controller)
        set_point = read(controller).position_rad
        for _ in range(20):
            set_point = set_point + 0.01
            controller.command(set_point, np.zeros(2))
            read(controller)
        inject()
        while not (reading := read(controller)).stopped_by:
            pass
        with pytest.raises(MotionRefused) as refused:
            controller.command(set_point, np.zeros(2))
        return str(refused.value), np.degrees(reading.position_rad).round(1).tolist()
    finally:
        controller.close()


def test_a_board_that_was_reset_in_a_motion_is_reset_again(tmp_path: Path) -> None:
    capture = WireCapture(tmp_path, device=ARM)
    with emulated_servo_arm("tcp") as board:
        before = halt_in_motion(board.serial_device, capture, lambda: board.do("reset"))
    capture.close()
    with replayed(captured(tmp_path, "servo_lines")) as replay:
        after = halt_in_motion(replay.serial_device, NO_CAPTURE, nothing)
        assert replay.do("state")["mismatch"] == ""
    assert "the board has restarted" in before[0]
    assert after == before
