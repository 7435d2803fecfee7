"""What the planning process and its client say to each other, length-prefixed msgpack over a socket."""

from __future__ import annotations

import msgspec

from engine.skills.planning_scene import CollisionReport
from robots.planning.request import CarryRequest, LookRequest, Plan, PlanRequest, Refusal, WayCheck, WayRequest


class AskPlan(msgspec.Struct, frozen=True, kw_only=True, tag="plan"):
    """Plan this; `number` is the request's own."""

    number: int
    request: PlanRequest


class AskWay(msgspec.Struct, frozen=True, kw_only=True, tag="way"):
    """Check this way."""

    number: int
    request: WayRequest


class AskCarry(msgspec.Struct, frozen=True, kw_only=True, tag="carry"):
    """Check what is held on this way."""

    number: int
    request: CarryRequest


class AskLook(msgspec.Struct, frozen=True, kw_only=True, tag="look"):
    """Look at this configuration."""

    number: int
    request: LookRequest


class Withdraw(msgspec.Struct, frozen=True, kw_only=True, tag="withdraw"):
    """A request is no longer wanted; it is answered all the same, as cancelled."""

    number: int


class Answered(msgspec.Struct, frozen=True, kw_only=True, tag="answered"):
    """The answer to `AskPlan`, `AskWay` or `AskCarry`."""

    number: int
    answer: Plan | Refusal | WayCheck


class Reported(msgspec.Struct, frozen=True, kw_only=True, tag="reported"):
    """The answer to `AskLook`."""

    number: int
    answer: CollisionReport


class Failed(msgspec.Struct, frozen=True, kw_only=True, tag="failed"):
    """A request that could not be worked on: its scene or model is wrong."""

    number: int
    message: str
    where: str
    hint: str


class Ready(msgspec.Struct, frozen=True, kw_only=True, tag="ready"):
    """The process has loaded and compiled everything."""


Ask = AskPlan | AskWay | AskCarry | AskLook
ToWorker = Ask | Withdraw
FromWorker = Answered | Reported | Failed | Ready
