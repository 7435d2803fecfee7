"""Target of a motion: given in the behavior, or read from the store when the state runs.

An entry is read at run time: overwriting it changes the motion without changing the behavior.
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
from engine.store import Joints, decode_entry

RobotName = Annotated[
    str, Meta(min_length=1, description="The arm that moves", extra_json_schema={"cell_name": "robot"})
]
Offset = Annotated[
    Vector3, Meta(description="Offset added to the target, along the world axes", extra_json_schema={"unit": "m"})
]
NO_OFFSET: Vector3 = (0.0, 0.0, 0.0)
RetractDistance = Annotated[
    float,
    Meta(
        ge=0,
        le=1,
        description="Retract distance from the target, along the negative z axis of the tool at the target",
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
    """A pose of the tool centre point in `frame`, in metres and as a quaternion x y z w; or a `pose` entry by name."""

    entry: Annotated[str, Meta(description="Name of the entry in the store", extra_json_schema={"entry": "pose"})] = ""
    xyz: Annotated[Vector3, Meta(extra_json_schema={"unit": "m"})] | None = None
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)
    frame: Annotated[str, Meta(extra_json_schema={"cell_name": "arm_frame"})] = "world"

    def __post_init__(self) -> None:
        if bool(self.entry) == (self.xyz is not None):
            raise ValueError("give either `entry` or `xyz` with `xyzw`")


class ShownPoseTarget(PoseTarget, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A pose in the frame of any body of the cell, such as a part or a link of an arm."""

    frame: Annotated[str, Meta(extra_json_schema={"cell_name": "frame"})] = "world"


def joints_label(target: JointTarget) -> str:
    """Return the name of a joint target for a message."""
    if isinstance(target, EntryTarget):
        return f"joints entry {target.entry}"
    return f"joints ({', '.join(f'{angle:.3g}' for angle in target)})"


def pose_label(target: PoseTarget | None, offset_m: Vector3) -> str:
    """Return the name of a pose target and its offset for a message; None means the start pose of the motion."""
    shift = "" if offset_m == NO_OFFSET else f" offset by {_format_xyz(offset_m)}"
    if target is None:
        return f"its start pose{shift}"
    if target.entry:
        return f"pose entry {target.entry}{shift}"
    return f"pose {_format_xyz(target.xyz or NO_OFFSET)}{shift}"


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
    """Return the pose of a target, translated by `offset_m` in the world frame.

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
    """Return a tool pose translated by `back_m` along its own negative z axis."""
    return translate_pose(pose, rotate_vector(pose.xyzw, (0.0, 0.0, -back_m))) if back_m else pose


def offset_pose(pose: Pose, offset_m: Vector3, *, where: str) -> Pose:
    """Return a pose translated along the world axes.

    Raises:
        StateError: the pose is given in another frame than the world.
    """
    if offset_m == NO_OFFSET:
        return pose
    if pose.frame != "world":
        raise StateError(
            f"`offset_m` is along the world axes, but the target is given in frame {pose.frame}",
            where=where,
            hint="give the target in the world frame, or omit the offset",
        )
    x, y, z = (value + shift for value, shift in zip(pose.xyz, offset_m, strict=True))
    return Pose(xyz=(x, y, z), xyzw=pose.xyzw, frame=pose.frame)


def _format_xyz(xyz_m: Vector3) -> str:
    return f"({', '.join(f'{value:.3f}' for value in xyz_m)}) m"
