"""Parameter types of the states that calibrate, and how they read entries."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.messages import Pose
from engine.state import Context
from states.motion.motion_target import NO_OFFSET, PoseTarget, resolve_pose

PoseEntries = Annotated[
    tuple[Annotated[str, Meta(min_length=1, extra_json_schema={"entry": "pose"})], ...],
    Meta(description="The same as names of `pose` entries"),
]
ResidualLimit = Annotated[
    float, Meta(gt=0.0, description="Maximum residual of a good result", extra_json_schema={"unit": "m"})
]


def require_poses(poses: tuple[Pose, ...], entries: PoseEntries, *, parameter: str) -> None:
    """Require poses or entries, and not both; raises ValueError."""
    if bool(poses) == bool(entries):
        raise ValueError(f"give either `{parameter}` or `entries`")


async def resolve_poses(ctx: Context, poses: tuple[Pose, ...], entries: PoseEntries) -> list[Pose]:
    """Return the poses, or those of the entries.

    Raises:
        EntryNotFound: the store has no such entry of kind `pose`.
    """
    return [*poses, *[await resolve_pose(ctx, PoseTarget(entry=name), NO_OFFSET) for name in entries]]
