"""Where an arm would be along a taught entry, to be looked at before it moves; answered under the arm's name."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message
from engine.skill import Service

TraceableKind = Literal["joints", "pose", "trajectory", "dmp", "cart_dmp"]
"""The kinds of entries that have a place."""


class Trace(Message, frozen=True, kw_only=True):
    """An entry as an arm would carry it out: one row a time.

    `joints` are radians in the order of `joint_names`, empty where the arm cannot follow; `poses` are
    x y z (m) and a unit quaternion x y z w of the tool centre point in the world. `times_s` is 0 for a
    single configuration. `remark` says why there are no joints.
    """

    times_s: tuple[float, ...]
    joint_names: tuple[str, ...]
    joints: tuple[tuple[float, ...], ...]
    poses: tuple[tuple[float, ...], ...]
    remark: str = ""


class TraceMotion(Service[Trace], frozen=True, kw_only=True):
    """Return where the arm is along an entry of `kind` with the fields `value`; nothing moves.

    At most `most` rows, both ends among them. Fails where the entry is not of this arm.
    """

    kind: TraceableKind
    value: dict[str, object]
    most: Annotated[int, msgspec.Meta(ge=2, le=1000)] = 200
