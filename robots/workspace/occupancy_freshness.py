"""Waits until the occupancy map of the cameras is valid."""

from __future__ import annotations

import asyncio

from engine.errors import RobotError
from robots.vision.occupancy.occupancy_source import OccupancySource
from robots.workspace.live_scene import OCCUPANCY

_FRESH_S = 3.0
_STARTED_S = 120.0
"""Longest start of the cameras: on a new machine all kernels are compiled first."""


async def wait_until_fresh(source: OccupancySource) -> None:
    """Return when the map is valid; waits longer for cameras that are still starting.

    Raises:
        RobotError: the map is not valid in time; the message gives the reason.
    """
    if not source.stale_reason:
        return
    changed = asyncio.Event()
    unsubscribe = source.subscribe(changed.set)
    try:
        async with asyncio.timeout(_STARTED_S):
            while source.starting and source.stale_reason:
                await changed.wait()
                changed.clear()
        async with asyncio.timeout(_FRESH_S):
            while source.stale_reason:
                await changed.wait()
                changed.clear()
    except TimeoutError:
        raise RobotError(
            f"the occupancy map is not valid: {source.stale_reason}",
            where=OCCUPANCY,
            hint="check the cameras, then try again",
        ) from None
    finally:
        unsubscribe()
