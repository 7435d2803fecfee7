"""The priority container: a machine that holds every branch outside itself while it is active."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from engine.entry import NOTHING, Entry
from engine.execution import Execution
from engine.machine import Machine
from engine.node import Node
from engine.node_path import inside
from engine.state import Outcome
from engine.userdata import Scope


@dataclass(frozen=True, kw_only=True)
class Priority:
    """Runs `machine`; branches that are not on its path stand still meanwhile, as in a pause."""

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
        """The values its scope begins with."""
        return self.machine.userdata

    @property
    def constant(self) -> Entry:
        """Nothing."""
        return NOTHING

    def enter(self, scope: Scope) -> Entry:
        """Nothing is evaluated: the children evaluate theirs."""
        return NOTHING

    async def run(self, entry: Entry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Hold the others, run the machine, let them go on; a nested one holds more.

        Of several that are entered at one instant the first holds the others, which hold theirs when it has ended.
        """
        reason = f"priority of {path}"
        await execution.suspensions.until_free(path)
        execution.suspensions.hold(
            reason,
            lambda other: not (inside(path, other) or inside(other, path) or execution.gate.undoes(other)),
        )
        execution.gate.arm()
        try:
            return await self.machine.run(entry, path, visit, scope, execution)
        finally:
            execution.suspensions.release(reason)
            execution.gate.arm()
