"""The controller of a servo arm on its emulator: set points, what is measured, and each fault by name."""

from __future__ import annotations

import json
import math
import re
import time

import msgspec
import numpy as np
import pytest

from robots.drivers.arm.joint_controller import ControllerLost, JointController, MotionRefused
from robots.drivers.servo_arm.servo_arm_controller import joint_angles, new_servo_arm_controller, servo_angles
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions, ServoCalibration
from robots.model.registry import robot_model
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.servo_arm.emulated_arm import (
    HOME_RAD,
    LINES,
    SPEED_RAD_S,
    controlled,
    emulated_servo_arm,
    enabled,
    move,
)

GOAL_RAD = np.radians([40.0, -20.0])
FAR_RAD = np.radians([170.0, -140.0])


def until_refused(controller: JointController) -> str:
    """Send set points towards a far goal until the controller refuses one or is lost, and return the cause."""
    limit_s = time.monotonic() + 30.0
    while time.monotonic() < limit_s:
        try:
            move(controller, FAR_RAD, steps=5)
        except (MotionRefused, ControllerLost) as error:
            return str(error)
    raise AssertionError("nothing was refused")


@pytest.mark.parametrize("connection", LINES)
def test_set_points_move_the_servos_and_the_answers_are_the_position(connection: str) -> None:
    with emulated_servo_arm(connection) as emulator, controlled(emulator) as controller:
        assert controller.read().position_rad == pytest.approx(HOME_RAD, abs=1e-3)
        reading = move(controller, GOAL_RAD)
        # A tenth of a degree on the wire.
        assert reading.position_rad == pytest.approx(GOAL_RAD, abs=math.radians(0.06))
        assert (reading.stopped_by, reading.wrench) == ("", None)
        # The elbow's servo stands 150 degrees off the joint.
        assert emulator.do("state")["angles_deg"] == pytest.approx([40.0, 130.0], abs=0.06)


@pytest.mark.parametrize("connection", LINES)
def test_connecting_moves_nothing_and_says_what_is_measured(connection: str) -> None:
    with emulated_servo_arm(connection) as emulator, controlled(emulator, enable=False) as controller:
        reading = controller.read()
        assert reading.stopped_by == "motion is not enabled"
        with pytest.raises(MotionRefused, match="motion is not enabled"):
            controller.command(GOAL_RAD, np.zeros(2))
        state = emulator.do("state")
        assert (state["halt"], state["commands"], state["travel"]) == ("boot", 0, 0.0)
    with emulated_servo_arm(connection) as emulator:
        device = {"kind": "servo_arm", "device": emulator.serial_device, "boot_s": 1.0}
        fresh = new_servo_arm_controller(json.dumps(device).encode())
        identity = fresh.connect()
        fresh.close()
        assert identity.notes == ("positions are those that the board writes to its servos, which report none",)


def test_an_arm_that_lags_behind_is_measured_behind() -> None:
    """The board limits the speed; the reading is what it has written so far, with the speed of that."""
    with emulated_servo_arm("serial", max_deg_s=5.0) as emulator, controlled(emulator) as controller:
        reading = move(controller, GOAL_RAD, steps=25)
        asked, measured = SPEED_RAD_S * 25 * controller.period_s, reading.position_rad[0]
        assert 0.0 < measured < 0.8 * asked


@pytest.mark.parametrize("connection", LINES)
@pytest.mark.parametrize(
    ("fault", "values", "cause"),
    [
        ("unplug", {}, r"the serial line failed"),
        ("freeze", {}, r"no valid answer for 1\.\d\d s; check"),
        ("slow", {"seconds": 3.0}, r"no valid answer for 1\.\d\d s; check"),
        ("garbage", {}, r"no valid answer for 1\.\d\d s, but bytes that are no answer"),
        ("reset", {}, r"the board has restarted|the board has started and is not enabled"),
        ("error", {"words": "servo 2"}, r"the board refused a line: servo 2"),
    ],
)
def test_a_fault_in_motion_has_a_name_and_the_servos_come_to_rest(
    connection: str, fault: str, values: dict[str, object], cause: str
) -> None:
    with emulated_servo_arm(connection) as emulator, controlled(emulator) as controller:
        move(controller, GOAL_RAD, steps=20)
        emulator.do(fault, **values)
        reason = until_refused(controller)
        assert re.search(cause, reason), reason
        await_rest(emulator)


def await_rest(emulator: EmulatedProcess) -> None:
    """Wait until the servos rest; their watchdog is half a second."""
    limit_s = time.monotonic() + 10.0
    while emulator.do("state")["moving"]:
        assert time.monotonic() < limit_s, "the servos do not rest"


def test_a_silent_engine_is_stopped_by_the_board_and_a_person_enables_it_again() -> None:
    with emulated_servo_arm("serial", max_deg_s=20.0) as emulator, controlled(emulator) as controller:
        move(controller, GOAL_RAD, steps=20)
        # One set point far ahead, and then silence.
        controller.command(np.radians([150.0, -20.0]), np.zeros(2))
        begun_s = time.monotonic()
        while emulator.do("state")["halt"] != "watchdog":
            assert time.monotonic() - begun_s < 10.0
        stopped = emulator.do("state")
        assert stopped["angles_deg"][0] < 60.0
        assert until_refused(controller) == "the watchdog of the board: no line came for too long"
        assert emulator.do("state")["angles_deg"] == stopped["angles_deg"]
        enabled(controller)
        assert move(controller, GOAL_RAD).position_rad == pytest.approx(GOAL_RAD, abs=math.radians(0.06))


def test_a_stop_holds_the_servos_where_they_are() -> None:
    with emulated_servo_arm("serial", max_deg_s=20.0) as emulator, controlled(emulator) as controller:
        controller.read()
        controller.command(GOAL_RAD, np.zeros(2))
        while not emulator.do("state")["moving"]:
            controller.read()
        controller.stop()
        reading = controller.read()
        assert reading.stopped_by.startswith("stopped")
        await_rest(emulator)
        state = emulator.do("state")
        assert state["halt"] == "stop"
        assert 0.0 < state["angles_deg"][0] < 39.0


@pytest.mark.parametrize("connection", LINES)
def test_a_line_that_is_plugged_in_again_restores_reading_only(connection: str) -> None:
    with emulated_servo_arm(connection) as emulator:
        with controlled(emulator) as controller:
            move(controller, GOAL_RAD, steps=20)
            emulator.do("unplug")
            until_refused(controller)
        place = emulator.do("plug")
        emulator.place.update({key: place[key] for key in ("device", "host", "port") if key in place})
        before = emulator.do("state")
        with controlled(emulator, enable=False) as controller:
            assert controller.read().stopped_by == "motion is not enabled"
            after = emulator.do("state")
            assert (after["commands"], after["travel"]) == (before["commands"], before["travel"])
            enabled(controller)
            move(controller, GOAL_RAD, steps=20)
            assert emulator.do("state")["travel"] > before["travel"]


def test_a_board_that_answers_nothing_moves_and_its_position_is_what_was_commanded() -> None:
    with (
        emulated_servo_arm("tcp", sketch="bare") as emulator,
        controlled(emulator, sketch="bare", boot_s=0.5) as controller,
    ):
        reading = move(controller, np.radians([40.4, -20.0]), steps=200)
        # Whole degrees on the wire, and no more than they are measured.
        assert reading.position_rad == pytest.approx(np.radians([40.0, -20.0]), abs=1e-6)
        await_rest(emulator)
        assert emulator.do("state")["angles_deg"] == pytest.approx([40.0, 130.0])


def test_a_set_point_beyond_a_servo_is_refused_before_it_is_sent() -> None:
    with emulated_servo_arm("serial") as emulator, controlled(emulator) as controller:
        controller.read()
        with pytest.raises(MotionRefused, match=r"servo 2 cannot turn to 190\.0°: it turns from 0° to 180°"):
            controller.command(np.radians([0.0, 40.0]), np.zeros(2))
        assert emulator.do("state")["commands"] == 0


def test_the_calibration_by_default_is_that_of_the_model() -> None:
    servos = msgspec.convert({"kind": "servo_arm", "device": "/dev/null"}, ServoArmOptions).servos
    arm = robot_model("servo_arm", gripper=None)
    home = np.array(arm.home_rad)
    assert servo_angles(home, servos) == pytest.approx(np.degrees(arm.joint_map.to_device(home)))
    assert [servo.home_deg for servo in servos] == pytest.approx(servo_angles(home, servos))


def test_the_claw_is_the_only_output() -> None:
    with emulated_servo_arm("serial", max_deg_s=500.0) as emulator, controlled(emulator) as controller:
        controller.set_output(0, on=True)
        # As the board reads it back.
        assert controller.read().outputs == (True,)
        await_rest(emulator)
        assert emulator.do("state")["claw_deg"] == 45.0
        controller.set_output(0, on=False)
        controller.read()
        await_rest(emulator)
        assert emulator.do("state")["claw_deg"] == 90.0
        with pytest.raises(MotionRefused, match="no output 3"):
            controller.set_output(3, on=True)


def test_a_line_that_is_not_there_says_what_to_check() -> None:
    controller = new_servo_arm_controller(b'{"kind": "servo_arm", "device": "/dev/does-not-exist"}')
    with pytest.raises(ControllerLost, match=r"cannot connect: .*check cable and supply"):
        controller.connect()


@pytest.mark.parametrize(
    "calibration",
    [ServoCalibration(), ServoCalibration(offset_deg=150.0), ServoCalibration(scale=-2.0, offset_deg=90.0)],
)
def test_angles_of_joints_and_servos_are_converted_both_ways(calibration: ServoCalibration) -> None:
    for angle in np.radians([-30.0, 0.0, 12.5]):
        turned = servo_angles(np.array([angle]), (calibration,))
        assert joint_angles(turned, (calibration,)) == pytest.approx([angle])
    assert servo_angles(np.radians([10.0]), (ServoCalibration(scale=-2.0, offset_deg=90.0),)) == pytest.approx((70.0,))
