"""How a node stands in the middle of a run, as its events tell: entered and not left, or left and not followed up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.diagnosis import Diagnosis
from engine.event import Cause
from engine.node_exit import Left
from engine.tree_mark import Mark


@dataclass
class OpenNode:
    """A node that was entered and not left."""

    visit: int
    inputs: Mapping[str, object]
    since_s: float
    attempt: int = 1
    entered: bool = True
    current: str | None = None
    diagnosis: Diagnosis = field(default_factory=Diagnosis)
    round: int = 0
    done: list[Mark] = field(default_factory=list[Mark])


@dataclass(frozen=True)
class LeftNode:
    """A node that was left, and whose container has not gone on yet."""

    visit: int
    outcome: str | None
    diverted: str | None
    cause: Cause | None
    reason: Cause | None = None
    passed: bool = False
    attempt: int = 1
    since_s: float = 0.0


def as_left(left: LeftNode) -> Left:
    """Return it as its container takes it."""
    return Left(left.outcome or "", left.diverted, left.cause, left.reason)
