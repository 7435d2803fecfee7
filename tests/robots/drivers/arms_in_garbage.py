"""Arms of an emulated cell, which has physics, with relays for garbage between their drivers and their controllers."""

from __future__ import annotations

import asyncio
import json
import socket
import subprocess
from collections.abc import AsyncGenerator, Generator, Mapping
from contextlib import asynccontextmanager, contextmanager
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from robots.drivers.abb.abb_faults import AbbLinkError
from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.egm.egm_messages import decode_set_point
from robots.drivers.abb.egm.new_egm_arm import new_egm_arm
from robots.drivers.abb.new_abb_irc5 import about_driver
from robots.drivers.universal_robots.rtde_codec import RtdePacketError, split_packets
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.abb.guided_irc5 import GUIDED_MODEL, GUIDED_NEAR, GUIDED_START, PLACEMENT
from tests.robots.drivers.arm_under_test import MODEL, NEAR, START, new_connection
from tests.robots.drivers.garbage_relay import DatagramRelay, Spoiler, StreamRelay
from tests.robots.drivers.motions_in_garbage import MovedArm, TrueState
from tests.robots.own_address import own_address
from tests.robots.sim.sim_cell import PATIENT_S

_CELL = """\
flexcell: 1
cell: garbage
world: {kind: mujoco, engine_silence_s: 10.0, world_silence_s: 10.0}
robots:
  arm: {model: %s, driver: %s}
"""
_EGM_PORT = 6510
_RTDE_PORT, _RELAYED_PORT = 30004, 31004
_START_S = 120.0
_STALE_S = 1.0


@contextmanager
def _emulated(folder: Path, model: str, driver: Mapping[str, Any]) -> Generator[socket.socket]:
    """Start the emulated cell and return the side channel of its arm."""
    file = folder / "cell.yaml"
    file.write_text(_CELL % (model, json.dumps(driver)), encoding="utf-8")
    command = [FLEXCELL, "emulate", "cell", f"file={file}"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            arm = json.loads(process.stdout.readline())["ready"]["devices"]["arm"]
            port = arm.get("side_port", arm.get("side_channel"))
            with socket.create_connection((driver["host"], port), timeout=_START_S) as side:
                yield side
        finally:
            process.terminate()
            process.wait(_START_S)


def _ask(side: socket.socket) -> dict[str, Any]:
    side.sendall(b'{"do": "state"}\n')
    received = b""
    while not received.endswith(b"\n"):
        received += side.recv(65536)
    return json.loads(received)


@asynccontextmanager
async def guided_in_garbage(folder: Path, *, seed: int) -> AsyncGenerator[MovedArm]:
    """An IRC5 with Externally Guided Motion: measurements are spoiled, answers get garbage that is no set point."""
    host = own_address()
    first, _, last = host.rpartition(".")
    inner = f"{first}.{int(last) + 1}"
    egm = {"port": _EGM_PORT, "address": inner, "stale_s": _STALE_S, "start_s": 20.0, "process_silence_s": 10.0}
    driver = {"kind": "abb_irc5", "host": host, "loads": "defined_there", "egm": egm}
    to_device = Spoiler(seed + 1, harmless=_is_no_set_point)
    with (
        _emulated(folder, "irb4600", driver) as side,
        DatagramRelay(
            (inner, _EGM_PORT),
            controller=host,
            driver=(host, _EGM_PORT),
            to_driver=Spoiler(seed),
            to_device=to_device,
        ) as relay,
    ):
        options = msgspec.convert({**driver, "egm": {**egm, "address": host}}, AbbOptions)
        assert options.egm is not None
        about = about_driver(options, name="arm")
        connection = new_egm_arm(
            options, options.egm, name="arm", arm=PLACEMENT, about=about, engine_silence_s=PATIENT_S
        )

        def state() -> TrueState:
            true = _ask(side)
            joints = np.array(true["joints_rad"])
            return TrueState(time_s=true["time_s"], joints_rad=joints, ended_s=true["egm"]["last_heard_s"])

        await connection.open()
        try:
            yield MovedArm(
                connection=connection,
                limits=GUIDED_MODEL.limits,
                start=GUIDED_START,
                goal=GUIDED_NEAR,
                state=state,
                spoil=relay.spoil,
                garbage=lambda: relay.to_driver.garbage + relay.to_device.garbage,
            )
        finally:
            relay.spoil(0.0)
            await connection.close()


@asynccontextmanager
async def ur_in_garbage(folder: Path, *, seed: int) -> AsyncGenerator[MovedArm]:
    """A UR10 with `client: script`: both RTDE connections get garbage, that to the controller is no packet of it."""
    host = own_address()
    driver = {"kind": "universal_robots", "host": host, "client": "script"}
    with (
        _emulated(folder, "ur10", driver) as side,
        StreamRelay(
            (host, _RELAYED_PORT),
            inner=(host, _RTDE_PORT),
            to_driver=Spoiler(seed),
            to_device=Spoiler(seed + 1, harmless=_is_no_packet),
        ) as relay,
    ):
        connection = new_connection(
            host, client="script", ports={"rtde": _RELAYED_PORT}, watchdog_hz=10.0, stale_s=_STALE_S
        )

        def state() -> TrueState:
            true = _ask(side)
            return TrueState(time_s=true["time_s"], joints_rad=np.array(true["q"]), ended_s=true["written_s"])

        await connection.open()
        try:
            # Its home is another one than that of an emulator alone.
            start = (await asyncio.to_thread(state)).joints_rad
            yield MovedArm(
                connection=connection,
                limits=MODEL.limits,
                start=start,
                goal=start + NEAR - START,
                state=state,
                spoil=relay.spoil,
                garbage=lambda: relay.to_driver.garbage + relay.to_device.garbage,
            )
        finally:
            relay.spoil(0.0)
            await connection.close()


def _is_no_set_point(packet: bytes) -> bool:
    """Whether a controller must not follow it: one that can be read is followed, whoever has sent it."""
    try:
        decode_set_point(packet)
    except AbbLinkError:
        return True
    return False


def _is_no_packet(received: bytes) -> bool:
    """Whether a controller must not act on it: packets have no checksum, and a changed set point is one too."""
    try:
        return not list(split_packets(bytearray(received)))
    except RtdePacketError:
        return True
