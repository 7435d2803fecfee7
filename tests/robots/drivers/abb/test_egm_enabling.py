"""What a controller is answered while motion is enabled becomes its set point: it must be where the arm is."""

from __future__ import annotations

import socket
import threading
from collections.abc import Generator
from contextlib import contextmanager

import numpy as np
import pytest

from robots.drivers.abb.egm.egm_controller import EgmController, EgmProcessOptions
from robots.drivers.abb.egm.egm_messages import (
    EgmMeasurement,
    MciState,
    MotorState,
    RapidState,
    decode_set_point,
    encode_measurement,
)
from robots.drivers.abb.egm.egm_options import EgmOptions
from robots.drivers.arm.joint_controller import MotionRefused
from tests.robots.own_address import own_address

TRUE_DEG = (10.0, -20.0, 30.0, 0.0, 45.0, 90.0)
WRONG_DEG = (70.0, *TRUE_DEG[1:])
PORT = 6510
_WRONG = 4


class ControllerWithWrongMeasurements:
    """Sends measurements in a thread, some of `every` in a row wrong. `answers` are the set points that it got."""

    def __init__(self, host: str, *, every: int) -> None:
        self._every = every
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind((host, 0))
        self._socket.settimeout(0.002)
        self._driver = (host, PORT)
        self._ends = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self.answers: list[tuple[float, ...]] = []

    @contextmanager
    def running(self) -> Generator[None]:
        """Send until the end of the block."""
        self._thread.start()
        try:
            yield
        finally:
            self._ends.set()
            self._thread.join()
            self._socket.close()

    def _run(self) -> None:
        number = 0
        while not self._ends.is_set():
            number += 1
            is_wrong = number % self._every < _WRONG
            measurement = EgmMeasurement(
                number=number,
                time_ms=4 * number,
                measured_deg=WRONG_DEG if is_wrong else TRUE_DEG,
                motors=MotorState.ON,
                mci=MciState.RUNNING,
                rapid=RapidState.RUNNING,
            )
            try:
                self._socket.sendto(encode_measurement(measurement), self._driver)
                self.answers.append(decode_set_point(self._socket.recv(4096)).planned_deg)
            except OSError:
                continue  # no answer, or nobody listens yet


def enabled(every: int) -> tuple[list[tuple[float, ...]], str]:
    """Enable motion, and return the answers and why it is refused."""
    host = own_address()
    egm = EgmOptions(port=PORT, address=host, stale_s=5.0, start_s=1.0)
    identity = tuple(tuple(row) for row in np.eye(6).tolist())
    controller = EgmController(EgmProcessOptions(host=host, egm=egm, matrix=identity, offset_rad=(0.0,) * 6))
    sending = ControllerWithWrongMeasurements(host, every=every)
    refused = ""
    with sending.running():
        controller.connect()
        try:
            controller.enable(tcp_xyz_m=np.zeros(3), load_kg=0.0, load_com_m=np.zeros(3))
        except MotionRefused as error:
            refused = str(error)
        finally:
            controller.close()
    return sending.answers, refused


@pytest.mark.parametrize(("every", "refused"), [(12, "guided motion does not start within 1 s"), (40, "")])
def test_a_measurement_far_from_where_the_arm_rests_is_not_answered(every: int, refused: str) -> None:
    answers, reason = enabled(every)
    assert refused in reason
    assert bool(reason) is bool(refused)
    assert set(answers) <= {TRUE_DEG}
    assert answers or reason
