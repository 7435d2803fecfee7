"""Poses of the parts and frames of a cell in the world frame."""

from __future__ import annotations

from engine.errors import Cause, StateError
from engine.messages import FramePoses, PartPoses, Pose
from engine.state import Context
from engine.wording import did_you_mean

WORLD = "world"
PARTS_TOPIC = "cell/parts"
FRAMES_TOPIC = "cell/frames"


async def part_in_world(ctx: Context, part: str) -> Pose | Cause:
    """Return the latest measured pose of a part in the world, or the cause if it is unknown."""
    return measured_pose(await ctx.latest(PARTS_TOPIC, PartPoses), part)


def measured_pose(parts: PartPoses, part: str) -> Pose | Cause:
    """Return the pose of a part in a measurement of all, or the cause if it is unknown."""
    if part in parts.poses:
        return parts.poses[part]
    return Cause(message=f"no such part is in the cell; {did_you_mean(part, parts.poses)}", where=PARTS_TOPIC)


async def frame_in_world(ctx: Context, frame: str) -> Pose:
    """Return the current pose of a frame of the cell in the world; `world` gives the identity.

    Raises:
        StateError: the cell has no such frame.
    """
    if frame == WORLD:
        return Pose(xyz=(0.0, 0.0, 0.0))
    frames = await ctx.latest(FRAMES_TOPIC, FramePoses)
    if frame not in frames.names:
        raise StateError(f"the cell shows no frame {frame}", where=ctx.path, hint=did_you_mean(frame, frames.names))
    row = frames.names.index(frame)
    return Pose(xyz=frames.xyz[row], xyzw=frames.xyzw[row])
