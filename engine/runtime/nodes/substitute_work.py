"""Substitutes for nodes in tests: they wait and end as a substitutes document specifies, and command nothing."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

from engine.document.expression import compile_template
from engine.document.signature import read_signature
from engine.document.state_catalogue import Catalogue, find_state
from engine.document.substitutes import Substitute, SubstituteEnding, Substitutes
from engine.errors import DocumentError, ExpressionError, Position, RegistryError, StateError
from engine.event import Cause
from engine.runtime.nodes.behavior_reference import BehaviorReference
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import Node, NodeWork
from engine.runtime.nodes.node_entry import EMPTY_ENTRY, NodeEntry
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome, State
from engine.suggestions import did_you_mean

SUBSTITUTE = "substitute"
"""The kind of a node that is stood in for, in events and wherever they are shown."""


@dataclass(frozen=True, kw_only=True)
class SubstituteWork:
    """Ends for `original` as one of `endings` says: each activation takes the next, and the last one stays."""

    original: NodeWork
    endings: tuple[SubstituteEnding, ...]
    position: str
    """Where it is written."""

    @property
    def kind(self) -> str:
        """That it is a substitute."""
        return SUBSTITUTE

    @property
    def children(self) -> Mapping[str, Node]:
        """None: what is inside the original is not entered."""
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
        """Nothing: it has no scope of its own."""
        return {}

    @property
    def constant(self) -> NodeEntry:
        """Nothing."""
        return EMPTY_ENTRY

    def enter(self, scope: Scope) -> NodeEntry:
        """Nothing is evaluated: what the original would be given may not even be there in a test."""
        return EMPTY_ENTRY

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Wait, write the outputs, and end."""
        ending = self.endings[min(visit, len(self.endings)) - 1]
        if ending.after_s > 0.0:
            await execution.clock.sleep(ending.after_s)
        if ending.error is not None:
            raise StateError(ending.error, where=path, hint=f"a substitute says so, {self.position}")
        for name, value in ending.outputs.items():
            execution.write(path, scope, self.outputs.get(name, name), value)
        outcome = ending.outcome or ""
        message = f"a substitute ended with {outcome}"
        cause = None if outcome in self.nominal else Cause(message=message, where=path, kind="Substitute")
        return Outcome(outcome, cause=cause)

    @cached_property
    def outputs(self) -> Mapping[str, str]:
        """The userdata keys that outputs of the original are written to, where they are called otherwise."""
        return self.original.outputs if isinstance(self.original, Leaf | BehaviorReference) else {}

    @cached_property
    def written(self) -> frozenset[str] | None:
        """The names that outputs may have; None where any may be written."""
        if isinstance(self.original, Leaf):
            return frozenset(self.original.signature.outputs)
        return frozenset(self.original.outputs) if isinstance(self.original, BehaviorReference) else None


def substitute_for(path: str, work: NodeWork, substitutes: Substitutes, catalogue: Catalogue) -> NodeWork:
    """Return what stands in for the work of a node, or that work where nothing does.

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
    made = SubstituteWork(original=work, endings=entry.endings, position=str(substitutes.position(index)))
    for number, ending in enumerate(entry.endings):
        keys = ("script", number) if entry.script else ()
        if ending.outcome is not None and ending.outcome not in work.outcomes:
            where = substitutes.position(index, *keys, "outcome")
            hint = did_you_mean(ending.outcome, work.outcomes)
            raise DocumentError(f"`{path}` has no outcome `{ending.outcome}`", where=where, hint=hint)
        for output in ending.outputs:
            if made.written is not None and output not in made.written:
                where = substitutes.position(index, *keys, "outputs", output)
                hint = did_you_mean(output, made.written)
                raise DocumentError(f"`{path}` has no output `{output}`", where=where, hint=hint)
    return made


def require_used(substitutes: Substitutes, paths: Collection[str]) -> None:
    """Refuse an entry that stands in for none of the nodes.

    Raises:
        DocumentError: one does.
    """
    used = {substitutes.index_for(path) for path in paths}
    for index, entry in enumerate(substitutes.document.substitutes):
        if index not in used:
            raise DocumentError(
                f"`{entry.at}` stands in for no node of this behavior",
                where=substitutes.position(index, "at"),
                hint=f"another entry may stand in for it, or for one around it; {did_you_mean(entry.at, paths)}",
            )


def _other_state(
    path: str, work: NodeWork, entry: Substitute, *, where: Position, find: Callable[[str], type[State]]
) -> Leaf:
    if not isinstance(work, Leaf):
        hint = "give an `outcome` or a `script`"
        raise DocumentError(f"`{path}` is a {work.kind}, for which no state can stand in", where=where, hint=hint)
    try:
        state = find(entry.state or "")
        given = work.parameters if entry.parameters is None else compile_template(entry.parameters)
    except (RegistryError, ExpressionError) as error:
        raise DocumentError(error.message, where=where, hint=error.hint) from error
    others = [outcome for outcome in state.outcomes if outcome not in work.outcomes]
    if others:
        message = f"`{entry.state}` has an outcome `{others[0]}` that leads nowhere here"
        raise DocumentError(message, where=where, hint=f"`{path}` has {', '.join(work.outcomes)}")
    signature = read_signature(state)
    return replace(work, state=state, signature=signature, parameters=given, position=str(where), kind=SUBSTITUTE)
