"""An emulated servo arm as a program of its own, and the controller on it."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import AbstractContextManager, contextmanager

import msgspec
import numpy as np

from robots.drivers.arm.joint_controller import ControllerReading, JointController
from robots.drivers.servo_arm.servo_arm_controller import ServoArmController
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions
from robots.port import Array
from tests.robots.drivers.emulated_device import EmulatedProcess, emulated_device

LINES = ("tcp", "serial")
HOME_RAD = np.radians([0.0, 10.0])
SPEED_RAD_S = 0.5


def emulated_servo_arm(connection: str, **options: object) -> AbstractContextManager[EmulatedProcess]:
    """Start an emulator."""
    return emulated_device("servo_arm", connection, **options)


@contextmanager
def controlled(emulator: EmulatedProcess, *, enable: bool = True, **options: object) -> Generator[ServoArmController]:
    """The controller, connected to an emulator."""
    # A loaded machine gets more time than an arm by default; a pty resets no board.
    boot_s = 2.0 if emulator.place["connection"] == "tcp" else 0.1
    given = {"kind": "servo_arm", "device": emulator.serial_device, "boot_s": boot_s, "stale_s": 1.0, **options}
    controller = ServoArmController(msgspec.convert(given, ServoArmOptions))
    controller.connect()
    try:
        if enable:
            enabled(controller)
        yield controller
    finally:
        controller.close()


def enabled(controller: JointController) -> None:
    """Enable a controller without a tool or a load."""
    controller.enable(tcp_xyz_m=np.zeros(3), load_kg=0.0, load_com_m=np.zeros(3))


def read(controller: JointController) -> ControllerReading:
    """Return the next measurement, which this controller always has."""
    reading = controller.read()
    assert reading is not None
    return reading


def move(controller: JointController, goal_rad: Array, *, steps: int = 10_000) -> ControllerReading:
    """Send set points at constant speed until the goal is measured, or for so many periods."""
    reading = read(controller)
    set_point = reading.position_rad
    for _ in range(steps):
        most = SPEED_RAD_S * controller.period_s
        set_point = set_point + np.clip(goal_rad - set_point, -most, most)
        controller.command(set_point, np.zeros(2))
        reading = read(controller)
        # Less than the tenth of a degree that one step on the wire is.
        if np.abs(reading.position_rad - goal_rad).max() < 0.001:
            break
    return reading
