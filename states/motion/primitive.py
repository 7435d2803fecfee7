"""Movement primitive of a motion: a named entry, read when the state runs, with time scale and approach."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp, JointDmp
from engine.skills.entries import ReadEntry
from engine.skills.motion import Speed
from engine.skills.planning import MotionTarget
from engine.state import Context
from engine.store import decode_entry

TimeScale = Annotated[
    float, Meta(gt=0, le=100, description="Duration of the motion as a multiple of the primitive's duration tau")
]
ApproachSpeed = Annotated[
    Speed | None,
    Meta(
        description="Fraction of the joint speed limits for the motion to the start; "
        "without it, the arm must stand at the start"
    ),
]


class JointDmpEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The joint DMP in the named entry, read when the state runs."""

    entry: Annotated[
        str, Meta(min_length=1, description="Name of the entry in the store", extra_json_schema={"entry": "dmp"})
    ]


class CartDmpEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The Cartesian DMP in the named entry, read when the state runs."""

    entry: Annotated[
        str, Meta(min_length=1, description="Name of the entry in the store", extra_json_schema={"entry": "cart_dmp"})
    ]


class MotionStart(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The start of the motion in the named entry, read when the state runs; give exactly one kind."""

    dmp: Annotated[str, Meta(description="Name of the entry", extra_json_schema={"entry": "dmp"})] = ""
    cart_dmp: Annotated[str, Meta(description="Name of the entry", extra_json_schema={"entry": "cart_dmp"})] = ""
    trajectory: Annotated[str, Meta(description="Name of the entry", extra_json_schema={"entry": "trajectory"})] = ""

    def __post_init__(self) -> None:
        if sum(map(bool, (self.dmp, self.cart_dmp, self.trajectory))) != 1:
            raise ValueError("give one of `dmp`, `cart_dmp` and `trajectory`")

    @property
    def label(self) -> str:
        """The name of the start for a message."""
        kind, name = next((kind, name) for kind, name in msgspec.structs.asdict(self).items() if name)
        return f"the start of {kind} entry {name}"


class RecordingEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The recorded motion in the named entry, read when the state runs."""

    entry: Annotated[
        str, Meta(min_length=1, description="Name of the entry in the store", extra_json_schema={"entry": "trajectory"})
    ]


async def resolve_start(ctx: Context, start: MotionStart) -> MotionTarget:
    """Return the start of a taught motion.

    Raises:
        EntryNotFound: the store has no such entry.
    """
    if start.dmp:
        return MotionTarget(joints=(await resolve_joint_dmp(ctx, JointDmpEntry(entry=start.dmp), time_scale=1.0)).start)
    if start.cart_dmp:
        return MotionTarget(
            pose=(await resolve_cart_dmp(ctx, CartDmpEntry(entry=start.cart_dmp), time_scale=1.0)).start
        )
    record = await ctx.call(ReadEntry(kind="trajectory", name=start.trajectory), to="store")
    trajectory = decode_entry(record, Trajectory)
    if trajectory.joints:
        return MotionTarget(joints=trajectory.joints[0])
    x, y, z, qx, qy, qz, qw = trajectory.poses[0]
    return MotionTarget(pose=Pose(xyz=(x, y, z), xyzw=(qx, qy, qz, qw), frame=trajectory.frame))


async def resolve_joint_dmp(ctx: Context, dmp: JointDmpEntry, *, time_scale: float) -> JointDmp:
    """Return the primitive of an entry of kind `dmp`, its duration multiplied by `time_scale`.

    Raises:
        EntryNotFound: the store has no such entry.
    """
    primitive = decode_entry(await ctx.call(ReadEntry(kind="dmp", name=dmp.entry), to="store"), JointDmp)
    return msgspec.structs.replace(primitive, tau=primitive.tau * time_scale)


async def resolve_cart_dmp(ctx: Context, dmp: CartDmpEntry, *, time_scale: float) -> CartDmp:
    """Return the primitive of an entry of kind `cart_dmp`, its duration multiplied by `time_scale`.

    Raises:
        EntryNotFound: the store has no such entry.
    """
    primitive = decode_entry(await ctx.call(ReadEntry(kind="cart_dmp", name=dmp.entry), to="store"), CartDmp)
    return msgspec.structs.replace(primitive, tau=primitive.tau * time_scale)
