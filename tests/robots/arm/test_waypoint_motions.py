"""Motions through waypoints over a fake port: what is followed, said on the way, and refused before anything moves."""

from __future__ import annotations

import numpy as np
import pytest

from engine.bus import GoalEnd, GoalStatus
from engine.messages import Pose
from engine.skills.waypoints import FollowWaypoints, Waypoint, WaypointsFeedback, WaypointsResult
from tests.robots.arm.served import Served, served
from tests.robots.panda_arm import home, panda_kinematics

HOME = tuple(home().tolist())
LEFT = (0.5, *HOME[1:])
LOW = (0.5, HOME[1], HOME[2], HOME[3] - 0.4, *HOME[4:])
THROUGH = FollowWaypoints(waypoints=(Waypoint(joints=LEFT), Waypoint(joints=LOW), Waypoint(joints=HOME)))
TOOL = panda_kinematics().tool_pose(home())


def pose_at(x_m: float, frame: str = "world") -> Pose:
    x, y, z = (TOOL.xyz + np.array((x_m, 0.0, 0.0))).tolist()
    return Pose(xyz=(x, y, z), xyzw=TOOL.to_pose("world").xyzw, frame=frame)


async def moved(cell: Served, goal: FollowWaypoints) -> tuple[GoalEnd[WaypointsResult], list[WaypointsFeedback]]:
    """Send the arm and return the end of the goal and its feedback."""
    heard: list[WaypointsFeedback] = []
    handle = cell.bus.send_goal(goal, to="left")
    handle.on_feedback(heard.append)
    return await handle.result(), heard


@pytest.mark.virtual
async def test_all_waypoints_are_one_trajectory_and_the_feedback_counts_them() -> None:
    async with served() as cell:
        end, heard = await moved(cell, THROUGH)
        followed = cell.port.followed
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert len(followed) == 1
    assert [message.waypoint for message in heard] == sorted(message.waypoint for message in heard)
    assert {message.waypoint for message in heard} == {0, 1, 2}
    assert (heard[0].progress < 0.1, heard[-1].progress) == (True, 1.0)
    result = end.result
    assert result is not None
    assert (result.start, result.waypoints, result.passed) == (HOME, (LEFT, LOW, HOME), 3)
    assert np.allclose(result.joints, HOME, atol=1e-6)


@pytest.mark.virtual
async def test_poses_and_joints_follow_one_another() -> None:
    goal = FollowWaypoints(
        waypoints=(Waypoint(pose=pose_at(0.05)), Waypoint(joints=HOME), Waypoint(pose=pose_at(-0.05)))
    )
    async with served() as cell:
        end, _ = await moved(cell, goal)
    assert end.result is not None, end.cause
    reached = panda_kinematics().tool_pose(np.array(end.result.waypoints[0])).xyz
    assert np.allclose(reached, pose_at(0.05).xyz, atol=1e-4)
    assert np.allclose(panda_kinematics().tool_pose(np.array(end.result.joints)).xyz, pose_at(-0.05).xyz, atol=1e-4)


@pytest.mark.virtual
async def test_a_canceled_motion_tells_how_many_waypoints_are_behind_it() -> None:
    async with served() as cell:
        end_s = (await moved(cell, THROUGH))[0].result
        assert end_s is not None
        handle = await cell.begun(THROUGH, after_s=0.6 * end_s.duration_s)
        handle.cancel()
        end = await handle.result()
    assert end.status is GoalStatus.CANCELED
    assert end.result is not None
    assert end.result.passed in {1, 2}
    assert end.result.waypoints == (LEFT, LOW, HOME)


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("waypoint", "message", "hint"),
    [
        (Waypoint(), "waypoints[1]: give either `joints` or `pose`", None),
        (Waypoint(joints=HOME, pose=pose_at(0.0)), "waypoints[1]: give either `joints` or `pose`", None),
        (Waypoint(joints=HOME[:2]), "waypoints[1]: the goal has 2 joints", "this arm has 7"),
        (Waypoint(joints=(9.0, *HOME[1:])), "waypoints[1]: panda_joint1 cannot go to 9.0000 rad", "its range is"),
        (Waypoint(pose=pose_at(0.0, "moon")), "waypoints[1]: the frame 'moon' is not known to this arm", "world"),
        (Waypoint(pose=pose_at(3.0)), "waypoints[1]: ", "reach"),
    ],
)
async def test_a_waypoint_that_cannot_be_is_refused_before_anything_moves(
    waypoint: Waypoint, message: str, hint: str | None
) -> None:
    async with served() as cell:
        end, _ = await moved(cell, FollowWaypoints(waypoints=(Waypoint(joints=LEFT), waypoint, Waypoint(joints=HOME))))
        assert cell.port.followed == []
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED
    assert end.status is GoalStatus.REJECTED
    assert end.cause is not None
    assert end.cause.message.startswith(message)
    if hint is not None:
        assert hint in str(end.cause)
