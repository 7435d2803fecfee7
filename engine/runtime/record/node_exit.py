"""How a node is left: with an outcome or for a target, with what went wrong, or what led to it."""

from __future__ import annotations

import msgspec

from engine.event import Cause
from engine.state import Outcome


class NodeExit(msgspec.Struct, frozen=True):
    """How a node was left: with an outcome, or straight to a target (timeout, guard, on_error).

    `reason` is how it came to that where nothing went wrong; events do not hold it. With `back` it was given up for a
    step back to the sibling `target`; `cause` and `reason` are what the container knew then.
    """

    outcome: str
    target: str | None = None
    cause: Cause | None = None
    reason: Cause | None = None
    back: bool = False


PREEMPTED = NodeExit("")
"""How a branch has ended that a condition of its container has preempted."""


class ContainerOutcome(Outcome, frozen=True):
    """The outcome of a container; `reason` is how it came to it, for an outcome that has no cause."""

    reason: Cause | None = None


def exit_from_outcome(outcome: Outcome) -> NodeExit:
    """Return how a node is left whose work has ended so."""
    if isinstance(outcome, ContainerOutcome):
        return NodeExit(outcome.name, None, outcome.cause, outcome.reason)
    return NodeExit(outcome.name, None, outcome.cause)


def guard_closed_cause(path: str) -> Cause:
    """Return why a node was not entered."""
    return Cause(message="the guard is closed", where=path, kind="Guard")
