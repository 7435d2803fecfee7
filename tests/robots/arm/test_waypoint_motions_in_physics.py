"""A Panda moves through waypoints in physics: past each within its distance, without a stop, also after a hold."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from engine.bus import GoalHandle, GoalStatus
from engine.messages import Pose
from engine.skills.waypoints import FollowWaypoints, Waypoint, WaypointsFeedback, WaypointsResult
from robots.port import Array
from tests.robots.arm.simulated import HOME, Simulated, simulated
from tests.robots.panda_arm import home, panda_kinematics, panda_model

DOWN = (1.0, 0.0, 0.0, 0.0)
BLEND_M = 0.03
# What the torque-controlled arm is behind its set point at this speed.
BEHIND_M = 0.01
REST_RAD_S = 0.02
JOINTS = tuple((home() + np.array([0.5, 0.2, 0.0, 0.2, 0.0, 0.0, 0.3])).tolist())
THROUGH = FollowWaypoints(
    waypoints=(
        Waypoint(pose=Pose(xyz=(-0.1, 0.15, 0.35), xyzw=DOWN), blend_m=BLEND_M),
        Waypoint(joints=JOINTS, blend_m=BLEND_M),
        Waypoint(pose=Pose(xyz=(-0.1, 0.0, 0.45), xyzw=DOWN), blend_m=0.0),
        Waypoint(pose=Pose(xyz=(-0.2, -0.1, 0.4), xyzw=DOWN)),
    ),
    speed=0.4,
)
STOP = 2


def tool(joints: Array) -> Array:
    return panda_kinematics().tool_pose(joints).xyz


class Recorded:
    """The set points and the measured joints of the arm during a goal, every 2 ms."""

    def __init__(self, cell: Simulated, handle: GoalHandle[WaypointsResult, WaypointsFeedback]) -> None:
        self._cell, self._handle = cell, handle
        self.desired: list[Array] = []
        self.measured: list[Array] = []

    async def record(self) -> None:
        """Return at the end of the goal."""
        while not self._handle.finished:
            sample = self._cell.port.sample()
            self.desired.append(sample.desired_rad.copy())
            self.measured.append(sample.position_rad.copy())
            await self._cell.bus.clock.sleep(0.002)

    def speeds(self) -> Array:
        """Return the speed of each joint's set point at each step."""
        return np.diff(np.array(self.desired), axis=0) / 0.002


def require_passed(recorded: Recorded, result: WaypointsResult) -> None:
    """Each waypoint is passed by the measured tool, one after the other."""
    tools, at = np.array([tool(row) for row in recorded.measured]), 0
    for index, joints in enumerate(result.waypoints):
        distances = np.linalg.norm(tools[at:] - tool(np.array(joints)), axis=1)
        allowed_m = (BLEND_M if index < STOP else 0.0) + BEHIND_M
        assert distances.min() <= allowed_m
        at += int(np.argmax(distances <= allowed_m))


@pytest.mark.virtual
async def test_the_arm_passes_its_waypoints_in_motion_within_the_limits_and_stops_where_it_shall() -> None:
    async with simulated() as cell:
        handle = cell.bus.send_goal(THROUGH, to="left")
        recorded = Recorded(cell, handle)
        await recorded.record()
        end = await handle.result()
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert end.result is not None
    assert np.abs(recorded.measured[-1] - np.array(end.result.waypoints[-1])).max() < 0.01
    require_passed(recorded, end.result)
    limits, speeds = panda_model().limits, recorded.speeds()
    assert (np.abs(speeds) <= 0.4 * np.array(limits.velocity_rad_s) * 1.01).all()
    pushes = np.abs(np.diff(speeds, axis=0)) / 0.002
    assert (pushes <= np.array(limits.acceleration_rad_s2)).all()
    desired = np.array(recorded.desired)
    assert (desired >= np.array(limits.lower_rad)).all()
    assert (desired <= np.array(limits.upper_rad)).all()
    moving = np.abs(speeds).max(axis=1)
    for index, joints in enumerate(end.result.waypoints[:-1]):
        nearest = int(np.argmin(np.linalg.norm(desired - np.array(joints), axis=1)))
        slowest = moving[max(0, nearest - 5) : nearest + 5].min()
        assert bool(slowest < REST_RAD_S) is (index == STOP)


@pytest.mark.virtual
async def test_a_held_motion_rests_and_then_passes_the_other_waypoints_on_the_same_path() -> None:
    async with simulated() as cell:
        alone = cell.bus.send_goal(THROUGH, to="left")
        undisturbed = Recorded(cell, alone)
        await undisturbed.record()
        await cell.perform(HOME)
        handle = await cell.begun(THROUGH, after_s=0.5)
        recorded = Recorded(cell, handle)
        recording = asyncio.create_task(recorded.record())
        await handle.hold()
        assert (handle.status, cell.speed_rad_s() < REST_RAD_S) == (GoalStatus.HELD, True)
        await cell.bus.clock.sleep(0.5)
        await handle.resume()
        await recording
        end = await handle.result()
    assert end.result is not None, end.cause
    assert end.result.passed == len(THROUGH.waypoints)
    path = np.array(undisturbed.desired)
    assert max(float(np.abs(path - row).max(axis=1).min()) for row in recorded.desired[::10]) < 0.01


@pytest.mark.virtual
async def test_a_preempted_motion_comes_to_rest_on_its_path_and_the_next_goal_is_carried_out() -> None:
    async with simulated() as cell:
        heard: list[WaypointsFeedback] = []
        handle = await cell.begun(THROUGH, after_s=0.0)
        handle.on_feedback(heard.append)
        await cell.until(lambda: bool(heard) and heard[-1].waypoint == 1, within_s=5.0)
        assert cell.speed_rad_s() > 0.1
        handle.cancel()
        end = await handle.result()
        assert (end.status, cell.speed_rad_s() < REST_RAD_S) == (GoalStatus.CANCELED, True)
        assert end.result is not None
        assert end.result.passed == 1
        assert (await cell.perform(HOME)).status is GoalStatus.SUCCEEDED
