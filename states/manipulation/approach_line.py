"""The straight line between the pre-approach pose and the pose at the part."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import offset_along, rotate_vector
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import CartLinTask, ForwardKinematics
from engine.state import Context, goal_cause, is_path_blocked
from states.manipulation.step_sequence import SequenceEnd
from states.motion.line_duration import line_duration_s
from states.motion.motion_target import NO_OFFSET, PoseTarget, pose_label

LineLength = Annotated[
    float, Meta(gt=0, le=1, description="Length of the straight segment", extra_json_schema={"unit": "m"})
]
LineSpeed = Annotated[
    float, Meta(gt=0, le=1, description="Maximum speed on the straight segments", extra_json_schema={"unit": "m/s"})
]
ApproachDirection = Annotated[
    Vector3 | None,
    Meta(description="Direction from the pose to the pre-approach pose, in the frame of the pose; tool -z by default"),
]


def retreat_vector(tool: Pose, frame: Pose, direction: Vector3 | None, distance_m: float) -> Vector3:
    """Return the vector in the world from a pose of the tool to its pre-approach position.

    Args:
        tool: The pose of the tool in the world.
        frame: The pose in the world of the frame in which `direction` is given.
        direction: Direction to the pre-approach position; None means the negative z axis of the tool.
        distance_m: Length of the vector.
    """
    out = rotate_vector(tool.xyzw, (0.0, 0.0, -1.0)) if direction is None else rotate_vector(frame.xyzw, direction)
    return offset_along(out, distance_m)


async def move_along_line(
    ctx: Context, robot: str, pose: Pose, *, speed_m_s: float, kind: str, may_touch: tuple[str, ...] = ()
) -> SequenceEnd | None:
    """Move the tool on a straight line; None on success.

    `blocked` if the arm, or the part that it holds, would touch something else than `may_touch` before the end of the
    line.
    """
    start = await ctx.call(ForwardKinematics(), to=robot)
    goal = CartLinTask(
        pose=pose,
        duration_s=line_duration_s(start, pose, speed_m_s=speed_m_s),
        collisions=CollisionOptions(may_touch=may_touch),
    )
    end = await ctx.perform(goal, to=robot)
    if end.status == "succeeded":
        return None
    what = f"{robot} did not move on a straight line to {pose_label(PoseTarget(xyz=pose.xyz), NO_OFFSET)}"
    cause = goal_cause(what, goal, end, to=robot, where=ctx.path, kind=kind)
    if is_path_blocked(end):
        return SequenceEnd("blocked", cause)
    return SequenceEnd("unreachable" if end.status == "rejected" else "failed", cause)
