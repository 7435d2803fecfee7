"""State of a node during a run, from its events: active, or exited while its container has not proceeded."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from engine.errors import Cause
from engine.event import NodeExited
from engine.runtime.nodes.diagnosis import Diagnosis
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.record.tree_event import TreeEvent


class ActiveNodeState(msgspec.Struct):
    """Course of a node that was entered and not exited, or that waits for its next attempt."""

    visit: int
    inputs: Mapping[str, object]
    since_s: float
    attempt: int = 1
    current: str | None = None
    diagnosis: Diagnosis = msgspec.field(default_factory=Diagnosis)
    preempted: dict[str, tuple[str, ...]] = {}
    failed_clean_ups: dict[str, Cause] = {}
    round: int = 0
    done: list[TreeEvent] = []

    def has_preempted(self, name: str) -> bool:
        """Return whether a condition has preempted this branch of it."""
        return any(name in branches for branches in self.preempted.values())

    def take_clean_up(self, event: NodeExited) -> None:
        """Store the cause of a failed clean-up of a branch that a condition has preempted."""
        name = event.path.rpartition("/")[2]
        if event.cause is not None and not event.outcome and self.has_preempted(name):
            self.failed_clean_ups[name] = event.cause

    def forget_branch(self, name: str) -> None:
        """Drop the preemption of this branch."""
        self.preempted = without_branch(self.preempted, name)
        self.failed_clean_ups.pop(name, None)


class PendingExit(msgspec.Struct, frozen=True):
    """A node that has exited while its container has not proceeded."""

    visit: int
    outcome: str | None
    diverted: str | None
    cause: Cause | None
    reason: Cause | None = None
    passed: bool = False
    attempt: int = 1
    since_s: float = 0.0


def without_branch(preempted: Mapping[str, tuple[str, ...]], name: str) -> dict[str, tuple[str, ...]]:
    """Return the preempted branches by condition, without one branch."""
    return {condition: tuple(each for each in names if each != name) for condition, names in preempted.items()}


def exit_of(left: PendingExit) -> NodeExit:
    """Return the exit as its container receives it."""
    return NodeExit(left.outcome or "", left.diverted, left.cause, left.reason)
