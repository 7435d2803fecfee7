"""One measured fact of a run on its timeline: a contact, a grasp, a force, a limit."""

from __future__ import annotations

from typing import Literal

import msgspec

MeasuredKind = Literal["contact", "grasp", "force", "limit"]


class MeasuredMarker(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """What was measured at a time of the run's clock, after event `seq`.

    `path` is the node whose goal was active at the device then, empty for none. `device` is its address: `left`,
    `left/gripper`. `value` and `limit`, what was asked for or is allowed, are in `unit`; None where there is none.
    """

    kind: MeasuredKind
    seq: int
    time_s: float
    path: str
    device: str
    value: float | None
    unit: str
    limit: float | None
    text: str


class MeasuredMarkers(msgspec.Struct, frozen=True, kw_only=True):
    """The measured markers of a run up to event `seq`, in order of time.

    `unread` says why the telemetry is not in them; it is empty where it is. `every` is n where only every n-th message
    of a topic was read, for there are too many; peaks between those are missing. `left_out` counts dropped markers.
    """

    seq: int
    marks: tuple[MeasuredMarker, ...]
    unread: str
    every: int
    left_out: int
