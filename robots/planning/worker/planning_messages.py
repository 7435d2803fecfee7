"""What the planning process and its client say to each other, length-prefixed msgpack over a socket."""

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
    """Plan this; `number` is the request's own."""

    number: int
    request: PlanRequest


class AskPathCheck(msgspec.Struct, frozen=True, kw_only=True, tag="way"):
    """Check this way."""

    number: int
    request: PathCheckRequest


class AskAttachedPartCheck(msgspec.Struct, frozen=True, kw_only=True, tag="carry"):
    """Check what is held on this way."""

    number: int
    request: AttachedPartCheckRequest


class AskCollisions(msgspec.Struct, frozen=True, kw_only=True, tag="look"):
    """Look at this configuration."""

    number: int
    request: CollisionRequest


class CancelRequest(msgspec.Struct, frozen=True, kw_only=True, tag="withdraw"):
    """A request is no longer wanted; it is answered all the same, as cancelled."""

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
    """A request that could not be worked on: its scene or model is wrong."""

    number: int
    message: str
    where: str
    hint: str


class PlannerReady(msgspec.Struct, frozen=True, kw_only=True, tag="ready"):
    """The process has loaded and compiled everything."""


PlanningRequest = AskPlan | AskPathCheck | AskAttachedPartCheck | AskCollisions
ToWorker = PlanningRequest | CancelRequest
FromWorker = PlanningReply | CollisionReply | RequestFailure | PlannerReady
