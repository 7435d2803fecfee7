"""A preview of an arm's motion along a taught entry before it moves; served under the arm's name."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message
from engine.skill import Service

TraceableKind = Literal["joints", "pose", "trajectory", "dmp", "cart_dmp"]
"""The kinds of entries that can be traced."""


class Trace(Message, frozen=True, kw_only=True):
    """The motion of an arm along an entry, one row per time.

    `joints` are radians in the order of `joint_names`, empty when the arm cannot follow; `poses` are
    x y z (m) and a unit quaternion x y z w of the tool centre point in the world. `times_s` is 0 for a
    single configuration. `remark` is the reason for missing joints.
    """

    times_s: tuple[float, ...]
    joint_names: tuple[str, ...]
    joints: tuple[tuple[float, ...], ...]
    poses: tuple[tuple[float, ...], ...]
    remark: str = ""


class TraceMotion(Service[Trace], frozen=True, kw_only=True):
    """Return the motion of the arm along an entry of `kind` with the fields `value`; nothing moves.

    Returns at most `most` rows, including both ends. Fails when the entry belongs to another arm.
    """

    kind: TraceableKind
    value: dict[str, object]
    most: Annotated[int, msgspec.Meta(ge=2, le=1000)] = 200
