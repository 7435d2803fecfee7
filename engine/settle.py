"""Waits until everything that became ready at this instant has run, so that decisions see all of it."""

from __future__ import annotations

import asyncio

from engine.clock import VirtualLoop

_QUIET_TURNS = 8
"""Loop turns a finished goal needs to travel from its future to the branch that awaits it."""


async def settle(*, depth: float) -> None:
    """Let the present instant play out; deeper containers decide before shallower ones.

    On a virtual loop this is exact: time cannot pass before. On a real loop there is no such
    instant, and a few turns of the loop stand in for it.
    """
    loop = asyncio.get_running_loop()
    if isinstance(loop, VirtualLoop):
        await loop.idle(depth)
        return
    for _ in range(_QUIET_TURNS):
        await asyncio.sleep(0)
