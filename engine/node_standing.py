"""How a node stands in the middle of a run, as its events tell: entered and not left, or left and not followed up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.diagnosis import Diagnosis
from engine.event import Cause, Exited
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
    preempted: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    failed_clean_ups: dict[str, Cause] = field(default_factory=dict[str, Cause])
    round: int = 0
    done: list[Mark] = field(default_factory=list[Mark])

    def has_preempted(self, name: str) -> bool:
        """Tell whether a condition has preempted this branch of it."""
        return any(name in branches for branches in self.preempted.values())

    def take_clean_up(self, event: Exited) -> None:
        """Know why the clean-up of a branch failed that a condition has preempted."""
        name = event.path.rpartition("/")[2]
        if event.cause is not None and not event.outcome and self.has_preempted(name):
            self.failed_clean_ups[name] = event.cause

    def forget_branch(self, name: str) -> None:
        """Know no more that a condition has preempted this branch."""
        self.preempted = without_branch(self.preempted, name)
        self.failed_clean_ups.pop(name, None)


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


def without_branch(preempted: Mapping[str, tuple[str, ...]], name: str) -> dict[str, tuple[str, ...]]:
    """Return what conditions have preempted, without one branch."""
    return {said: tuple(each for each in branches if each != name) for said, branches in preempted.items()}


def as_left(left: LeftNode) -> Left:
    """Return it as its container takes it."""
    return Left(left.outcome or "", left.diverted, left.cause, left.reason)
