"""A position in a run from which it, or another run, can be resumed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.runtime.record.node_checkpoint import NodeCheckpoint


@dataclass(frozen=True, kw_only=True)
class Checkpoint:
    """State of a run according to its events up to `read_seq`; values are plain data."""

    run: str
    seq: int
    """The number of the last stored event; new events continue from the next number."""
    read_seq: int
    """The last event that applies; events after it, up to `seq`, describe work that is repeated."""
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
    """The states that exit with a given outcome instead, by path."""
    stepping_back: str = ""
    """The state that a step back was about to undo when the engine died; empty for none."""
