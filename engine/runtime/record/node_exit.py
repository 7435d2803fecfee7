"""Exit of a node: its outcome or diversion target, and the cause or reason."""

from __future__ import annotations

import msgspec

from engine.errors import Cause
from engine.state import Outcome


class NodeExit(msgspec.Struct, frozen=True):
    """Exit of a node: with an outcome, or directly to a target (timeout, guard, on_error).

    `reason` explains the exit where nothing failed; events do not hold it. With `back` it was preempted for a step back
    to the sibling `target`; `cause` and `reason` are then those of the container at that point.
    """

    outcome: str
    target: str | None = None
    cause: Cause | None = None
    reason: Cause | None = None
    back: bool = False


PREEMPTED = NodeExit("")
"""Exit of a branch that a condition of its container has preempted."""


class ContainerOutcome(Outcome, frozen=True):
    """The outcome of a container; `reason` explains an outcome that has no cause."""

    reason: Cause | None = None


def exit_from_outcome(outcome: Outcome) -> NodeExit:
    """Return the exit of a node whose work ended with this outcome."""
    if isinstance(outcome, ContainerOutcome):
        return NodeExit(outcome.name, None, outcome.cause, outcome.reason)
    return NodeExit(outcome.name, None, outcome.cause)


def guard_closed_cause(path: str) -> Cause:
    """Return the cause for a node whose closed guard prevented its entry."""
    return Cause(message="the guard is closed", where=path, kind="Guard")
