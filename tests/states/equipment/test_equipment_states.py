"""equipment.MoveDevice and equipment.CheckDevice: each way in which a motion ends is an outcome with its cause."""

from __future__ import annotations

import pytest

from engine.errors import Cause
from engine.skills.device_moves import DeviceEnd, DeviceReading, DeviceResult
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.state import Outcome
from states.equipment.check_device import CheckDevice
from states.equipment.move_device import MoveDevice
from tests.states.fake_context import FakeContext, broken_off


async def moved(end: object) -> Outcome:
    """Return the outcome of moving a device whose goal ends so."""
    ctx = FakeContext({"vice/jaws/move_device": end})
    return await MoveDevice(device="vice/jaws", position="closed").run(ctx)


def ended(how: DeviceEnd, reason: str = "") -> GoalEnd[DeviceResult]:
    """Return the end of a goal that the device has executed."""
    return GoalEnd(GoalStatus.SUCCEEDED, DeviceResult(ended=how, sensed="unknown", reason=reason), None)


@pytest.mark.parametrize("how", ["reached", "timed"])
async def test_reached_and_timed_are_two_outcomes(how: DeviceEnd) -> None:
    assert await moved(ended(how)) == Outcome(how)


@pytest.mark.parametrize("how", ["no_air", "stuck", "sensor_contradicts", "interlocked"])
async def test_a_failure_is_an_outcome_with_its_cause(how: DeviceEnd) -> None:
    outcome = await moved(ended(how, "the door is open"))
    assert outcome.name == how
    assert outcome.cause is not None
    assert outcome.cause.message == "vice/jaws did not move to closed"
    assert outcome.cause.because is not None
    assert outcome.cause.because.message == "the door is open"


async def test_a_goal_that_the_device_did_not_execute_failed() -> None:
    outcome = await moved(broken_off(GoalStatus.ABORTED, Cause(message="the pins are silent", where="vice")))
    assert outcome.name == "failed"
    assert outcome.cause is not None


@pytest.mark.parametrize(
    ("state", "counts", "outcome", "reason"),
    [
        (DeviceReading(commanded="open", sensed="closed"), False, "at_position", ""),
        (DeviceReading(commanded="closed", sensed="between"), False, "elsewhere", "told closed, sensed between"),
        (
            DeviceReading(commanded="closed", timed=True),
            False,
            "unknown",
            "told closed, sensed unknown; no sensor tells its positions",
        ),
        (DeviceReading(commanded="closed", timed=True), True, "at_position", ""),
        (DeviceReading(commanded="open", timed=True), True, "elsewhere", "told open, sensed unknown"),
        (
            DeviceReading(commanded="closed"),
            True,
            "unknown",
            "told closed, sensed unknown; no sensor tells its positions",
        ),
        (DeviceReading(sensed="closed", problem="no air: p is off"), True, "unknown", "no air: p is off"),
    ],
)
async def test_what_nobody_senses_is_unknown_unless_the_command_counts(
    state: DeviceReading, counts: bool, outcome: str, reason: str
) -> None:
    ctx = FakeContext(topics={"vice/state": state})
    found = await CheckDevice(device="vice", position="closed", command_counts=counts).run(ctx)
    assert found.name == outcome
    because = found.cause.because if found.cause is not None else None
    assert (because.message if because is not None else "") == reason
