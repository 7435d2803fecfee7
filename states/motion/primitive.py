"""Which movement primitive a motion follows: a named entry, read when the state runs, slowed down and approached."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from engine.primitive import CartDmp, JointDmp
from engine.skills.entries import ReadEntry
from engine.skills.motion import Speed
from engine.state import Context
from engine.store.kinds import read_as

TimeScale = Annotated[
    float, Meta(gt=0, le=100, description="How many times the primitive's own duration tau the motion takes")
]
ApproachSpeed = Annotated[
    Speed | None,
    Meta(description="First go to the primitive's start at this share of the joint speeds; none to refuse"),
]


class JointDmpEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The joint DMP that the named entry holds when the state runs."""

    entry: Annotated[
        str, Meta(min_length=1, description="Name of the entry in the store", extra_json_schema={"entry": "dmp"})
    ]


class CartDmpEntry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The Cartesian DMP that the named entry holds when the state runs."""

    entry: Annotated[
        str, Meta(min_length=1, description="Name of the entry in the store", extra_json_schema={"entry": "cart_dmp"})
    ]


async def resolve_joint_dmp(ctx: Context, dmp: JointDmpEntry, *, time_scale: float) -> JointDmp:
    """Return the primitive of an entry of kind `dmp`, `time_scale` times as long.

    Raises:
        EntryNotFound: the store has no such entry.
    """
    found = read_as(await ctx.call(ReadEntry(kind="dmp", name=dmp.entry), to="store"), JointDmp)
    return msgspec.structs.replace(found, tau=found.tau * time_scale)


async def resolve_cart_dmp(ctx: Context, dmp: CartDmpEntry, *, time_scale: float) -> CartDmp:
    """Return the primitive of an entry of kind `cart_dmp`, `time_scale` times as long.

    Raises:
        EntryNotFound: the store has no such entry.
    """
    found = read_as(await ctx.call(ReadEntry(kind="cart_dmp", name=dmp.entry), to="store"), CartDmp)
    return msgspec.structs.replace(found, tau=found.tau * time_scale)
