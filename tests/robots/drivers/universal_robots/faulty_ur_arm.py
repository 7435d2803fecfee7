"""An emulated Universal Robots controller with faults, over one of the driver's clients."""

from __future__ import annotations

import socket
from contextlib import AbstractAsyncContextManager, asynccontextmanager

from robots.drivers.arm.process_arm_connection import ProcessArmConnection
from robots.model.robot_model import JointLimits
from robots.port import Array
from tests.robots.drivers.arm_under_test import FAR, MODEL, START, new_connection
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_process_arm import ARM_OPTIONS, open_connection
from tests.robots.drivers.universal_robots.emulated_controller import ANSWER_LIMIT_S, EmulatedController


class FaultyUrArm:
    """Implements `tests.robots.drivers.faulty_process_arm.FaultyArm`."""

    def __init__(self, controller: EmulatedController, client: str) -> None:
        self._controller = controller
        self._client = client

    @property
    def limits(self) -> JointLimits:
        """Of its model."""
        return MODEL.limits

    @property
    def far(self) -> Array:
        """Where the first joint turns by 1.6 rad."""
        return FAR

    @property
    def start(self) -> Array:
        """Where the emulated arm stands when it is switched on."""
        return START

    def connected(self) -> AbstractAsyncContextManager[ProcessArmConnection]:
        """Connect the driver; its watchdog waits for a second."""
        connection = new_connection(
            self._controller.host,
            client=self._client,
            stale_s=ARM_OPTIONS["stale_s"],
            process_silence_s=ARM_OPTIONS["process_silence_s"],
        )
        return asynccontextmanager(open_connection)(connection)

    def do(self, case: FaultCase) -> None:
        """Cause the fault at the side channel, or as a person at the dashboard."""
        if case.do == "press":
            press(self._controller.host, str(case.values["command"]))
        else:
            self._controller.ask(case.do, **case.values)

    def restore(self, case: FaultCase) -> None:
        """End the fault, and what it has left at the controller."""
        controller = self._controller
        controller.ask(case.restore[0])
        state = controller.state()
        if state["safety_mode"] == "PROTECTIVE_STOP":
            controller.wait("unlockable")
            press(controller.host, "unlock protective stop")
        controller.ask("release_emergency_stop")
        if state["robot_mode"] != "RUNNING":
            press(controller.host, "power on")
            press(controller.host, "brake release")
        if state["runtime_state"] == "PAUSED":
            press(controller.host, "stop")

    def await_rest(self) -> float:
        """Wait for rest."""
        return float(self._controller.wait("at_rest")["time_s"])

    def time_s(self) -> float:
        """Return the time of the controller."""
        return float(self._controller.state()["time_s"])

    def position_rad(self) -> list[float]:
        """Return the true joint angles."""
        return list(self._controller.state()["q"])


def press(host: str, command: str) -> str:
    """Do what a person does at the dashboard."""
    with socket.create_connection((host, 29999), timeout=ANSWER_LIMIT_S) as connection:
        lines = connection.makefile("rw")
        lines.readline()
        lines.write(f"{command}\n")
        lines.flush()
        answer = lines.readline().strip()
        lines.close()
    return answer


def start_other(controller: EmulatedController) -> None:
    """Start another program, as a person does, and wait until it runs."""
    with socket.create_connection((controller.host, 30002), timeout=ANSWER_LIMIT_S) as connection:
        connection.sendall(b"def other():\n  while True:\n    sync()\n  end\nend\n")
        while controller.state()["program"] != "other":
            pass
