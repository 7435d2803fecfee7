"""The straight way between the place over a part and the part itself."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.messages import Pose, Vector3
from engine.pose_algebra import along, rotated
from engine.skills.motion import CartLinTask, ForwardKinematics
from engine.state import Context
from states.failed_goal import goal_cause, is_path_blocked
from states.manipulation.steps import Ended
from states.motion.line_time import line_duration_s
from states.motion.target import NO_OFFSET, PoseTarget, pose_label

Way = Annotated[float, Meta(gt=0, le=1, description="Length of the straight way", extra_json_schema={"unit": "m"})]
LineSpeed = Annotated[
    float, Meta(gt=0, le=1, description="Greatest speed on the straight ways", extra_json_schema={"unit": "m/s"})
]
Direction = Annotated[
    Vector3 | None,
    Meta(description="Where the tool comes from, in the frame of the pose; against its own z by default"),
]


def way_out(tool: Pose, frame: Pose, direction: Vector3 | None, distance_m: float) -> Vector3:
    """Return the way in the world from a pose of the tool out to where it comes from.

    Args:
        tool: The pose of the tool in the world.
        frame: The frame that `direction` is given in, in the world.
        direction: Where it comes from; against the z axis of the tool where there is none.
        distance_m: How far.
    """
    out = rotated(tool.xyzw, (0.0, 0.0, -1.0)) if direction is None else rotated(frame.xyzw, direction)
    return along(out, distance_m)


async def go_straight(ctx: Context, robot: str, pose: Pose, *, speed_m_s: float, kind: str) -> Ended | None:
    """Move the tool on a straight line; None when it is there.

    `blocked` where what the arm holds would touch something before the end of the line.
    """
    start = await ctx.call(ForwardKinematics(), to=robot)
    goal = CartLinTask(pose=pose, duration_s=line_duration_s(start, pose, speed_m_s=speed_m_s))
    end = await ctx.perform(goal, to=robot)
    if end.status == "succeeded":
        return None
    what = f"{robot} did not go straight to {pose_label(PoseTarget(xyz=pose.xyz), NO_OFFSET)}"
    cause = goal_cause(what, goal, end, to=robot, where=ctx.path, kind=kind)
    if is_path_blocked(end):
        return Ended("blocked", cause)
    return Ended("unreachable" if end.status == "rejected" else "failed", cause)
