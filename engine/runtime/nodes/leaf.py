"""Work of a state node: evaluates parameters, reads inputs, leases, runs, checks, writes outputs."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import msgspec

from engine.bus import Holder
from engine.cause_chain import storable_cause
from engine.document.expression.expression import Template
from engine.document.signature import StateSignature
from engine.errors import FlexcellError, StateError, UserdataError
from engine.runtime.nodes.context import ActivationContext
from engine.runtime.nodes.error_containment import contain_errors
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import Node
from engine.runtime.nodes.node_entry import NodeEntry
from engine.runtime.record.leaf_activation import LeafActivation
from engine.runtime.record.nonfinite import encode_nonfinite
from engine.runtime.userdata.userdata import Scope
from engine.state import ActivationRecord, Context, Outcome, State
from engine.wording.misfit import explain_misfit
from engine.wording.suggestions import did_you_mean


@dataclass(frozen=True, kw_only=True)
class Leaf:
    """One state of a behavior: its class, its parameters as a template, and its key mapping."""

    state: type[State]
    signature: StateSignature
    parameters: Template
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]
    position: str
    autonomy: Mapping[str, str] = field(default_factory=dict[str, str])
    kind: str = "state"
    """The key of this node in documents, or `substitute`."""

    @property
    def children(self) -> Mapping[str, Node]:
        """Empty: a state has no children."""
        return {}

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """The outcomes that its class declares."""
        return self.state.outcomes

    @cached_property
    def nominal(self) -> frozenset[str]:
        """The success outcomes of its class; all outcomes where it declares none."""
        return frozenset(self.state.success or self.state.outcomes)

    @property
    def constant(self) -> NodeEntry | None:
        """Its entry, where neither parameters nor inputs depend on userdata; else None."""
        return self._constant

    @cached_property
    def _constant(self) -> NodeEntry | None:
        if self.parameters.names or self.signature.inputs:
            return None
        try:
            given = self.parameters.evaluate({})
            return NodeEntry(self._instance(given), {}, _plain(given))
        except Exception:
            # `enter` raises it again, where it is recorded and handled.
            return None

    @cached_property
    def commands_hardware(self) -> bool:
        """Whether its class leases resources while it runs."""
        return self.signature.commands_hardware

    @cached_property
    def reads(self) -> frozenset[str]:
        """The userdata keys of its container that its parameters and inputs read."""
        return frozenset(self.parameters.names).union(self.inputs.get(key, key) for key in self.signature.inputs)

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return nothing: it has no scope of its own."""
        return {}

    def enter(self, scope: Scope) -> NodeEntry:
        """Evaluate the parameters and read the inputs."""
        if self._constant is not None:
            return self._constant
        variables = {name: scope.read(name, reader=self.position) for name in self.parameters.names}
        given = self.parameters.evaluate(variables)
        inputs: dict[str, object] = dict(self._inputs(scope))
        return NodeEntry(self._instance(given), inputs, _plain({**_mapping(given), **inputs}))

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Run the state once and write its outputs."""
        state = entry.state
        if state is None:
            raise StateError("entered without a state", where=path)
        resources = self._resources(state) if self.commands_hardware else ()
        if resources:
            execution.bus.leases.acquire(resources, Holder(execution.run, path))
        context = ActivationContext(execution, path, visit, self.autonomy)
        pausing = PausableState(state, context) if self._pauses else None
        if pausing is not None:
            execution.branch_holds.attach(pausing)
        try:
            outcome: Any = await (state.run(context, **entry.inputs) if entry.inputs else state.run(context))
        except (FlexcellError, asyncio.CancelledError, GeneratorExit):
            raise
        except BaseException as error:
            # A custom state may raise any exception, SystemExit too; the StateError names the state and its position.
            raise StateError(
                f"{self.signature.name} raised {type(error).__name__}: {error}", where=self.position
            ) from error
        finally:
            if pausing is not None:
                await execution.branch_holds.detach(pausing)
            if resources:
                execution.bus.leases.release(resources, Holder(execution.run, path))
        if not isinstance(outcome, Outcome) or outcome.name not in self.state.outcomes:
            raise self._undeclared_outcome(outcome)
        if outcome.outputs:
            self._write(outcome, path, scope, execution)
        return (
            outcome if outcome.cause is None else Outcome(outcome.name, outcome.outputs, storable_cause(outcome.cause))
        )

    def cannot_undo(self, done: LeafActivation) -> str:
        """Return why an activation cannot be undone; empty where no obstacle is known in advance."""
        state = self._past_state(done)
        with contain_errors(f"{self.signature.name}.cannot_undo", where=self.position):
            return state.cannot_undo(self._record(done))

    async def undo(self, done: LeafActivation, visit: int, execution: Execution) -> None:
        """Undo an activation with the `undo` of its class; raises where that fails."""
        state = self._past_state(done)
        holder = Holder(execution.run, done.path)
        resources = self._resources(state) if self.commands_hardware else ()
        if resources:
            execution.bus.leases.acquire(resources, holder)
        try:
            with contain_errors(f"{self.signature.name}.undo", where=self.position):
                await state.undo(ActivationContext(execution, done.path, visit, {}), self._record(done))
        finally:
            if resources:
                execution.bus.leases.release(resources, holder)

    def _past_state(self, done: LeafActivation) -> State:
        inputs = self.signature.inputs
        return self._instance({key: value for key, value in done.shown.items() if key not in inputs})

    def _record(self, done: LeafActivation) -> ActivationRecord:
        return done.record(inputs=self.signature.inputs, outputs=self.outputs)

    def _resources(self, state: State) -> tuple[str, ...]:
        with contain_errors(f"{self.signature.name}.resources", where=self.position):
            return state.resources()

    @cached_property
    def _pauses(self) -> bool:
        return self.state.on_pause is not State.on_pause or self.state.on_resume is not State.on_resume

    def _instance(self, given: object) -> State:
        with contain_errors(f"constructing {self.signature.name}", where=self.position):
            try:
                return msgspec.convert(given, self.state)
            except msgspec.ValidationError as error:
                what = explain_misfit(error, self.state)
                raise StateError(
                    f"the parameters of {self.signature.name} do not fit: {what}", where=self.position
                ) from error

    def _inputs(self, scope: Scope) -> Iterator[tuple[str, object]]:
        for key, declared in self.signature.inputs.items():
            source = self.inputs.get(key, key)
            if declared.required or scope.has(source):
                value = scope.read(source, reader=self.position)
                try:
                    yield key, msgspec.convert(value, declared.type)
                except msgspec.ValidationError as error:
                    what = explain_misfit(error, declared.type)
                    raise UserdataError(
                        f"userdata key {source!r} does not fit input {key!r} of {self.signature.name}: {what}",
                        where=self.position,
                    ) from error

    def _write(self, outcome: Outcome, path: str, scope: Scope, execution: Execution) -> None:
        for key, value in outcome.outputs.items():
            if key not in self.signature.outputs:
                raise UserdataError(
                    f"{self.signature.name} wrote {key!r}, which it does not declare",
                    where=self.position,
                    hint=f"declare it in `outputs`; {did_you_mean(key, self.signature.outputs)}",
                )
            target = self.outputs.get(key, key)
            execution.write(path, scope, target, value)

    def _undeclared_outcome(self, outcome: object) -> StateError:
        result = f"outcome {outcome.name!r}" if isinstance(outcome, Outcome) else f"a {type(outcome).__name__}"
        return StateError(
            f"{self.signature.name} ended with {result}, which it does not declare",
            where=self.position,
            hint=f"its outcomes are {', '.join(self.state.outcomes)}",
        )


class PausableState:
    """A running state with its own hooks for pause and resume of its branch."""

    def __init__(self, state: State, context: ActivationContext) -> None:
        self._state = state
        self._context = context
        self.path = context.path
        self.label = context.path

    async def hold(self) -> None:
        """Call its `on_pause`."""
        await self._call_hook(self._state.on_pause)

    async def resume(self) -> None:
        """Call its `on_resume`."""
        await self._call_hook(self._state.on_resume)

    async def _call_hook(self, hook: Callable[[Context], Awaitable[None]]) -> None:
        # The pause of other branches continues, whatever this hook raises.
        with contain_errors(hook.__qualname__, where=self.path):
            await hook(self._context)


def _mapping(given: object) -> dict[str, object]:
    return msgspec.convert(given, dict[str, object])


def _plain(value: object) -> dict[str, object]:
    return encode_nonfinite(msgspec.to_builtins(value))
