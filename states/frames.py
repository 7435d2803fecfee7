"""Where parts and frames of a cell stand in the world."""

from __future__ import annotations

from engine.errors import StateError
from engine.event import Cause
from engine.messages import FramePoses, PartPoses, Pose
from engine.state import Context
from engine.suggestions import did_you_mean

WORLD = "world"
PARTS_TOPIC = "cell/parts"
FRAMES_TOPIC = "cell/frames"


async def part_in_world(ctx: Context, part: str) -> Pose | Cause:
    """Return where a part of the cell lies now, by its newest measured pose, or why that is not known."""
    poses = (await ctx.latest(PARTS_TOPIC, PartPoses)).poses
    if part in poses:
        return poses[part]
    return Cause(message=f"no such part is in the cell; {did_you_mean(part, poses)}", where=PARTS_TOPIC)


async def frame_in_world(ctx: Context, frame: str) -> Pose:
    """Return where the frame of a body of the cell is now; that of the world is at its own origin.

    Raises:
        StateError: the cell shows no such frame.
    """
    if frame == WORLD:
        return Pose(xyz=(0.0, 0.0, 0.0))
    frames = await ctx.latest(FRAMES_TOPIC, FramePoses)
    if frame not in frames.names:
        raise StateError(f"the cell shows no frame {frame}", where=ctx.path, hint=did_you_mean(frame, frames.names))
    row = frames.names.index(frame)
    return Pose(xyz=frames.xyz[row], xyzw=frames.xyzw[row])
