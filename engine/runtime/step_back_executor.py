"""Executes a step back: undoes activations one by one and restores the userdata."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

from engine.cause_chain import cause_of, describe_cause
from engine.errors import Cause, ControlError, FlexcellError, JournalError
from engine.event import Event, FormerValue, RunSteppedBack, UndoEnded, UndoStarted
from engine.journal import RunJournal
from engine.preemption import being_cancelled
from engine.runtime.control import Control
from engine.runtime.history.step_back import PausedPosition, StepBack, plan_step_back, undoable
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.plan import Plan
from engine.runtime.record.leaf_activation import LeafActivation
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.userdata.userdata import Scope


async def request_step_back(
    path: str, *, plan: Callable[[], Plan], execution: Execution, control: Control, journal: RunJournal
) -> tuple[str, ...]:
    """Plan a step back of a paused run and let the branch execute it; see `engine.runtime.run.Run.step_back`.

    Args:
        path: The branch; by default the one in which something started last.
        plan: Returns the current plan of the run.
        execution: The execution of the run.
        control: The control of the run.
        journal: The events of the run.
    """
    control.require_still()
    position, behavior, later = _paused_position(execution), plan(), list[Event]()
    watcher = later.append
    execution.recorder.watch(watcher)
    try:
        decide = partial(plan_step_back, behavior, await journal.events(), position, path=path)
        step = decide() if execution.clock.virtual else await asyncio.to_thread(decide)
    finally:
        execution.recorder.unwatch(watcher)
    control.require_still()
    if _paused_position(execution) != position or plan() is not behavior:
        raise ControlError("the run has continued meanwhile", where=step.cursor, hint="request the step back again")
    step.undo_log.read(later)
    undone = tuple(each.path for each in step.undone)
    stepping_back = StepBackExecutor(step=step, execution=execution)
    control.step_back(step.cursor, step.node, step.target, stepping_back.carry_out)
    return undone


def _paused_position(execution: Execution) -> PausedPosition:
    return PausedPosition(waiting=dict(execution.gate.waiting), active=dict(execution.activity.nodes))


@dataclass(frozen=True, kw_only=True)
class StepBackExecutor:
    """One step back of one run, executed in its branch once the node there is preempted."""

    step: StepBack
    execution: Execution

    def __post_init__(self) -> None:
        # The clean-up of the preempted node is undone as well.
        self.execution.recorder.watch(self._take_event)

    @cached_property
    def _take_event(self) -> Callable[[Event], None]:
        return self.step.undo_log.take

    async def carry_out(self, scope: Scope) -> NodeExit | None:
        """Return the exit of the node to the one before it; None where it waits before its own entry.

        Where an undo fails, the run keeps its position, and the log states the reason.
        """
        gate = self.execution.gate
        try:
            await self._undo()
        except (JournalError, asyncio.CancelledError):
            raise
        except FlexcellError as error:
            if being_cancelled(self.execution.loop):
                # The clean-up failed during a stop; the stop still waits for it.
                raise asyncio.CancelledError from error
            self._failed(cause_of(error))
            return None
        finally:
            self.execution.recorder.unwatch(self._take_event)
            gate.end_undo()
        return self._restore(scope)

    async def _undo(self) -> None:
        for activation in self.step.undone:
            leaf = undoable(self.step.plan, activation)
            if leaf is None:
                continue
            if (why := leaf.cannot_undo(activation)) != "":
                raise ControlError(f"visit {activation.visit} cannot be undone: {why}", where=activation.path)
            await self._undo_one(leaf, activation)

    async def _undo_one(self, leaf: Leaf, activation: LeafActivation) -> None:
        execution, path = self.execution, activation.path
        visit = execution.visits[path] = execution.visits.get(path, 0) + 1
        execution.recorder.emit(UndoStarted, path=path, visit=visit, undoes=activation.visit)
        execution.activity.nodes[path] = visit
        preempted, cause = True, None
        try:
            await leaf.undo(activation, visit, execution)
            preempted = being_cancelled(execution.loop)
        except FlexcellError as error:
            preempted, cause = being_cancelled(execution.loop), cause_of(error)
            raise
        finally:
            execution.activity.nodes.pop(path, None)
            execution.recorder.emit(
                UndoEnded, path=path, visit=visit, undoes=activation.visit, preempted=preempted, cause=cause
            )
        if preempted:
            raise asyncio.CancelledError

    def _failed(self, cause: Cause) -> None:
        step, recorder = self.step, self.execution.recorder
        recorder.log(step.target, f"the step back failed: {describe_cause(cause)}", level="error")
        recorder.emit(RunSteppedBack, path=step.node, source=step.node, cause=cause)

    def _restore(self, scope: Scope) -> NodeExit | None:
        step, recorder = self.step, self.execution.recorder
        values = tuple(self._former_values())
        for each in values:
            scope.restore(each.scope, each.key, each.value, defined=each.defined)
        recorder.emit(
            RunSteppedBack,
            path=step.target,
            source=step.node,
            values=values,
            went_wrong=step.went_wrong,
            reason=step.reason,
        )
        self.execution.progress_count += 1
        if step.target == step.node:
            return None
        name = step.target.rpartition("/")[2]
        return NodeExit("", name, step.went_wrong, step.reason, back=True)

    def _former_values(self) -> list[FormerValue]:
        step = self.step
        values: list[FormerValue] = []
        for scope, key, writer in step.undo_log.written_by((step.target, step.node), step.since):
            if writer:
                message = f"{key} keeps the value that {writer} has written since"
                self.execution.recorder.log(step.target, message, level="warning")
                continue
            former = step.former.get(scope, {})
            values.append(FormerValue(scope=scope, key=key, value=former.get(key), defined=key in former))
        return values
