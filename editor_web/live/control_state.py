"""Control state of the watched run for the page: waiting nodes, requested outcomes, breakpoints, locks, operator."""

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
    """A locked node and the reason given by the operator."""

    path: str
    reason: str


class ControlLive(msgspec.Struct, frozen=True, kw_only=True):
    """The control state of an active run.

    `confirmed` is true when everything that a pause holds is at rest; `operator` is none, attached, detached
    or lost; `loss_policy` applies `loss_timeout_s` after the loss of the operator.
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
    """Return the operator's view as a message for the page."""
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
    """Return why a run waits for a person: `asks`, `paused` or `locked`; empty if it does not."""
    if view is None:
        return ""
    if any("autonomy" in each.reasons for each in view.waiting):
        return "asks"
    if view.paused:
        return "paused"
    return "locked" if any("lock" in each.reasons for each in view.waiting) else ""
