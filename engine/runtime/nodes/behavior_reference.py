"""Work of a behavior reference: another behavior with its own parameters and userdata keys."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import msgspec

from engine.document.expression.expression import Template
from engine.runtime.nodes.diagnosis import explain_exit
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry
from engine.runtime.record.node_exit import ContainerOutcome
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome


class ReferencedBehavior(Protocol):
    """The plan of the referenced behavior."""

    @property
    def root(self) -> Node:
        """Its outermost node, with paths below the reference."""
        ...

    @property
    def outcomes(self) -> tuple[str, ...]:
        """Its outcomes."""
        ...

    @property
    def success(self) -> tuple[str, ...]:
        """The outcomes that mean success."""
        ...

    @property
    def userdata(self) -> Mapping[str, object]:
        """Initial values of its own scope."""
        ...

    def checked_parameters(self, given: Mapping[str, object]) -> dict[str, object]:
        """Return values for all its parameters; raises DocumentError."""
        ...


@dataclass(frozen=True, kw_only=True)
class BehaviorReference:
    """Runs `target` in a scope that only `inputs` and `outputs` connect with the enclosing scope."""

    target: ReferencedBehavior
    parameters: Template
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    position: str

    @property
    def kind(self) -> str:
        """The key of this node in documents."""
        return "behavior"

    @property
    def children(self) -> Mapping[str, Node]:
        """The root of the referenced behavior."""
        return {"root": self.target.root}

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """The outcomes that its document declares."""
        return self.target.outcomes

    @cached_property
    def nominal(self) -> frozenset[str]:
        """The success outcomes of its document; all outcomes where it declares none."""
        return frozenset(self.target.success or self.target.outcomes)

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return the initial values of its scope."""
        return {**self.target.userdata, **inputs}

    @property
    def constant(self) -> None:
        """None: the entry depends on userdata."""
        return None

    def enter(self, scope: Scope) -> NodeEntry:
        """Evaluate its parameters and read its inputs."""
        variables = {name: scope.read(name, reader=self.position) for name in self.parameters.names}
        given = msgspec.convert(self.parameters.evaluate(variables), dict[str, object])
        inputs = {inner: scope.read(outer, reader=self.position) for inner, outer in self.inputs.items()}
        values = {**self.target.checked_parameters(given), **inputs}
        return NodeEntry(None, values, msgspec.to_builtins(values))

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Run the referenced behavior to one of its outcomes and copy its `outputs` to the enclosing scope."""
        values = entry.point.values if entry.point is not None else self.initial_values(entry.inputs)
        inner = execution.scopes.open(path, values)
        left = await self.target.root.perform(inner, execution)
        name = left.target or left.outcome
        for key, outer in self.outputs.items():
            with execution.counted():
                value = inner.read(key, reader=self.position)
            execution.write(path, scope, outer, value)
        reason = explain_exit(self.target.root, left)
        return ContainerOutcome(name, cause=None if name in self.nominal else reason, reason=reason)
