"""A servo arm and its emulated board: each fault has a name, the arm rests, and a person permits motion again."""

from __future__ import annotations

from collections.abc import Generator

import pytest

from robots.port import MotionEnd
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.fault_cases import FaultCase
from tests.robots.drivers.faulty_process_arm import faulty_process_arm
from tests.robots.drivers.servo_arm.emulated_arm import emulated_servo_arm
from tests.robots.drivers.servo_arm.faulty_servo_arm import FaultyServoArm
from tests.robots.drivers.servo_arm.servo_arm_fault_cases import CASES


@pytest.fixture(scope="module")
def emulator() -> Generator[EmulatedProcess]:
    """The emulator of this file."""
    # A loaded machine keeps the lines of the driver waiting for longer than the watchdog of a board.
    with emulated_servo_arm("serial", watchdog_s=2.0) as started:
        yield started


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
async def test_a_fault_is_named_and_nothing_moves_until_a_person_permits_it(
    emulator: EmulatedProcess, case: FaultCase
) -> None:
    arm = FaultyServoArm(emulator)
    outcome = await faulty_process_arm(arm, case)
    assert outcome.end is MotionEnd.FAILED
    assert any(cause in outcome.cause for cause in case.cause), outcome.cause
    assert bool(outcome.lost_reason) is case.lost
    assert outcome.problem
    assert outcome.rest_rad[0] < arm.far[0] - 0.1
    assert outcome.refused
    assert outcome.moved_rad < 1e-6
    assert outcome.moves_again
