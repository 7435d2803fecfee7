"""What the script client has read of a controller, it reads again of the capture."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from pathlib import Path

import msgspec
import pytest

from robots.drivers.arm.joint_controller import ControllerReading
from robots.drivers.universal_robots.ur_options import UrOptions
from robots.drivers.universal_robots.ur_script_controller import UrScriptController
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from tests.robots.drivers.arm_under_test import PATIENT
from tests.robots.drivers.emulated_device import replayed
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController

MOST_SILENT = 2000
"""So many waits of two periods, half a minute and more, are no slow machine any more."""


def readings(controller: UrScriptController) -> Iterator[ControllerReading]:
    """Yield what the controller sends; ends where it has long been silent."""
    silent = 0
    while silent < MOST_SILENT:
        reading = controller.read()
        silent = silent + 1 if reading is None else 0
        if reading is not None:
            yield reading


def read_until_stopped(
    host: str, capture: WireCapture = NO_CAPTURE, stop: Callable[[], object] = lambda: None, **ports: object
) -> tuple[ControllerReading, ControllerReading]:
    """Return the first reading, and the first one of a controller that has stopped, which may be the same."""
    given = {"kind": "universal_robots", "host": host, "client": "script", "ports": ports, **PATIENT}
    controller = UrScriptController(msgspec.convert(given, UrOptions), capture)
    controller.connect()
    try:
        first = last = next(readings(controller))
        stop()
        while not last.stopped_by:
            last = next(readings(controller))
        return first, last
    finally:
        controller.close()


def test_a_controller_that_stopped_stops_again(tmp_path: Path) -> None:
    capture = WireCapture(tmp_path, device="arm")
    with EmulatedController() as emulator:
        before = read_until_stopped(emulator.host, capture, lambda: emulator.ask("protective_stop"))
    capture.close()
    gc.collect()
    (file,) = tmp_path.glob("arm.ur_outputs.*")
    with replayed(file) as replay:
        after = read_until_stopped(str(replay.place["host"]), rtde=replay.place["port"])
        assert replay.do("state")["mismatch"] == ""
    assert before[1].stopped_by == after[1].stopped_by == "protective stop: the controller has stopped the arm"
    assert after[0].position_rad == pytest.approx(before[0].position_rad)
    assert after[1].position_rad == pytest.approx(before[1].position_rad)
