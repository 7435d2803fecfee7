"""What a node is entered with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.state import State


@dataclass(frozen=True)
class NodeEntry:
    """What a node was entered with: the state to run, its input values, and both as plain data.

    `point` says where to go on inside a container that was entered before.
    """

    state: State | None = None
    inputs: Mapping[str, object] = field(default_factory=dict[str, object])
    shown: dict[str, object] = field(default_factory=dict[str, object])
    point: NodeCheckpoint | None = None


EMPTY_ENTRY = NodeEntry()
