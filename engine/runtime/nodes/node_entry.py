"""Entry data of a node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.state import State


@dataclass(frozen=True)
class NodeEntry:
    """Entry of a node: the state to run, its input values, and both as plain data.

    `point` is the checkpoint of a container that is resumed.
    """

    state: State | None = None
    inputs: Mapping[str, object] = field(default_factory=dict[str, object])
    shown: dict[str, object] = field(default_factory=dict[str, object])
    point: NodeCheckpoint | None = None


EMPTY_ENTRY = NodeEntry()
