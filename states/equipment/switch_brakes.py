"""Switches the brakes of a device, which are positions of it, and says why they are not there."""

from __future__ import annotations

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.skills import device_moves
from engine.state import Context, goal_cause


async def switch_brakes(ctx: Context, device: str, position: str, *, kind: str) -> Cause | None:
    """Move the device to a position of its brakes; return why it is not there.

    Args:
        ctx: The context of the state.
        device: The device with the brakes.
        position: The position, released or locked.
        kind: The name of the state, for the cause.
    """
    goal = device_moves.MoveDevice(position=position)
    end = await ctx.perform(goal, to=device)
    what, result = f"{device} did not move to {position}", end.result
    if end.status != "succeeded" or result is None or result.ended == "canceled":
        return goal_cause(what, goal, end, to=device, where=ctx.path, kind=kind)
    if result.ended in ("reached", "timed"):
        return None
    reason = Cause(message=result.reason or result.ended, where=goal.address(device))
    return wrap_cause(what, reason, where=ctx.path, kind=kind)
