"""Builds the cause of a goal that did not succeed: who, which skill, its end status, and the device's cause."""

from __future__ import annotations

from typing import Any

from engine.cause_chain import wrap_cause
from engine.errors import PathBlocked
from engine.event import Cause
from engine.skill import Action
from engine.skills.goal_end import GoalEnd

_BLOCKED = PathBlocked.__name__
_NO_REASON = {
    "canceled": "the goal was cancelled by somebody other than this state",
    "rejected": "the device gave no reason for refusing it",
}


def goal_cause(what: str, goal: Action[Any, Any], end: GoalEnd[Any], *, to: str, where: str, kind: str) -> Cause:
    """Return the cause chain of a failed goal.

    Args:
        what: The message, `left did not reach joints entry home`.
        goal: The goal that was sent.
        end: The end of the goal; its cause is the inner cause of the chain.
        to: The bus namespace that the goal was sent to.
        where: The path of the state.
        kind: The name of the state.
    """
    skill = goal.skill_name()
    fallback = Cause(message=_NO_REASON.get(end.status, "the device gave no reason"), where=f"{to}/{skill}")
    return wrap_cause(f"{what}: {skill} was {end.status}", end.cause or fallback, where=where, kind=kind)


def is_path_blocked(end: GoalEnd[Any]) -> bool:
    """Tell whether a goal was refused because the planning scene blocks its path."""
    return end.cause is not None and any(link.kind == _BLOCKED for link in end.cause.chain())
