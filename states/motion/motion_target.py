"""Where a motion goes: given in the behavior, or read from the store when the state runs.

Because an entry is read at run time, overwriting it changes the motion and not the behavior.
"""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.errors import StateError
from engine.messages import Pose, Quaternion, Vector3
from engine.messages.pose_algebra import rotate_vector, translate_pose
from engine.skills.entries import ReadEntry
from engine.state import Context
from engine.store.entry_kinds import Joints, decode_entry

RobotName = Annotated[
    str, Meta(min_length=1, description="The arm that moves", extra_json_schema={"cell_name": "robot"})
]
Offset = Annotated[
    Vector3, Meta(description="Added to the target, along the axes of the world", extra_json_schema={"unit": "m"})
]
NO_OFFSET: Vector3 = (0.0, 0.0, 0.0)
RetractDistance = Annotated[
    float,
    Meta(
        ge=0,
        le=1,
        description="How far retracted_pose the target, against the z axis that the tool has there",
        extra_json_schema={"unit": "m"},
    ),
]


class EntryTarget(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The value that the named entry has when the state runs."""

    entry: Annotated[
        str, Meta(min_length=1, description="Name of the entry in the store", extra_json_schema={"entry": "joints"})
    ]


JointTarget = (
    EntryTarget
    | Annotated[tuple[float, ...], Meta(min_length=1, extra_json_schema={"unit": "rad", "joints_of": "robot"})]
)
"""Joint angles in radians in the arm's order, or `{entry: name}` of kind `joints`."""


class PoseTarget(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A pose of the tool centre point, metres and x y z w in `frame`; or the entry of kind `pose` of a name."""

    entry: Annotated[str, Meta(description="Name of the entry in the store", extra_json_schema={"entry": "pose"})] = ""
    xyz: Annotated[Vector3, Meta(extra_json_schema={"unit": "m"})] | None = None
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)
    frame: Annotated[str, Meta(extra_json_schema={"cell_name": "arm_frame"})] = "world"

    def __post_init__(self) -> None:
        if bool(self.entry) == (self.xyz is not None):
            raise ValueError("give either `entry` or `xyz` with `xyzw`")


class ShownPoseTarget(PoseTarget, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A pose that may be given in the frame of any body that the cell shows, such as a part or a link of an arm."""

    frame: Annotated[str, Meta(extra_json_schema={"cell_name": "frame"})] = "world"


def joints_label(target: JointTarget) -> str:
    """Name a joint target in a message."""
    if isinstance(target, EntryTarget):
        return f"joints entry {target.entry}"
    return f"joints ({', '.join(f'{angle:.3g}' for angle in target)})"


def pose_label(target: PoseTarget | None, offset_m: Vector3) -> str:
    """Name a pose target and its offset in a message; None is where the arm is."""
    shift = "" if offset_m == NO_OFFSET else f" {_written(offset_m)} off"
    if target is None:
        return f"the place{shift} where it was"
    if target.entry:
        return f"pose entry {target.entry}{shift}"
    return f"pose {_written(target.xyz or NO_OFFSET)}{shift}"


async def resolve_joints(ctx: Context, target: JointTarget) -> tuple[float, ...]:
    """Return the joint angles of a target.

    Raises:
        EntryNotFound: the store has no such entry of kind `joints`.
    """
    if not isinstance(target, EntryTarget):
        return target
    record = await ctx.call(ReadEntry(kind="joints", name=target.entry), to="store")
    return decode_entry(record, Joints).joints


async def resolve_pose(ctx: Context, target: PoseTarget, offset_m: Vector3) -> Pose:
    """Return the pose of a target, moved by `offset_m` in the world frame.

    Raises:
        EntryNotFound: the store has no such entry of kind `pose`.
        StateError: an offset was given for a pose in another frame than the world.
    """
    if target.entry:
        pose = decode_entry(await ctx.call(ReadEntry(kind="pose", name=target.entry), to="store"), Pose)
    else:
        pose = Pose(xyz=target.xyz or NO_OFFSET, xyzw=target.xyzw, frame=target.frame)
    return offset_pose(pose, offset_m, where=ctx.path)


def retracted_pose(pose: Pose, back_m: float) -> Pose:
    """Move a pose of the tool against its own z axis."""
    return translate_pose(pose, rotate_vector(pose.xyzw, (0.0, 0.0, -back_m))) if back_m else pose


def offset_pose(pose: Pose, offset_m: Vector3, *, where: str) -> Pose:
    """Move a pose along the axes of the world."""
    if offset_m == NO_OFFSET:
        return pose
    if pose.frame != "world":
        raise StateError(
            f"`offset_m` is along the world's axes, but the target is given in frame {pose.frame}",
            where=where,
            hint="give the target in the world frame, or leave the offset out",
        )
    x, y, z = (value + shift for value, shift in zip(pose.xyz, offset_m, strict=True))
    return Pose(xyz=(x, y, z), xyzw=pose.xyzw, frame=pose.frame)


def _written(xyz_m: Vector3) -> str:
    return f"({', '.join(f'{value:.3f}' for value in xyz_m)}) m"
