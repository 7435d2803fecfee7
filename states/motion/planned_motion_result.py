"""Interprets the end of a collision-free motion for its states."""

from __future__ import annotations

from engine.cause_chain import links_from_root
from engine.errors import Cause
from engine.skills.goal_end import GoalEnd
from engine.skills.planning import FreeMotionResult


def inner_cause_text(cause: Cause) -> str:
    """Return the links below the outermost link of a chain in one line, root cause first."""
    inner = [link.message for link in links_from_root(cause)[:-1]]
    return ", so ".join(inner) or cause.message


def is_blocked_timeout(end: GoalEnd[FreeMotionResult]) -> bool:
    """Return whether a motion was aborted because its path stayed blocked until the timeout."""
    return end.status == "aborted" and end.result is not None and bool(end.result.blocked)
