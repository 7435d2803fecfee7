"""Robot Web Services and guided motion of an IRC5 on captures: their faults come again; no capture has a password."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.egm.egm_arm_connection import EgmArmConnection
from robots.drivers.abb.egm.new_egm_arm import new_egm_arm
from robots.drivers.abb.new_abb_irc5 import about_driver
from robots.drivers.abb.rws.rws_monitor import RwsMonitor
from robots.drivers.abb.rws.rws_options import RwsOptions
from robots.io.wire.read_capture import read_capture
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.io.wire.wire_tap import NO_TAP, WireTap
from tests.robots.drivers.abb.emulated_irc5 import ARM, EGM_PORT, emulated
from tests.robots.drivers.abb.guided_irc5 import PLACEMENT
from tests.robots.drivers.emulated_device import replayed
from tests.robots.sim.sim_cell import PATIENT_S, until

PASSWORD = "an example of 20 characters"
Inject = Callable[[], object]


def nothing() -> None:
    """What happened is in the capture already."""


def captured(folder: Path, protocol: str) -> Path:
    (file,) = folder.glob(f"{ARM}.{protocol}.*")
    return file


async def recover(host: str, port: int, tap: WireTap) -> tuple[str, list[str]]:
    """Read who the controller is and that its motors are off, and recover it; return the state before and after."""
    options = RwsOptions(port=port, timeout_s=5.0, stale_s=10.0)
    monitor = RwsMonitor(ARM, host, options, password=PASSWORD, tap=tap)
    await monitor.open()
    try:
        found: list[str] = []
        for _ in range(2):
            assert monitor.state is not None
            found.append(f"{monitor.state.panel}, {monitor.state.execution}, {monitor.fault}")
            if monitor.fault is not None:
                await monitor.recover()
        return monitor.firmware, found
    finally:
        await monitor.close()


def test_a_controller_with_motors_off_is_recovered_again_and_its_capture_has_no_credentials(tmp_path: Path) -> None:
    capture = WireCapture(tmp_path, device=ARM)
    with emulated(rws_password=PASSWORD) as irc5:
        irc5.do("drives", on=False)
        place = irc5.place
        before = asyncio.run(recover(place["host"], place["rws_port"], capture.tap("rws")))
    capture.close()
    assert ["motoron" in each for each in before[1]] == [False, True]
    file = captured(tmp_path, "rws")
    written = file.read_bytes()
    assert written.count(b"(not captured)") > 4
    for secret in (PASSWORD.encode(), b"response=", b"username=", b"http-session", b"cnonce"):
        assert secret not in written
    with replayed(file, host=place["host"]) as replay:
        after = asyncio.run(recover(place["host"], replay.place["port"], NO_TAP))
        found = replay.do("state")
        assert (found["mismatch"], found["remaining_commands"]) == ("", 0)
    assert after == before


async def guide_until_stop(
    options: AbbOptions, capture: WireCapture, inject: Inject, *, readings: int
) -> tuple[list[float], str]:
    """Enable guided motion, hold for so many readings, and return where, and why motion is not permitted any more."""
    assert options.egm is not None
    about = about_driver(options, name=ARM)
    arm: EgmArmConnection = new_egm_arm(
        options,
        options.egm,
        name=ARM,
        arm=PLACEMENT,
        about=about,
        engine_silence_s=PATIENT_S,
        capture=capture,
    )
    await arm.open()
    try:
        await arm.enable()
        assert arm.problem == ""
        if readings:
            await arm.report(readings=readings)
        inject()
        await until(lambda: arm.problem != "")
        return arm.port.sample().position_rad.round(9).tolist(), arm.problem
    finally:
        await arm.close()


def test_guided_motion_that_an_emergency_stop_ends_is_ended_again(tmp_path: Path) -> None:
    """Both directions are captured in the control process of the arm; a replay takes any set points."""
    # Guided motion that ends and begins again by itself would not do so at the same answer.
    with emulated(egm=True, comm_timeout_s=10.0) as irc5:
        host = irc5.place["host"]
        egm = {"port": EGM_PORT, "address": host, "stale_s": 5.0, "start_s": 20.0, "process_silence_s": 10.0}
        options = irc5.driver_options(egm=egm)
        capture = WireCapture(tmp_path, device=ARM)
        # Enabling may take longer in the replay, where it is not waited for.
        before = asyncio.run(guide_until_stop(options, capture, lambda: irc5.do("estop", on=True), readings=30))
    file = captured(tmp_path, "egm")
    kinds = [each.kind for each in read_capture(file).events]
    assert min(kinds.count("sent"), kinds.count("received")) > 10
    with replayed(file, pace=1.0, host=host, receiver=host) as replay:
        after = asyncio.run(guide_until_stop(options, NO_CAPTURE, nothing, readings=0))
        found = replay.do("state")
        assert (found["mismatch"], found["answered"] >= 10) == ("", True)
    assert before[1].startswith("drives off: ")
    assert after == before
