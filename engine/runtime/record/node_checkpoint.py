"""Checkpoint of one node: the data required to resume it instead of starting it again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.errors import Cause


@dataclass(frozen=True, kw_only=True)
class NodeCheckpoint:
    """One node of a run that is to be resumed.

    A node that has `left` (an outcome) proceeds with its retry and its transition; with `passed` the gate has already
    released it, or an operator has decided its outcome. An active container resumes the children that have checkpoints
    of their own; an active state is entered again.
    """

    visit: int
    entered: bool = True
    """False between two attempts: the node is to be entered again."""
    left: str | None = None
    diverted: str | None = None
    """The target, where timeout, guard or on_error diverted it."""
    failed: bool = False
    """It ended with the error `cause`, which was not handled yet."""
    cause: Cause | None = None
    """The last failure: of the node where it has exited, among its children where it is active."""
    reason: Cause | None = None
    """The reason of its outcome, or of the course of its children, where nothing failed."""
    passed: bool = False
    attempt: int = 1
    elapsed_s: float = 0.0
    """How long it had been active, for its timeout."""
    inputs: Mapping[str, object] = field(default_factory=dict[str, object])
    """Its inputs, as plain data."""
    current: str | None = None
    """The child that a machine executes or is about to enter, or the outcome that it is about to have."""
    values: Mapping[str, object] = field(default_factory=dict[str, object])
    """The userdata of a container's own scope."""
    branches: Mapping[str, Mapping[str, object]] = field(default_factory=dict[str, Mapping[str, object]])
    """The values that the children of a concurrency container had written into their own scopes."""
    preempted: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """The children of a concurrency container that its conditions have preempted, by the text of the condition."""
    failed_clean_ups: Mapping[str, Cause] = field(default_factory=dict[str, Cause])
    """The causes of their failed clean-ups."""
    round: int = 0
    """The current round of a foreach container, from 0."""
    done: tuple[tuple[str, str, float], ...] = ()
    """The events of a tree, in order: `engine.runtime.record.tree_event.TreeEvent`."""

    @property
    def active(self) -> bool:
        """Whether it was entered and has not exited."""
        return self.left is None and self.diverted is None and not self.failed
