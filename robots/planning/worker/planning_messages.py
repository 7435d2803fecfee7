"""Messages between the planning process and its client: length-prefixed msgpack over a socket."""

from __future__ import annotations

import msgspec

from engine.skills.planning_scene import CollisionReport
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PathCheck,
    PathCheckRequest,
    PathPlan,
    PlanRefusal,
    PlanRequest,
)


class AskPlan(msgspec.Struct, frozen=True, kw_only=True, tag="plan"):
    """Requests a plan; `number` identifies the request."""

    number: int
    request: PlanRequest


class AskPathCheck(msgspec.Struct, frozen=True, kw_only=True, tag="way"):
    """Requests a path check."""

    number: int
    request: PathCheckRequest


class AskAttachedPartCheck(msgspec.Struct, frozen=True, kw_only=True, tag="carry"):
    """Requests a check of the attached parts."""

    number: int
    request: AttachedPartCheckRequest


class AskCollisions(msgspec.Struct, frozen=True, kw_only=True, tag="look"):
    """Requests the collisions in a configuration."""

    number: int
    request: CollisionRequest


class CancelRequest(msgspec.Struct, frozen=True, kw_only=True, tag="withdraw"):
    """Cancels a request; it is still answered, as canceled."""

    number: int


class PlanningReply(msgspec.Struct, frozen=True, kw_only=True, tag="answered"):
    """The answer to `AskPlan`, `AskPathCheck` or `AskAttachedPartCheck`."""

    number: int
    answer: PathPlan | PlanRefusal | PathCheck


class CollisionReply(msgspec.Struct, frozen=True, kw_only=True, tag="reported"):
    """The answer to `AskCollisions`."""

    number: int
    answer: CollisionReport


class RequestFailure(msgspec.Struct, frozen=True, kw_only=True, tag="failed"):
    """Reports a failed request: its scene or model is invalid."""

    number: int
    message: str
    where: str
    hint: str


class PlannerReady(msgspec.Struct, frozen=True, kw_only=True, tag="ready"):
    """The process has loaded and compiled everything."""


PlanningRequest = AskPlan | AskPathCheck | AskAttachedPartCheck | AskCollisions
ToWorker = PlanningRequest | CancelRequest
FromWorker = PlanningReply | CollisionReply | RequestFailure | PlannerReady
