"""Moves the hand of a person of the cell and optionally waits for its arrival."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import LeaseRefused, SkillFailed
from engine.skills.people import Reach, Withdraw
from engine.state import Context, Outcome

CELL = "cell"
"""Bus namespace of the services for people."""

PersonName = Annotated[
    str, Meta(min_length=1, description="Name of the person in the cell", extra_json_schema={"cell_name": "person"})
]
WaitForArrival = Annotated[bool, Meta(description="True to wait until the hand arrives, false to continue at once")]


async def move_hand(ctx: Context, request: Reach | Withdraw, *, wait: bool, what: str, kind: str) -> Outcome:
    """Return `done`, or `failed` with the reason if the hand cannot reach the target.

    Args:
        ctx: The state's context.
        request: The person and the target of the hand.
        wait: True to return after the duration of the hand's motion.
        what: The message on failure, `anna does not reach into the cell`.
        kind: The name of the state.

    Raises:
        NoSuchSkill: the cell has no people: a mistake of the behavior or the cell.
    """
    try:
        motion = await ctx.call(request, to=CELL)
    except (SkillFailed, LeaseRefused) as error:
        return Outcome("failed", cause=wrap_cause(what, cause_of(error), where=ctx.path, kind=kind))
    if wait:
        await ctx.clock.sleep(motion.arrives_in_s)
    return Outcome("done")
