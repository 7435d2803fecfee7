"""Checkpoint of one node: what is needed to resume it instead of starting it again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.event import Cause


@dataclass(frozen=True, kw_only=True)
class NodeCheckpoint:
    """One node of a run that is to be gone on with.

    A node that has `left` (an outcome) is asked for its retry and its transition; with `passed` the
    gate has let it go already, or somebody has decided for it. An active container goes on with the
    children that have points of their own; an active state is entered again.
    """

    visit: int
    entered: bool = True
    """False between two attempts: the node is to be entered, and has been before."""
    left: str | None = None
    diverted: str | None = None
    """The target, where it was left by timeout, guard or on_error."""
    failed: bool = False
    """It ended with the error `cause`, which nobody had handled yet."""
    cause: Cause | None = None
    """What went wrong last: in it where it has left, among its children where it is active."""
    reason: Cause | None = None
    """How it came to its outcome, or what decided the course of its children, where nothing went wrong."""
    passed: bool = False
    attempt: int = 1
    elapsed_s: float = 0.0
    """How long it had been performed, for its timeout."""
    inputs: Mapping[str, object] = field(default_factory=dict[str, object])
    """What it was entered with, as plain data."""
    current: str | None = None
    """The child that a machine is at, or is about to enter, or the outcome that it is about to have."""
    values: Mapping[str, object] = field(default_factory=dict[str, object])
    """The userdata of a container's own scope."""
    branches: Mapping[str, Mapping[str, object]] = field(default_factory=dict[str, Mapping[str, object]])
    """What the children of a concurrency container had written into scopes of their own."""
    preempted: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    """The children of a concurrency container that its conditions have preempted, by the condition in words."""
    failed_clean_ups: Mapping[str, Cause] = field(default_factory=dict[str, Cause])
    """Why the clean-up of some of them had failed."""
    round: int = 0
    """The round that a foreach container is in, from 0."""
    done: tuple[tuple[str, str, float], ...] = ()
    """What had happened in a tree, in order: `engine.runtime.record.tree_event.TreeEvent`."""

    @property
    def active(self) -> bool:
        """Whether it had been entered and not left."""
        return self.left is None and self.diverted is None and not self.failed
