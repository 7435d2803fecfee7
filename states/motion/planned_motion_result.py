"""Judges how a collision-free motion ended, in the words of its states."""

from __future__ import annotations

from engine.cause_chain import links_from_root
from engine.event import Cause
from engine.skills.planning import FreeMotionResult
from engine.state import ActionEnd


def inner_cause_text(cause: Cause) -> str:
    """Return what lies below the outermost link of a chain in one line, what was measured first."""
    below = [link.message for link in links_from_root(cause)[:-1]]
    return ", so ".join(below) or cause.message


def is_blocked_timeout(end: ActionEnd[FreeMotionResult]) -> bool:
    """Tell whether a motion was given up because its way did not get free in time."""
    return end.status == "aborted" and end.result is not None and bool(end.result.blocked)
