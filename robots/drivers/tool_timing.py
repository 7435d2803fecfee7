"""The times of the connection of a tool with a driver, as its options and its cell say."""

from __future__ import annotations

from engine.cell.drivers import DeviceContext
from robots.drivers.fresh_link import LinkTiming


def tool_timing(context: DeviceContext, *, period_s: float, stale_s: float) -> LinkTiming:
    """Return the times; a cell that is patient with a silent engine (`engine_silence_s`) is so for its tools too."""
    usual, world = LinkTiming(period_s=period_s, stale_s=stale_s), context.cell.document.world
    silence_s = max(usual.silence_s, world.engine_silence_s) if world is not None else usual.silence_s
    return LinkTiming(period_s=period_s, stale_s=stale_s, silence_s=silence_s)
