"""Servos of a world behind the emulated board: pulses after GO only, at most as fast as the board turns them."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Generator
from contextlib import contextmanager

import numpy as np
import pytest

from robots.drivers.emulation.kinematic_joints import KinematicJoints
from robots.drivers.emulation.plant import Plant
from robots.drivers.servo_arm.emulation.driven_servos import drive_servos
from robots.drivers.servo_arm.emulation.emulated_board import EmulatedBoard

pytestmark = pytest.mark.virtual
START_RAD = (0.3, 2.0)


class LoopClock:
    """Implements `PlantClock` in the time of the event loop."""

    def now_s(self) -> float:
        """Return the time of the loop."""
        return asyncio.get_running_loop().time()

    async def sleep_until(self, time_s: float) -> None:
        """Sleep."""
        await asyncio.sleep(max(0.0, time_s - self.now_s()))


class StuckJoints(KinematicJoints):
    """Joints that report once that they do not follow."""

    problem = "stuck"

    def reset(self) -> None:
        """Follow again."""
        self.problem = ""


class ArmInTest:
    """A board and its servos, which stand elsewhere than the board believes."""

    def __init__(self, joints: KinematicJoints | None = None) -> None:
        clock = LoopClock()
        self.switched: list[bool] = []
        self.joints = joints or KinematicJoints(np.array(START_RAD))
        self.board = EmulatedBoard(clock.now_s, home_deg=(0.0, 160.0), max_deg_s=60.0, watchdog_s=0.0)
        self.plant = Plant(arm=self.joints, on_output=self._wired, clock=clock)

    @property
    def angles_deg(self) -> list[float]:
        """Where the servos are."""
        return [math.degrees(angle) for angle in self.joints.measured()[0]]

    @contextmanager
    def driven(self) -> Generator[None]:
        """Let the servos follow."""
        task = asyncio.get_running_loop().create_task(drive_servos(self.board, self.plant))
        try:
            yield
        finally:
            task.cancel()

    def _wired(self, output: int, *, on: bool) -> None:
        assert output == 0
        self.switched.append(on)


async def test_servos_get_no_pulses_before_go_and_turn_as_fast_as_the_board_lets_them() -> None:
    arm = ArmInTest()
    with arm.driven():
        await asyncio.sleep(0.5)
        assert arm.angles_deg == pytest.approx(np.degrees(START_RAD))
        arm.board.execute(b"GO")
        await asyncio.sleep(0.1)
        assert arm.angles_deg == pytest.approx((0.0, 160.0))
        arm.board.execute(b"90 160")
        await asyncio.sleep(0.5)
        assert arm.angles_deg == pytest.approx((30.0, 160.0), abs=2.0)
        await asyncio.sleep(2.0)
        assert arm.angles_deg == pytest.approx((90.0, 160.0))


async def test_a_board_that_starts_anew_leaves_its_servos_where_they_are() -> None:
    arm = ArmInTest()
    with arm.driven():
        arm.board.execute(b"GO")
        arm.board.execute(b"30 150")
        await asyncio.sleep(1.0)
        arm.board.restart()
        await asyncio.sleep(1.0)
        assert arm.board.written_deg[:2] == [0.0, 160.0]
        assert arm.angles_deg == pytest.approx((30.0, 150.0))


async def test_the_claw_is_output_0() -> None:
    arm = ArmInTest()
    with arm.driven():
        for line in (b"pick", b"GO", b"pick", b"pick", b"place"):
            arm.board.execute(line)
            await asyncio.sleep(0.1)
    assert arm.switched == [True, False]


async def test_a_blocked_servo_goes_on_when_it_can() -> None:
    arm = ArmInTest(StuckJoints(np.array(START_RAD)))
    with arm.driven():
        arm.board.execute(b"GO")
        await asyncio.sleep(0.1)
    assert arm.angles_deg == pytest.approx((0.0, 160.0))
