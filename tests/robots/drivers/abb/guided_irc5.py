"""The driver with Externally Guided Motion on an emulated IRC5."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncGenerator, Mapping
from contextlib import asynccontextmanager
from typing import Any

import numpy as np
from msgspec.structs import replace

from engine.messages import Pose
from robots.drivers.abb.abb_options import GripperStrings
from robots.drivers.abb.egm.egm_arm_connection import EgmArmConnection
from robots.drivers.abb.egm.new_egm_arm import new_egm_arm
from robots.drivers.abb.new_abb_irc5 import about_driver
from robots.model.registry import robot_model
from robots.model.robot_model import JointLimits
from robots.port import Array
from robots.scene.sim_scene import ArmPlacement
from tests.robots.drivers.abb.emulated_irc5 import ARM, EGM_PORT, EmulatedIrc5
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.sim.sim_cell import PATIENT_S

PLACEMENT = ArmPlacement(name=ARM, model="irb4600", base=Pose(xyz=(0.0, 0.0, 0.0)), gripper=None)
GUIDED_MODEL = robot_model("irb4600", gripper=None)
GUIDED_START: Array = np.array((0.0, 0.0, 0.0, 0.0, 0.5, 0.0))
GUIDED_NEAR: Array = GUIDED_START + np.array((0.3, 0.1, -0.1, 0.0, 0.1, 0.2))
GUIDED_FAR: Array = GUIDED_START + np.array((1.4, 0.2, -0.2, 0.0, 0.0, 0.0))
_REST_LIMIT_S = 30.0


def guided_connection(
    emulator: EmulatedIrc5,
    *,
    stale_s: float = 5.0,
    process_silence_s: float = 10.0,
    rws: bool = False,
    inputs: tuple[str, ...] = (),
    gripper: GripperStrings | None = None,
) -> EgmArmConnection:
    """Return the connection, not yet open; a loaded machine gets more time than an arm by default."""
    egm = {
        "port": EGM_PORT,
        "address": emulator.place["host"],
        "stale_s": stale_s,
        "start_s": 20.0,
        "process_silence_s": process_silence_s,
    }
    service = {"port": emulator.place["rws_port"], "timeout_s": 5.0, "stale_s": 10.0, "inputs": inputs}
    web = {"rws": service} if rws else {}
    options = replace(emulator.driver_options(egm=egm, **web), gripper=gripper)
    assert options.egm is not None
    return new_egm_arm(
        options,
        options.egm,
        name=ARM,
        arm=PLACEMENT,
        about=about_driver(options, name=ARM),
        engine_silence_s=PATIENT_S,
    )


@asynccontextmanager
async def guided(
    emulator: EmulatedIrc5,
    *,
    enable: bool = True,
    rws: bool = False,
    stale_s: float = 5.0,
    process_silence_s: float = 10.0,
    inputs: tuple[str, ...] = (),
    gripper: GripperStrings | None = None,
) -> AsyncGenerator[EgmArmConnection]:
    """Return an open connection; it is closed afterwards."""
    await asyncio.to_thread(emulator.do, "restore")
    await asyncio.to_thread(emulator.do, "go_on")
    connection = guided_connection(
        emulator, rws=rws, inputs=inputs, stale_s=stale_s, process_silence_s=process_silence_s, gripper=gripper
    )
    await connection.open()
    try:
        if enable:
            await connection.enable()
        yield connection
    finally:
        await connection.close()


class FaultyGuidedArm:
    """Implements `tests.robots.drivers.faulty_process_arm.FaultyArm`."""

    def __init__(self, emulator: EmulatedIrc5) -> None:
        self._emulator = emulator

    @property
    def limits(self) -> JointLimits:
        """Of its model."""
        return GUIDED_MODEL.limits

    @property
    def far(self) -> Array:
        """Where the first axis turns by 1.4 rad."""
        return GUIDED_FAR

    @property
    def start(self) -> Array:
        """Where the emulated axes stand at first."""
        return GUIDED_START

    @asynccontextmanager
    async def connected(self) -> AsyncGenerator[EgmArmConnection]:
        """Connect the driver; motion is not permitted."""
        async with guided(self._emulator, enable=False, stale_s=3.0, process_silence_s=4.0) as connection:
            yield connection

    def do(self, case: FaultCase) -> None:
        """Cause the fault."""
        self._emulator.do(case.do, **case.values)

    def restore(self, case: FaultCase) -> None:
        """End the fault, and do what a person does at the controller."""
        self._emulator.do("restore")
        if case.restore[0] != "restore":
            self._emulator.do(case.restore[0], **case.restore[1])

    def await_rest(self) -> float:
        """Wait until the axes rest, by their true state, and return when they came to rest.

        It waits for the end of guided motion too: who is quick enables motion again before the `CommTimeout` of an
        emulator that stood still meanwhile, and is followed on.
        """
        limit_s = time.monotonic() + _REST_LIMIT_S
        while _is_guided(state := self._emulator.do("state")) and time.monotonic() < limit_s:
            pass
        assert not _is_guided(state)
        return float(state["egm"]["rested_s"])

    def time_s(self) -> float:
        """Return the time on its own clock."""
        return float(self._emulator.do("state")["time_s"])

    def position_rad(self) -> list[float]:
        """Return the true angles of the axes."""
        return list(self._emulator.do("state")["joints_rad"])


def _is_guided(state: Mapping[str, Any]) -> bool:
    return state["in_motion"] or state["egm"]["followed"]
