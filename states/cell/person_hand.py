"""Sends the hand of a person of the cell somewhere, and waits until it is there where that is wanted."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import LeaseRefused, SkillFailed
from engine.skills.people import Reach, Withdraw
from engine.state import Context, Outcome

CELL = "cell"
"""Where people are asked on the bus."""

PersonName = Annotated[
    str, Meta(min_length=1, description="Name of the person in the cell", extra_json_schema={"cell_name": "person"})
]
WaitForArrival = Annotated[bool, Meta(description="Whether to go on only when the hand is there, or at once")]


async def move_hand(ctx: Context, request: Reach | Withdraw, *, wait: bool, what: str, kind: str) -> Outcome:
    """Return `done`, or `failed` with the reason where the arm cannot get there.

    Args:
        ctx: The state's context.
        request: Whose hand is sent where.
        wait: True to return when the hand has had the time that its way takes.
        what: What was not achieved if not, `anna does not reach into the cell`.
        kind: The name of the state.

    Raises:
        NoSuchSkill: the cell has no people: a mistake of the behavior or the cell.
    """
    try:
        reaching = await ctx.call(request, to=CELL)
    except (SkillFailed, LeaseRefused) as error:
        return Outcome("failed", cause=wrap_cause(what, cause_of(error), where=ctx.path, kind=kind))
    if wait:
        await ctx.clock.sleep(reaching.arrives_in_s)
    return Outcome("done")
