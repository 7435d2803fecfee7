"""The work of a disabled node: none; the node ends with the outcome that its document names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry, WithoutEntry
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome


@dataclass(frozen=True, kw_only=True)
class DisabledWork(WithoutEntry):
    """Stands for the state or container of a disabled node, of which nothing is loaded."""

    outcome: str

    @property
    def kind(self) -> str:
        """The kind of a disabled node in displays."""
        return "disabled"

    @property
    def children(self) -> Mapping[str, Node]:
        """Empty: what is inside is disabled with it."""
        return {}

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """The outcome by which it is passed over."""
        return (self.outcome,)

    @cached_property
    def nominal(self) -> frozenset[str]:
        """That outcome: passing over a node is no failure."""
        return frozenset(self.outcomes)

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return nothing: it has no scope of its own."""
        return {}

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """End at once; its node is passed over without calling this."""
        return Outcome(self.outcome)
