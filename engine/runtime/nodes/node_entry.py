"""Entry data of a node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.runtime.userdata.userdata import Scope
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


class WithoutEntry:
    """Work with an empty entry: what runs in it evaluates its own inputs."""

    @property
    def constant(self) -> NodeEntry:
        """The empty entry."""
        return EMPTY_ENTRY

    def enter(self, scope: Scope) -> NodeEntry:
        """Return the empty entry."""
        return EMPTY_ENTRY
