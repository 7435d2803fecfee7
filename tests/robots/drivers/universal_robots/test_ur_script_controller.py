"""The control program of the script client, paused by a person or by a safeguard, and resumed without its driver."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from robots.drivers.universal_robots.ur_options import UrOptions
from robots.drivers.universal_robots.ur_script_controller import UrScriptController
from tests.robots.drivers.arm_under_test import PATIENT, START
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController
from tests.robots.drivers.universal_robots.faulty_ur_arm import press


def test_a_program_that_a_person_resumes_neither_moves_the_arm_nor_switches_an_output() -> None:
    """The last set point and output may have been sent before the driver has seen the pause."""
    with EmulatedController() as emulator:
        options = msgspec.convert(
            {"kind": "universal_robots", "host": emulator.host, "client": "script", **PATIENT}, UrOptions
        )
        controller = UrScriptController(options)
        controller.connect()
        try:
            while controller.read() is None:
                pass
            controller.enable(tcp_xyz_m=np.zeros(3), load_kg=0.0, load_com_m=np.zeros(3))
            controller.command(START, np.zeros(6))
            assert press(emulator.host, "pause") == "Pausing program"
            controller.set_output(3, on=True)
            controller.command(START + 0.1, np.zeros(6))
            while (reading := controller.read()) is None or not reading.stopped_by:
                pass
            assert reading.stopped_by.startswith("program paused: ")
            before = emulator.state()
            assert press(emulator.host, "play") == "Starting program"
            after = emulator.wait("stopped")
            assert after["q"] == pytest.approx(before["q"], abs=1e-4)
            assert after["digital_outputs"] == before["digital_outputs"] == 0
        finally:
            controller.stop()
            controller.close()
