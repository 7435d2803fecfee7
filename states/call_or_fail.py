"""Calls a service of a device and turns its refusal into an outcome that a behavior can handle."""

from __future__ import annotations

from typing import Any

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import LeaseRefused, SkillFailed
from engine.skill import Service
from engine.skills.switch_result import SwitchResult
from engine.state import Context, Outcome


async def call_or_fail(ctx: Context, request: Service[Any], *, to: str, done: str, what: str, kind: str) -> Outcome:
    """Return the outcome `done`, or `failed` with the reason if the device refuses or fails.

    Args:
        ctx: The state's context.
        request: The service request.
        to: The bus namespace of the service.
        done: The outcome on success.
        what: The message on failure, `left does not compensate a load of 1.00 kg`.
        kind: The name of the state.

    Raises:
        NoSuchSkill: no such service: a mistake of the behavior or the cell.
    """
    address = f"{to}/{request.skill_name()}"
    try:
        answer = await ctx.call(request, to=to)
    except (SkillFailed, LeaseRefused) as error:
        return Outcome("failed", cause=wrap_cause(what, cause_of(error), where=ctx.path, kind=kind))
    if isinstance(answer, SwitchResult) and not answer.success:
        refusal = cause_of(SkillFailed(answer.message, where=address))
        return Outcome("failed", cause=wrap_cause(what, refusal, where=ctx.path, kind=kind))
    return Outcome(done)
