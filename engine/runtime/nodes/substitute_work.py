"""Substitutes for nodes in tests: they wait and end as a substitutes document specifies, without commands."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

from engine.document.expression.expression import compile_template
from engine.document.signature import read_signature
from engine.document.state_catalogue import Catalogue, find_state
from engine.document.substitutes import Substitute, SubstituteEnding, Substitutes
from engine.errors import Cause, DocumentError, ExpressionError, Position, RegistryError, StateError
from engine.runtime.nodes.behavior_reference import BehaviorReference
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import Node, NodeWork
from engine.runtime.nodes.node_entry import NodeEntry, WithoutEntry
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome, State
from engine.wording.suggestions import did_you_mean

SUBSTITUTE = "substitute"
"""The kind of a substituted node in events and displays."""


@dataclass(frozen=True, kw_only=True)
class SubstituteWork(WithoutEntry):
    """Replaces `original`: each activation ends with the next of `endings`; the last one repeats."""

    original: NodeWork
    endings: tuple[SubstituteEnding, ...]
    position: str
    """Its position in the substitutes document."""

    @property
    def kind(self) -> str:
        """The kind `substitute`."""
        return SUBSTITUTE

    @property
    def children(self) -> Mapping[str, Node]:
        """Empty: the children of the original are not entered."""
        return {}

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """Those of the original."""
        return self.original.outcomes

    @cached_property
    def nominal(self) -> frozenset[str]:
        """Those of the original."""
        return self.original.nominal

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return nothing: it has no scope of its own."""
        return {}

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Wait, write the outputs, and end."""
        ending = self.endings[min(visit, len(self.endings)) - 1]
        if ending.after_s > 0.0:
            await execution.clock.sleep(ending.after_s)
        if ending.error is not None:
            raise StateError(ending.error, where=path, hint=f"raised by the substitute at {self.position}")
        for name, value in ending.outputs.items():
            execution.write(path, scope, self.outputs.get(name, name), value)
        outcome = ending.outcome or ""
        message = f"a substitute ended with {outcome}"
        cause = None if outcome in self.nominal else Cause(message=message, where=path, kind="Substitute")
        return Outcome(outcome, cause=cause)

    @cached_property
    def outputs(self) -> Mapping[str, str]:
        """The userdata keys that outputs of the original are mapped to."""
        return self.original.outputs if isinstance(self.original, Leaf | BehaviorReference) else {}

    @cached_property
    def written(self) -> frozenset[str] | None:
        """The permitted output names; None where any name is permitted."""
        if isinstance(self.original, Leaf):
            return frozenset(self.original.signature.outputs)
        return frozenset(self.original.outputs) if isinstance(self.original, BehaviorReference) else None


def substitute_for(path: str, work: NodeWork, substitutes: Substitutes, catalogue: Catalogue) -> NodeWork:
    """Return the substitute for the work of a node, or the work itself where there is none.

    Raises:
        DocumentError: the substitute does not fit the node; `where` is its position.
    """
    index = substitutes.index_for(path)
    if index is None:
        return work
    entry = substitutes.document.substitutes[index]
    if entry.state is not None:
        find = partial(find_state, catalogue, given=substitutes.classes)
        return _other_state(path, work, entry, where=substitutes.position(index, "state"), find=find)
    substitute = SubstituteWork(original=work, endings=entry.endings, position=str(substitutes.position(index)))
    for number, ending in enumerate(entry.endings):
        keys = ("script", number) if entry.script else ()
        if ending.outcome is not None and ending.outcome not in work.outcomes:
            where = substitutes.position(index, *keys, "outcome")
            hint = did_you_mean(ending.outcome, work.outcomes)
            raise DocumentError(f"`{path}` has no outcome `{ending.outcome}`", where=where, hint=hint)
        for output in ending.outputs:
            if substitute.written is not None and output not in substitute.written:
                where = substitutes.position(index, *keys, "outputs", output)
                hint = did_you_mean(output, substitute.written)
                raise DocumentError(f"`{path}` has no output `{output}`", where=where, hint=hint)
    return substitute


def require_used(substitutes: Substitutes, paths: Collection[str]) -> None:
    """Refuse an entry that matches none of the nodes.

    Raises:
        DocumentError: an entry matches no node.
    """
    used = {substitutes.index_for(path) for path in paths}
    for index, entry in enumerate(substitutes.document.substitutes):
        if index not in used:
            raise DocumentError(
                f"`{entry.at}` matches no node of this behavior",
                where=substitutes.position(index, "at"),
                hint=f"another entry may replace it or a container around it; {did_you_mean(entry.at, paths)}",
            )


def _other_state(
    path: str, work: NodeWork, entry: Substitute, *, where: Position, find: Callable[[str], type[State]]
) -> Leaf:
    if not isinstance(work, Leaf):
        hint = "give an `outcome` or a `script`"
        raise DocumentError(f"`{path}` is a {work.kind}, which a state cannot replace", where=where, hint=hint)
    try:
        state = find(entry.state or "")
        given = work.parameters if entry.parameters is None else compile_template(entry.parameters)
    except (RegistryError, ExpressionError) as error:
        raise DocumentError(error.message, where=where, hint=error.hint) from error
    others = [outcome for outcome in state.outcomes if outcome not in work.outcomes]
    if others:
        message = f"`{entry.state}` has an outcome `{others[0]}` without a transition here"
        raise DocumentError(message, where=where, hint=f"`{path}` has {', '.join(work.outcomes)}")
    signature = read_signature(state)
    return replace(work, state=state, signature=signature, parameters=given, position=str(where), kind=SUBSTITUTE)
