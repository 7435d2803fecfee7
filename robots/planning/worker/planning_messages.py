"""Messages between the planning process and its client: numbered requests and their answers."""

from __future__ import annotations

import msgspec

from engine.skills.planning_scene import CollisionReport
from robots.io.request_failure import RequestFailure
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PairDistanceRequest,
    PairDistances,
    PathCheck,
    PathCheckRequest,
    PathPlan,
    PlanRefusal,
    PlanRequest,
)
from robots.planning.swept_space import SweptSpace, SweptSpaceRequest


class WarmUpRequest(msgspec.Struct, frozen=True, kw_only=True, tag="warm_up"):
    """Load and compile everything that a first request would wait for; the first request."""


class CancelRequest(msgspec.Struct, frozen=True, kw_only=True, tag="cancel"):
    """Cancels the request of the same number; it is still answered, as canceled."""


class PlannerReady(msgspec.Struct, frozen=True, kw_only=True, tag="ready"):
    """The answer to `WarmUpRequest`."""


class CollisionReply(msgspec.Struct, frozen=True, kw_only=True, tag="collisions"):
    """The answer to a `CollisionRequest`: a message of the bus, which has no tag of its own."""

    report: CollisionReport


PlanningRequest = (
    WarmUpRequest
    | PlanRequest
    | PathCheckRequest
    | AttachedPartCheckRequest
    | CollisionRequest
    | PairDistanceRequest
    | SweptSpaceRequest
)
ToPlanner = PlanningRequest | CancelRequest
FromPlanner = (
    PlannerReady | PathPlan | PlanRefusal | PathCheck | CollisionReply | PairDistances | SweptSpace | RequestFailure
)
