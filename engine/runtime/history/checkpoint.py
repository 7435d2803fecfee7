"""A position in a run from which it, or another run, can be resumed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.runtime.record.node_checkpoint import NodeCheckpoint


@dataclass(frozen=True, kw_only=True)
class Checkpoint:
    """Everything of a run that its events up to `read_seq` tell; values are plain data."""

    run: str
    seq: int
    """The number of the last event that is kept; new ones are numbered from the next."""
    read_seq: int
    """The last event that counts; those between, if any, tell of what is done anew."""
    time_s: float
    userdata: Mapping[str, object]
    """The values of the behavior's own scope."""
    points: Mapping[str, NodeCheckpoint]
    visits: Mapping[str, int]
    parameters: Mapping[str, object] = field(default_factory=dict[str, object])
    seed: int = 0
    epoch: int = 1
    rerun: tuple[str, ...] = ()
    """The states that are entered again."""
    taken: Mapping[str, str] = field(default_factory=dict[str, str])
    """The states that are left with an outcome instead, by path."""
    undoing: str = ""
    """The state that a step back was undoing, where the engine died meanwhile."""
