"""An emulated FR3 with faults."""

from __future__ import annotations

import time
from contextlib import AbstractAsyncContextManager

from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.model.robot_model import JointLimits
from robots.port import Array
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_process_arm import ARM_OPTIONS
from tests.robots.drivers.franka.emulated_cabinet import FR3_FAR, FR3_MODEL, FR3_START, connected_fr3

_REST_RAD_S = 0.01


class FaultyFr3:
    """Implements `tests.robots.drivers.faulty_process_arm.FaultyArm`."""

    def __init__(self, cabinet: EmulatedProcess) -> None:
        self._cabinet = cabinet

    @property
    def limits(self) -> JointLimits:
        """Of its model."""
        return FR3_MODEL.limits

    @property
    def far(self) -> Array:
        """Where the first joint turns by 1.4 rad."""
        return FR3_FAR

    @property
    def start(self) -> Array:
        """Where the emulated arm stands when it is switched on."""
        return FR3_START

    def connected(self) -> AbstractAsyncContextManager[ProcessArmConnection]:
        """Connect the driver."""
        return connected_fr3(self._cabinet, **ARM_OPTIONS)

    def do(self, case: FaultCase) -> None:
        """Cause the fault."""
        self._cabinet.do(case.do, **case.values)

    def restore(self, case: FaultCase) -> None:
        """End the fault, as a person does at the robot."""
        self._cabinet.do(case.restore[0], **case.restore[1])

    def await_rest(self) -> float:
        """Wait for rest, by what the simulator says: without its client the robot sends no states."""
        while float(self._cabinet.do("state")["fastest_rad_s"]) > _REST_RAD_S:
            pass
        return self.time_s()

    def time_s(self) -> float:
        """Return the time of this machine: that of the robot begins anew when it is restarted."""
        return time.monotonic()

    def position_rad(self) -> list[float]:
        """Return the true joint angles."""
        return list(self._cabinet.do("state")["joints_rad"])
