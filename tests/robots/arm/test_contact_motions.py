"""The guarded move over a fake port."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.messages import Vector3
from engine.skills.contact import MoveUntilContact
from engine.skills.motion import ForwardKinematics
from tests.robots.arm.served import served

DOWN = MoveUntilContact(direction=(0.0, 0.0, -2.0), distance_m=0.1, speed_m_s=0.05, force_n=8.0)


@pytest.mark.virtual
async def test_a_contact_on_the_way_ends_the_goal_as_succeeded_and_says_where_and_how_hard() -> None:
    """The port is told to look for force against the way."""
    async with served() as cell:
        cell.port.touch_after_s = 1.5
        cell.port.wrench = np.array([1.0, 0.0, 9.0, 0.0, 0.2, 0.0])
        before = await cell.bus.call(ForwardKinematics(), to="left")
        end = await cell.bus.send_goal(DOWN, to="left").result()
        until = cell.port.contacts[0]
    assert until is not None
    assert (until.force_n, until.direction) == (8.0, (0.0, 0.0, 1.0))
    assert end.result is not None
    assert (end.status, end.result.contact, end.result.force_n) == (GoalStatus.SUCCEEDED, True, 9.0)
    assert end.result.wrench.torque_nm == (0.0, 0.2, 0.0)
    assert 0.0 < end.result.travelled_m < 0.1
    assert before.xyz[2] - end.result.pose.xyz[2] == pytest.approx(end.result.travelled_m, abs=1e-4)


@pytest.mark.virtual
async def test_the_whole_way_without_a_contact_is_a_success_that_says_so() -> None:
    """At the given greatest speed: 15/8 of the mean."""
    async with served() as cell:
        end = await cell.bus.send_goal(DOWN, to="left").result()
    assert end.result is not None
    assert (end.status, end.result.contact) == (GoalStatus.SUCCEEDED, False)
    assert end.result.travelled_m == pytest.approx(0.1, abs=1e-4)
    assert end.result.duration_s == pytest.approx(0.1 / 0.05 * 15 / 8, abs=0.1)


@pytest.mark.virtual
async def test_the_direction_may_be_along_the_axes_of_the_tool() -> None:
    """The hand of the resting arm points down: forwards is down."""
    async with served() as cell:
        goal = MoveUntilContact(direction=(0.0, 0.0, 1.0), distance_m=0.05, frame="tool")
        before = await cell.bus.call(ForwardKinematics(), to="left")
        end = await cell.bus.send_goal(goal, to="left").result()
    assert end.result is not None
    moved = np.subtract(end.result.pose.xyz, before.xyz)
    assert moved[2] == pytest.approx(-0.05, abs=1e-3)


@pytest.mark.virtual
@pytest.mark.parametrize("direction", [(0.0, 0.0, 0.0), (math.nan, 0.0, 1.0)])
async def test_what_is_no_direction_is_rejected(direction: Vector3) -> None:
    """Nothing moves."""
    async with served() as cell:
        goal = MoveUntilContact(direction=direction, distance_m=0.05)
        end = await cell.bus.send_goal(goal, to="left").result()
        assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])


@pytest.mark.virtual
async def test_a_way_that_leaves_the_reach_is_rejected_beforehand() -> None:
    """As for any line."""
    async with served() as cell:
        goal = MoveUntilContact(direction=(1.0, 0.0, 0.0), distance_m=1.5)
        end = await cell.bus.send_goal(goal, to="left").result()
        assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])


@pytest.mark.virtual
async def test_a_preempted_guarded_move_is_canceled_at_rest_and_the_next_goal_is_accepted_at_once() -> None:
    """No restart after a preemption."""
    async with served() as cell:
        handle = await cell.begun(DOWN, after_s=0.5)
        handle.cancel()
        end = await handle.result()
        assert end.result is not None
        assert (end.status, end.result.contact) == (GoalStatus.CANCELED, False)
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_with_a_peak_only_the_clear_distance_is_passed_fast() -> None:
    """The rest is as slow as the peak requires of the arm's mass."""
    async with served() as cell:
        slow = MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.1, speed_m_s=0.05, force_n=8.0, peak_n=10.0)
        whole = await cell.bus.send_goal(slow, to="left").result()
        clear = await cell.bus.send_goal(msgspec.structs.replace(slow, clear_m=0.09), to="left").result()
    assert whole.result is not None
    assert clear.result is not None
    assert clear.result.travelled_m == pytest.approx(0.1, abs=1e-3)
    assert 10.0 < whole.result.duration_s < 50.0
    assert 2.5 < clear.result.duration_s < 0.4 * whole.result.duration_s


@pytest.mark.virtual
async def test_a_soft_surface_may_be_met_faster_with_the_same_peak() -> None:
    """A hundredth of the stiffness, ten times the speed."""
    async with served() as cell:
        hard = MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.05, speed_m_s=0.2, force_n=8.0, peak_n=10.0)
        first = await cell.bus.send_goal(hard, to="left").result()
        soft = msgspec.structs.replace(hard, direction=(0.0, 0.0, 1.0), surface_n_m=hard.surface_n_m / 100.0)
        second = await cell.bus.send_goal(soft, to="left").result()
    assert first.result is not None
    assert second.result is not None
    assert 5.0 < first.result.duration_s / second.result.duration_s < 11.0


@pytest.mark.virtual
async def test_a_peak_below_the_contact_force_is_rejected() -> None:
    """It could never be felt."""
    async with served() as cell:
        goal = MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.05, force_n=8.0, peak_n=5.0)
        end = await cell.bus.send_goal(goal, to="left").result()
    assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])
    assert end.cause is not None
    assert "a peak of 5 N is less than the contact force of 8 N" in end.cause.message


@pytest.mark.virtual
async def test_a_peak_that_compensated_friction_alone_exceeds_is_rejected_with_that_force() -> None:
    async with served() as cell:
        goal = MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.05, force_n=0.5, peak_n=1.0)
        end = await cell.bus.send_goal(goal, to="left").result()
    assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])
    assert end.cause is not None
    assert "what compensates the friction of the joints alone pushes with" in end.cause.message


@pytest.mark.virtual
@pytest.mark.parametrize("surface_n_m", [1e13, math.inf])
async def test_a_surface_on_which_the_peak_leaves_no_speed_is_rejected(surface_n_m: float) -> None:
    async with served() as cell:
        goal = MoveUntilContact(
            direction=(0.0, 0.0, -1.0), distance_m=0.05, force_n=8.0, peak_n=10.0, surface_n_m=surface_n_m
        )
        end = await cell.bus.send_goal(goal, to="left").result()
    assert (end.status, cell.port.followed) == (GoalStatus.REJECTED, [])
    assert end.cause is not None
    assert "slower than 1e-05 m/s" in end.cause.message
