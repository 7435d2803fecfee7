"""A motion of the fingers that does not end fails, but not sooner than the patience of the driver says."""

from __future__ import annotations

import asyncio
from typing import Any, cast

import pytest

from robots.drivers.fresh_link import FreshReading
from robots.drivers.robotiq.gripper_registers import ActivationStatus, GripperCommand, GripperStatus, ObjectStatus
from robots.drivers.robotiq.robotiq_port import RobotiqPort

TRAVEL_S = 0.085 / 0.15


class Link:
    """A connection to a gripper whose fingers move for ever."""

    def __init__(self) -> None:
        self._position = 0

    def fresh(self) -> GripperStatus:
        return GripperStatus(
            activated=True,
            go=True,
            activation=ActivationStatus.ACTIVE,
            contact=ObjectStatus.MOVING,
            fault=0,
            position_echo=self._position,
            position=100,
            current_a=0.0,
        )

    def submit(self, command: GripperCommand) -> asyncio.Future[float]:
        taken: asyncio.Future[float] = asyncio.get_running_loop().create_future()
        taken.set_result(0.0)
        self._position = command.position
        return taken

    def arm(self, stop_command: GripperCommand | None) -> None:
        pass


@pytest.mark.parametrize("patience_s", [2.0, 30.0])
async def test_a_motion_that_does_not_end_fails_after_its_time_and_the_patience_of_the_driver(
    patience_s: float,
) -> None:
    link = Link()
    port = RobotiqPort(
        "hand",
        cast("Any", link),
        widths=((3, 0.085), (230, 0.0)),
        blocked=lambda: "",
        patience_s=patience_s,
    )
    motion = port.close_to(width_m=0.0, speed_m_s=0.15, force_n=50.0)
    await asyncio.sleep(0.0)
    for now_s in (0.1, TRAVEL_S + patience_s - 0.1):
        port.take(FreshReading(value=link.fresh(), asked_s=now_s, took_s=0.0))
        assert not motion.ended
    port.take(FreshReading(value=link.fresh(), asked_s=TRAVEL_S + patience_s + 0.3, took_s=0.0))
    assert motion.ended
    assert (await motion.report()).reason.startswith("the fingers did not end their motion within ")
