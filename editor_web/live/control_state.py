"""What the page shows of the control of the watched run: who waits and asks, breakpoints, locks, operator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import msgspec

from engine.runtime.control import ControlView

GateSide = Literal["before", "after"]
AutonomyLevel = Literal["off", "low", "high", "full"]


class WaitingNodeLive(msgspec.Struct, frozen=True, kw_only=True):
    """A node that waits `before` its entry or `after` its outcome; `reasons` are pause, lock, autonomy."""

    path: str
    point: GateSide
    outcome: str
    required: str
    reasons: tuple[str, ...]


class BreakpointLive(msgspec.Struct, frozen=True, kw_only=True):
    """A breakpoint of the run, as it is sent to `control/breakpoints`."""

    path: str
    when: GateSide
    condition: str | None
    hits: int
    outcomes: tuple[str, ...]
    enabled: bool


class LockLive(msgspec.Struct, frozen=True, kw_only=True):
    """A locked node and why, in the words of whoever locked it."""

    path: str
    reason: str


class ControlLive(msgspec.Struct, frozen=True, kw_only=True):
    """The control of a run that is under way.

    `confirmed` once everything that was to be held is at rest; `operator` is none, attached, detached
    or lost; `loss_policy` is what happens `loss_timeout_s` after a loss.
    """

    paused: bool
    confirmed: bool
    stepping: bool
    cannot: tuple[str, ...]
    waiting: tuple[WaitingNodeLive, ...]
    locks: tuple[LockLive, ...]
    breakpoints: tuple[BreakpointLive, ...]
    autonomy: AutonomyLevel
    operator: str
    demanded: bool
    loss_policy: str
    loss_timeout_s: float


def control_live(view: ControlView, *, lock_reasons: Mapping[str, str]) -> ControlLive:
    """Return what the page needs of an operator's view."""
    return ControlLive(
        paused=view.paused,
        confirmed=view.confirmed,
        stepping=view.stepping,
        cannot=view.cannot,
        waiting=tuple(
            WaitingNodeLive(
                path=each.path,
                point=each.point,
                outcome=each.outcome,
                required=each.required,
                reasons=each.reasons,
            )
            for each in view.waiting
        ),
        locks=tuple(LockLive(path=path, reason=lock_reasons.get(path, "")) for path in view.locks),
        breakpoints=tuple(
            BreakpointLive(
                path=each.path,
                when=each.when,
                condition=each.condition,
                hits=each.hits,
                outcomes=each.outcomes,
                enabled=each.enabled,
            )
            for each in view.breakpoints
        ),
        autonomy=view.autonomy,
        operator=view.operator,
        demanded=view.demanded,
        loss_policy=view.loss_policy,
        loss_timeout_s=view.loss_timeout_s,
    )


def waiting_reason(view: ControlView | None) -> str:
    """Say in one word what a run waits for that somebody has to give: asks, paused, locked, or nothing."""
    if view is None:
        return ""
    if any("autonomy" in each.reasons for each in view.waiting):
        return "asks"
    if view.paused:
        return "paused"
    return "locked" if any("lock" in each.reasons for each in view.waiting) else ""
