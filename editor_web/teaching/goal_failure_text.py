"""Text of a goal's failure, for the page."""

from __future__ import annotations

from typing import Any

from engine.bus import GoalEnd
from engine.cause_chain import describe_cause


def goal_failure_text(end: GoalEnd[Any]) -> str:
    """Return the cause in one line; the status if there is no cause."""
    return describe_cause(end.cause) if end.cause is not None else end.status.value
