"""Whether an arm in motion must stop: the answer to a check of its path, or why there is none."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Coroutine
from dataclasses import dataclass

from engine.errors import FlexcellError
from robots.arm.scene_queries.path_planner import describe_contacts
from robots.planning.request import PathCheck
from robots.planning.scene.planning_scene import NamePair
from robots.workspace.workspace import Workspace

# Timeout of a check: a longer one counts as no monitoring.
_CHECK_S = 0.3


@dataclass(frozen=True, kw_only=True)
class PredictedCollision:
    """Why an arm must stop, the time of the collision in its path's own time, and the bodies that would touch."""

    reason: str
    at_s: float = math.inf
    pairs: tuple[NamePair, ...] = ()

    @property
    def is_unmonitored(self) -> bool:
        """True if the path could not be checked, so that nothing is known of a collision."""
        return math.isinf(self.at_s)


async def predict_collision(
    workspace: Workspace, query: Coroutine[object, object, PathCheck], *, by_cameras: bool = True
) -> PredictedCollision | None:
    """Return the collision on a path that is being checked; None if it is free.

    An arm that is not monitored must stop too. What the cameras do matters to a check `by_cameras` only.
    """
    if by_cameras and (unobserved := workspace.unobserved_reason):
        query.close()
        return PredictedCollision(reason=unobserved)
    try:
        async with asyncio.timeout(_CHECK_S):
            check = await query
    except TimeoutError:
        return PredictedCollision(reason=f"its path was not checked within {_CHECK_S:g} s")
    except FlexcellError as error:
        return PredictedCollision(reason=f"path monitoring is not available: {error.message}")
    if check.blocked_at_s is None:
        return None
    return PredictedCollision(reason=describe_contacts(check.pairs), at_s=check.blocked_at_s, pairs=check.pairs)
