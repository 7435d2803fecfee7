"""State of a node in the middle of a run, from its events: active, or exited while its container has not proceeded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.event import Cause, NodeExited
from engine.runtime.nodes.diagnosis import Diagnosis
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.record.tree_event import TreeEvent


@dataclass
class ActiveNodeState:
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
    done: list[TreeEvent] = field(default_factory=list[TreeEvent])

    def has_preempted(self, name: str) -> bool:
        """Tell whether a condition has preempted this branch of it."""
        return any(name in branches for branches in self.preempted.values())

    def take_clean_up(self, event: NodeExited) -> None:
        """Know why the clean-up of a branch failed that a condition has preempted."""
        name = event.path.rpartition("/")[2]
        if event.cause is not None and not event.outcome and self.has_preempted(name):
            self.failed_clean_ups[name] = event.cause

    def forget_branch(self, name: str) -> None:
        """Know no more that a condition has preempted this branch."""
        self.preempted = without_branch(self.preempted, name)
        self.failed_clean_ups.pop(name, None)


@dataclass(frozen=True)
class PendingExit:
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


def exit_of(left: PendingExit) -> NodeExit:
    """Return it as its container takes it."""
    return NodeExit(left.outcome or "", left.diverted, left.cause, left.reason)
