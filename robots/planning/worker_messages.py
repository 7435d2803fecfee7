"""What the planning process and its client say to each other, length-prefixed msgpack over a socket."""

from __future__ import annotations

import msgspec

from robots.planning.request import Plan, PlanRequest, Refusal


class Ask(msgspec.Struct, frozen=True, kw_only=True, tag="ask"):
    """Plan this; `number` is the request's own."""

    number: int
    request: PlanRequest


class Withdraw(msgspec.Struct, frozen=True, kw_only=True, tag="withdraw"):
    """A request is no longer wanted; it is answered all the same, as cancelled."""

    number: int


class Answered(msgspec.Struct, frozen=True, kw_only=True, tag="answered"):
    """The answer to a request."""

    number: int
    answer: Plan | Refusal


class Failed(msgspec.Struct, frozen=True, kw_only=True, tag="failed"):
    """A request that could not be worked on: its scene or model is wrong."""

    number: int
    message: str
    where: str
    hint: str


class Ready(msgspec.Struct, frozen=True, kw_only=True, tag="ready"):
    """The process has loaded and compiled everything."""


ToWorker = Ask | Withdraw
FromWorker = Answered | Failed | Ready
