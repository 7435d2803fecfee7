"""The priority container: a machine that holds every branch outside itself while it is active."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from engine.node_path import is_inside
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.machine import Machine
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry, WithoutEntry
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome


@dataclass(frozen=True, kw_only=True)
class Priority(WithoutEntry):
    """Runs `machine`; all other branches are held meanwhile, as in a pause."""

    machine: Machine

    @property
    def kind(self) -> str:
        """The key of this container in documents."""
        return "priority"

    @property
    def children(self) -> Mapping[str, Node]:
        """The states of its machine."""
        return self.machine.children

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """Those of its machine."""
        return self.machine.outcomes

    @cached_property
    def nominal(self) -> frozenset[str]:
        """Those of its machine."""
        return self.machine.nominal

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return the initial values of its scope."""
        return self.machine.userdata

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Hold the other branches, run the machine, release them; a nested priority holds more branches.

        Of several priorities entered at one instant, the first holds the others; they run after it has ended.
        """
        reason = f"priority of {path}"
        await execution.branch_holds.until_free(path)
        execution.branch_holds.hold(
            reason,
            lambda other: not (is_inside(path, other) or is_inside(other, path) or execution.gate.undoes(other)),
        )
        execution.gate.arm()
        try:
            return await self.machine.run(entry, path, visit, scope, execution)
        finally:
            execution.branch_holds.release(reason)
            execution.gate.arm()
