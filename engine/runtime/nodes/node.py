"""A node of a plan: enters its work, applies timeout, retry and on_error, exits.

The same class wraps states and containers; only the `NodeWork` differs.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple, Protocol

from engine.cause_chain import cause_of, describe_cause, wrap_cause
from engine.document.duration import LONGEST_S
from engine.document.expression.expression_cost import MAX_STEPS
from engine.errors import Cause, ExpressionError, FlexcellError, JournalError, NotStopped, StateError
from engine.event import NodeRetried, NodeSkipped
from engine.preemption import being_cancelled, preempt, raise_failure, take_order_preemption
from engine.runtime.control.gate import OperatorOrder
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node_entry import EMPTY_ENTRY, NodeEntry
from engine.runtime.nodes.node_events import record_diverted, record_entry, record_exit
from engine.runtime.nodes.node_policies import GuardPolicy, RetryPolicy, TimeoutPolicy
from engine.runtime.nodes.overdue_nodes import overdue_policy
from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.runtime.record.node_exit import NodeExit, exit_from_outcome, guard_closed_cause
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome

_FAIRNESS = 256
"""Consecutive retries without a wait after which other tasks have a turn."""
_MOST_DOUBLED = 60


class NodeAttempt(NamedTuple):
    """An entered attempt: the visit of its node, and its work."""

    visit: int
    work: Awaitable[Outcome]


class NodeWork(Protocol):
    """Work of a node between entry and exit."""

    @property
    def kind(self) -> str:
        """The key of the node in documents."""
        ...

    @property
    def children(self) -> Mapping[str, Node]:
        """The nodes directly inside, by name, in document order."""
        ...

    @cached_property
    def nominal(self) -> frozenset[str]:
        """The outcomes that mean success; read at every transition."""
        ...

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """All possible outcomes."""
        ...

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return the initial values of its own scope when it is entered with `inputs`."""
        ...

    @property
    def constant(self) -> NodeEntry | None:
        """The entry, where it does not depend on userdata; else None."""
        ...

    def enter(self, scope: Scope) -> NodeEntry:
        """Evaluate the entry; raises FlexcellError where that fails."""
        ...

    async def run(self, entry: NodeEntry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Execute the work."""
        ...


@dataclass(frozen=True, kw_only=True)
class Node:
    """One node with its connections inside the enclosing container."""

    path: str
    name: str
    work: NodeWork
    transitions: Mapping[str, str] = field(default_factory=dict[str, str])
    timeout: TimeoutPolicy | None = None
    retry: RetryPolicy | None = None
    on_error: str | None = None
    guard: GuardPolicy | None = None
    autonomy: Mapping[str, str] = field(default_factory=dict[str, str])
    resume: str | None = None
    position: str = ""
    disabled: str | None = None
    """The outcome by which it is passed over, without entry, gate and policies; None if it is not disabled."""

    @cached_property
    def targets(self) -> tuple[str, ...]:
        """Its possible targets inside a machine."""
        own = [*self.transitions.values()]
        own += [self.guard.target] if self.guard is not None else []
        own += [self.timeout.target] if self.timeout is not None else []
        own += [self.on_error] if self.on_error is not None else []
        return tuple(dict.fromkeys(own))

    @cached_property
    def has_choice(self) -> bool:
        """Whether its nominal outcomes lead to different targets inside a machine."""
        return len({self.transitions[each] for each in self.work.nominal if each in self.transitions}) > 1

    @cached_property
    def expected(self) -> frozenset[str]:
        """The outcomes that explain nothing: nominal ones, where the node has no choice."""
        return frozenset() if self.has_choice else self.work.nominal

    @cached_property
    def _plain(self) -> bool:
        return self.timeout is None and self.retry is None and self.on_error is None and self.guard is None

    @cached_property
    def _constant(self) -> NodeEntry | None:
        return self.work.constant

    @cached_property
    def _is_plain_state(self) -> bool:
        return self._plain and not self.work.children and self.disabled is None

    @cached_property
    def _plain_exits(self) -> Mapping[str, NodeExit]:
        """The exit of a plain state for each of its outcomes without a cause."""
        return {outcome: NodeExit(outcome) for outcome in self.work.outcomes}

    async def perform(self, scope: Scope, execution: Execution) -> NodeExit:
        """Run the node to its exit, passing the gate before and after it.

        Raises:
            FlexcellError: the work raised, retries are used up and `on_error` is not set.
            CancelledError: the node was preempted; its clean-up is complete.
        """
        if not self._is_plain_state or execution.needs_slow_path:
            return await self._perform(scope, execution, None)
        # Fast path: nearly all activations are plain states without an operator, resume or error.
        path, work = self.path, self.work
        entry, refused = self._constant, None
        if entry is None:
            entry, refused = self._entered(scope, execution)
        visit = record_entry(execution, path, work.kind, entry.shown)
        try:
            if refused is not None:
                raise refused
            outcome = await work.run(entry, path, visit, scope, execution)
        except BaseException as error:
            ended = _raised(error)
        else:
            if not (execution.gate.armed or being_cancelled(execution.loop)):
                cause = outcome.cause
                record_exit(execution, path, visit, outcome.name, cause=cause)
                return self._plain_exits[outcome.name] if cause is None else exit_from_outcome(outcome)
            ended = _ended(outcome)
        return await self._perform(scope, execution, NodeAttempt(visit, ended))

    async def _perform(self, scope: Scope, execution: Execution, begun: NodeAttempt | None) -> NodeExit:
        """Perform any node under all conditions; its first attempt may have ended already."""
        if self.disabled is not None:
            return self._skip(self.disabled, execution)
        gate = execution.gate
        point = execution.point(self.path) if execution.points else None
        order: OperatorOrder | None = None
        while True:
            left = None
            back = order.back if order is not None else None
            order = None
            try:
                if back is not None and (returned := await back(scope)) is not None:
                    return returned
                if begun is not None:
                    first, begun = begun, None
                    left = await self._attempted(first, execution)
                elif point is not None and not point.active:
                    left = await self._resume_exited(point, scope, execution)
                elif gate.armed and point is None:
                    order = await gate.before(self.path, execution.visits.get(self.path, 0) + 1, scope)
                if order is None and left is None:
                    node = execution.latest(self.path, self)
                    if node.disabled is not None:
                        return node._skip(node.disabled, execution)
                    if node._plain:
                        left = await node._attempt(scope, execution, point)
                    else:
                        left = await node._guarded(scope, execution, point)
            except asyncio.CancelledError:
                order = self._take_order(execution)
                if order is None:
                    raise
            except FlexcellError:
                self._take_order(execution)
                raise
            passed, point = point is not None and point.passed, None
            if left is not None and gate.armed and not passed:
                order = await self._after(left, scope, execution)
            if order is None and left is not None:
                return left
            if order is not None and order.outcome is not None:
                return self._forced(order.outcome, execution)

    def _skip(self, outcome: str, execution: Execution) -> NodeExit:
        execution.points.pop(self.path, None)
        execution.recorder.emit(NodeSkipped, path=self.path, outcome=outcome)
        return NodeExit(outcome)

    async def _resume_exited(self, point: NodeCheckpoint, scope: Scope, execution: Execution) -> NodeExit:
        """Apply retry and on_error to a recorded exit, which the crash prevented."""
        if not execution.is_resumed:
            record_diverted(execution, self.path, "start", point.left or point.diverted or "", point.cause)
        elif point.diverted is None and not point.passed and not self._plain:
            return await self._guarded(scope, execution, point)
        return self._recorded_exit(point)

    def _recorded_exit(self, point: NodeCheckpoint) -> NodeExit:
        if point.failed:
            # It had ended with this error, which was not handled when the engine died.
            raise StateError(point.cause.message if point.cause is not None else "failed", where=self.path)
        return NodeExit(point.left or "", point.diverted, point.cause, point.reason)

    async def _after(self, left: NodeExit, scope: Scope, execution: Execution) -> OperatorOrder | None:
        visit = execution.visits.get(self.path, 0)
        required = execution.latest(self.path, self).autonomy.get(left.outcome, "off")
        return await execution.gate.after(self.path, visit, left.outcome, required, scope)

    def _take_order(self, execution: Execution) -> OperatorOrder | None:
        """Return the operator's order if it is the only reason for the preemption of this node."""
        gate = execution.gate
        if not gate.has_order(self.path):
            return None
        order = gate.taken_order(self.path)
        # An order of a node around this one preempts both with one clean-up.
        if not gate.has_order_around(self.path) and take_order_preemption():
            return order
        if order is not None and order.back is not None:
            gate.end_undo()
        return None

    def _forced(self, outcome: str, execution: Execution) -> NodeExit:
        record_diverted(execution, self.path, "operator", outcome, None)
        return NodeExit(outcome, None, Cause(message="forced by the operator", where=self.path, kind="Forced"))

    async def _guarded(self, scope: Scope, execution: Execution, point: NodeCheckpoint | None) -> NodeExit:
        try:
            if self.guard is not None and point is None and not self.is_open(self.guard, scope, execution):
                record_diverted(execution, self.path, "guard", self.guard.target, None)
                return NodeExit("", self.guard.target, reason=guard_closed_cause(self.path))
            if self.timeout is None:
                return await self._retried(scope, execution, point)
            return await self._timed(self.timeout, scope, execution, point)
        except (JournalError, NotStopped):
            raise
        except FlexcellError as error:
            # A stop overrides on_error, also when the clean-up fails.
            if self.on_error is None or being_cancelled(execution.loop):
                raise
            cause = cause_of(error)
            record_diverted(execution, self.path, "on_error", self.on_error, cause)
            return NodeExit("", self.on_error, cause)

    def is_open(self, guard: GuardPolicy, scope: Scope, execution: Execution) -> bool:
        """Evaluate a guard of this node; raises FlexcellError where the value is not a boolean."""
        where = self.position or self.path
        with execution.counted():
            value = guard.when.evaluate({name: scope.read(name, reader=where) for name in guard.when.names})
        if not isinstance(value, bool):
            message = f"the guard evaluates to {value!r}, which is not a boolean"
            raise ExpressionError(message, where=where, hint="use a comparison")
        return value

    async def _timed(
        self, timeout: TimeoutPolicy, scope: Scope, execution: Execution, point: NodeCheckpoint | None
    ) -> NodeExit:
        # A separate task: a stop and a timeout may coincide, and neither may interrupt the clean-up.
        elapsed_s = point.elapsed_s if point is not None else 0.0
        timer = execution.branch_holds.timer(self.path, max(0.0, timeout.after_s - elapsed_s))
        body = execution.activity.branch(self.path, self._retried(scope, execution, point), body=True)
        try:
            await asyncio.wait({body, timer.future}, return_when=asyncio.FIRST_COMPLETED)
            if not body.done():
                # A node that ends at this instant is in time; everything inside decides first.
                await execution.settlement.settled(self.path, around=True)
        except asyncio.CancelledError:
            await self._preempt(body, execution)
            raise
        finally:
            execution.branch_holds.drop(timer)
        if body.done():
            return body.result()
        await self._preempt(body, execution)
        cause = Cause(message=f"no outcome within {timeout.after_s:g} s", where=self.path, kind="Timeout")
        record_diverted(execution, self.path, "timeout", timeout.target, cause)
        return NodeExit("", timeout.target, cause)

    async def _preempt(self, body: asyncio.Task[NodeExit], execution: Execution) -> None:
        """Preempt the body of a node with timeout; raises its clean-up error, and CancelledError if cancelled."""
        try:
            await preempt((body,), overdue_policy(execution, self.path))
        finally:
            if body.done():
                raise_failure((body,))

    async def _retried(self, scope: Scope, execution: Execution, point: NodeCheckpoint | None) -> NodeExit:
        retry = self.retry
        attempt = point.attempt if point is not None else 1
        while True:
            failure: Cause | None
            try:
                if point is not None and not point.active:
                    left = self._recorded_exit(point)
                else:
                    left = await self._attempt(scope, execution, point)
                if retry is None or left.outcome not in retry.outcomes or attempt > retry.times:
                    return left
                failure = wrap_cause(f"outcome {left.outcome}", left.cause, where=self.path)
            except (JournalError, NotStopped):
                raise
            except FlexcellError as error:
                if retry is None or not retry.errors or attempt > retry.times or being_cancelled(execution.loop):
                    raise
                failure = cause_of(error)
            point = None
            attempt += 1
            wait_s = min(retry.backoff_s * 2.0 ** min(attempt - 2, _MOST_DOUBLED), LONGEST_S)
            execution.recorder.emit(NodeRetried, path=self.path, attempt=attempt, wait_s=wait_s, cause=failure)
            if wait_s > 0:
                await execution.sleep(self.path, wait_s)
            elif attempt % _FAIRNESS == 0:
                await asyncio.sleep(0)

    async def _attempt(self, scope: Scope, execution: Execution, point: NodeCheckpoint | None) -> NodeExit:
        path = self.path
        if point is not None and not (point.entered and self.work.children):
            point = None
        if execution.steps > MAX_STEPS:
            await execution.yield_turn()
        entry, refused = (
            self._entered(scope, execution) if point is None else (NodeEntry(None, point.inputs, {}, point), None)
        )
        if point is None:
            visit = record_entry(execution, path, self.work.kind, entry.shown)
        elif execution.is_resumed:
            visit = point.visit
            execution.activity.nodes[path] = visit
        else:
            visit = record_entry(execution, path, self.work.kind, dict(point.inputs))
            for key, value in point.values.items():
                execution.record_write(path, path, key, value)
        work = self.work.run(entry, path, visit, scope, execution) if refused is None else _raised(refused)
        return await self._attempted(NodeAttempt(visit, work), execution)

    async def _attempted(self, begun: NodeAttempt, execution: Execution) -> NodeExit:
        path, visit = self.path, begun.visit
        try:
            outcome = await begun.work
        except asyncio.CancelledError as cancellation:
            if being_cancelled(execution.loop):
                record_exit(execution, self.path, visit, "", preempted=True)
                raise
            error = StateError("a CancelledError was raised without a stop request", where=self.position or path)
            record_exit(execution, self.path, visit, "", cause=cause_of(error))
            raise error from cancellation
        except Exception as raised:
            error = self._flexcell_error(raised)
            error.nodes = (*error.nodes, f"{path} at {self.position}" if self.position else path)
            record_exit(
                execution, self.path, visit, "", preempted=being_cancelled(execution.loop), cause=cause_of(error)
            )
            if being_cancelled(execution.loop) and self.work.kind == "state":
                execution.recorder.log(path, f"clean-up failed: {describe_cause(cause_of(error))}", level="error")
            raise error from error.__cause__
        if being_cancelled(execution.loop):
            # It ignored the preemption, or ended at the same time; its successor must not start.
            record_exit(execution, self.path, visit, outcome.name, preempted=True, cause=outcome.cause)
            raise asyncio.CancelledError
        record_exit(execution, self.path, visit, outcome.name, cause=outcome.cause)
        return exit_from_outcome(outcome)

    def _entered(self, scope: Scope, execution: Execution) -> tuple[NodeEntry, FlexcellError | None]:
        """Evaluate the entry; an error counts as a failure of the entered node."""
        try:
            with execution.counted():
                return self.work.enter(scope), None
        except Exception as error:
            return EMPTY_ENTRY, self._flexcell_error(error)

    def _flexcell_error(self, error: Exception) -> FlexcellError:
        """Return an error that retries and `on_error` handle; other exceptions are wrapped with type and position."""
        if isinstance(error, FlexcellError):
            return error
        wrapped = StateError(f"{type(error).__name__}: {error}", where=self.position or self.path)
        wrapped.__cause__ = error
        return wrapped


async def _ended(outcome: Outcome) -> Outcome:
    return outcome


async def _raised(error: BaseException) -> Outcome:
    raise error
