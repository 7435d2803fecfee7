"""An emulated servo arm with faults."""

from __future__ import annotations

import math
import time
from contextlib import AbstractAsyncContextManager, asynccontextmanager

import msgspec
import numpy as np

from engine.cell.drivers import DeviceReport
from engine.messages import Pose
from robots.drivers.arm.arm_process_messages import OpenController
from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions
from robots.model.registry import robot_model
from robots.model.robot_model import JointLimits
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_process_arm import ARM_OPTIONS, open_connection
from tests.robots.sim.sim_cell import PATIENT_S

_MODEL = robot_model("servo_arm", gripper=None)
_REST_LIMIT_S = 30.0


class FaultyServoArm:
    """Implements `tests.robots.drivers.faulty_process_arm.FaultyArm`."""

    def __init__(self, emulator: EmulatedProcess) -> None:
        self._emulator = emulator

    @property
    def limits(self) -> JointLimits:
        """Of its model."""
        return _MODEL.limits

    @property
    def far(self) -> Array:
        """Where the first joint turns by 1.6 rad."""
        return np.array((1.7, -0.4))

    @property
    def start(self) -> Array:
        """Near its home."""
        return np.array((0.1, 0.1))

    def connected(self) -> AbstractAsyncContextManager[ProcessArmConnection]:
        """Connect the driver."""
        device = self._emulator.serial_device
        given = {"kind": "servo_arm", "device": device, "boot_s": 0.1, **ARM_OPTIONS}
        options = msgspec.convert(given, ServoArmOptions)
        request = OpenController(
            arm=ArmPlacement(name="arm", model="servo_arm", base=Pose(xyz=(0.0, 0.0, 0.0)), gripper=None),
            controller="robots.drivers.servo_arm.servo_arm_controller:new_servo_arm_controller",
            options=msgspec.json.encode(options),
            stale_s=options.stale_s,
            engine_silence_s=PATIENT_S,
        )
        connection = ProcessArmConnection(
            request,
            model=_MODEL,
            address=device,
            about=DeviceReport(device="arm", driver="servo_arm", address=device),
            silence_s=options.process_silence_s,
            new_stop_line=None,
            outputs=1,
        )
        return asynccontextmanager(open_connection)(connection)

    def do(self, case: FaultCase) -> None:
        """Cause the fault."""
        self._emulator.do(case.do, **case.values)

    def restore(self, case: FaultCase) -> None:
        """End the fault."""
        self._emulator.do(case.restore[0], **case.restore[1])

    def await_rest(self) -> float:
        """Wait until nothing is written to the servos any more."""
        limit_s = time.monotonic() + _REST_LIMIT_S
        while self._emulator.do("state")["moving"]:
            assert time.monotonic() < limit_s, "the servos do not rest"
        return float(self._emulator.do("state")["moved_s"])

    def time_s(self) -> float:
        """Return the time of the board."""
        return float(self._emulator.do("state")["time_s"])

    def position_rad(self) -> list[float]:
        """Return what is written to the servos, as joint angles."""
        base_deg, elbow_deg = self._emulator.do("state")["angles_deg"]
        return [math.radians(base_deg), math.radians(elbow_deg - 150.0)]
