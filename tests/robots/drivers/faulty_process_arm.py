"""A fault in the middle of a motion of an arm with a control process: how it shows, when it rests, what it needs."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from collections.abc import AsyncGenerator, Mapping
from contextlib import AbstractAsyncContextManager
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

from engine.errors import RobotError
from robots.drivers.arm.arm_connection import ArmConnection
from robots.model.robot_model import JointLimits
from robots.port import Array, JointTrajectory, MotionEnd, Tolerance
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.sim.sim_cell import smooth, until

ARM_OPTIONS: Mapping[str, Any] = {"stale_s": 1.5, "process_silence_s": 2.0}
"""A loaded machine gets more time than an arm by default."""
WIDE = Tolerance(path_rad=0.4)
_RECOVERY_S = 60.0
Supervised = TypeVar("Supervised", bound="SupervisedArm")


class SupervisedArm(ArmConnection, Protocol):
    """A connection whose arm has a control process."""

    @property
    def process_id(self) -> int:
        """The id of the control process."""
        ...


class FaultyArm(Protocol):
    """An emulated arm whose controller has faults."""

    @property
    def limits(self) -> JointLimits:
        """Of its model."""
        ...

    @property
    def far(self) -> Array:
        """Goal of the motion that a fault interrupts."""
        ...

    @property
    def start(self) -> Array:
        """Goal of the motion before, and of the last one."""
        ...

    def connected(self) -> AbstractAsyncContextManager[SupervisedArm]:
        """Connect the driver; motion is not permitted."""
        ...

    def do(self, case: FaultCase) -> None:
        """Cause the fault."""
        ...

    def restore(self, case: FaultCase) -> None:
        """End the fault, and do what a person does at the device."""
        ...

    def await_rest(self) -> float:
        """Wait until the arm rests, by its true state, and return the time on its own clock."""
        ...

    def time_s(self) -> float:
        """Return the time on its own clock."""
        ...

    def position_rad(self) -> list[float]:
        """Return the true joint angles."""
        ...


@dataclass(frozen=True, kw_only=True)
class ProcessArmOutcome:
    """What happened; `moved_rad` between the rest of the arm and the person's command, also after it is read again."""

    end: MotionEnd
    is_reported_at_rest: bool
    cause: str
    noticed_s: float
    rest_s: float | None
    rest_rad: list[float]
    lost_reason: str
    problem: str
    moved_rad: float
    refused: str
    moves_again: bool
    last_cause: str


async def faulty_process_arm(arm: FaultyArm, case: FaultCase) -> ProcessArmOutcome:
    """Move, cause the fault, end it, look whether anything moves, and recover as a person would."""
    async with arm.connected() as connection:
        await connection.enable()
        await connection.port.follow(_path(arm, connection, arm.start, 2.0), tolerance=WIDE).report()
        motion = connection.port.follow(_path(arm, connection, arm.far, 8.0), tolerance=WIDE)
        await until(lambda: motion.progress > 0.2)
        begun_s, device_s = time.monotonic(), await asyncio.to_thread(arm.time_s)
        await asyncio.to_thread(_cause, arm, connection, case)
        report = await motion.report()
        noticed_s = time.monotonic() - begun_s
        if case.lost:
            await until(lambda: bool(connection.lost_reason))
        lost_reason, problem = connection.lost_reason, connection.problem
        if case.do == "freeze":
            # The time of the controller stands still as well.
            await asyncio.to_thread(arm.restore, case)
        rest_s = await asyncio.to_thread(arm.await_rest) - device_s
        rested = await asyncio.to_thread(arm.position_rad)
        await asyncio.to_thread(arm.restore, case)
        await until(lambda: not connection.lost_reason, within_s=_RECOVERY_S)
        await connection.report(readings=5)
        refused = ""
        try:
            connection.port.follow(_path(arm, connection, arm.far, 4.0), tolerance=WIDE)
        except RobotError as error:
            refused = str(error)
        await connection.report(readings=5)
        moved = np.abs(np.subtract(await asyncio.to_thread(arm.position_rad), rested)).max()
        await connection.enable()
        last = await connection.port.follow(_path(arm, connection, arm.start, 2.0), tolerance=WIDE).report()
        return ProcessArmOutcome(
            end=report.end,
            is_reported_at_rest=report.at_rest,
            cause=report.reason,
            noticed_s=noticed_s,
            rest_s=rest_s,
            rest_rad=rested,
            lost_reason=lost_reason,
            problem=problem,
            moved_rad=float(moved),
            refused=refused,
            moves_again=last.end is MotionEnd.REACHED,
            last_cause=last.reason,
        )


async def open_connection(connection: Supervised) -> AsyncGenerator[Supervised]:
    """Return an open connection; it is closed afterwards."""
    await connection.open()
    try:
        yield connection
    finally:
        await connection.close()


def _cause(arm: FaultyArm, connection: SupervisedArm, case: FaultCase) -> None:
    match case.do:
        case "kill process":
            os.kill(connection.process_id, signal.SIGKILL)
        case "hold process":
            os.kill(connection.process_id, signal.SIGSTOP)
        case _:
            arm.do(case)


def _path(arm: FaultyArm, connection: SupervisedArm, goal: Array, duration_s: float) -> JointTrajectory:
    start = np.asarray(connection.port.sample().desired_rad)
    return smooth(start, goal, duration_s, limits=arm.limits)
