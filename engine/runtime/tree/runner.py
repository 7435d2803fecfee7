"""Ticks one activation of a tree on demand, and executes the decisions of each tick."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.cause_chain import cause_of, describe_cause
from engine.document.expression.expression_cost import MAX_STEPS
from engine.document.expression.step_meter import METER
from engine.errors import FlexcellError, StateError
from engine.event import Event, UserdataAppended, UserdataWritten
from engine.node_path import is_inside
from engine.preemption import raise_failure
from engine.runtime.nodes.execution import Execution
from engine.runtime.tree.active_leaves import ActiveLeaves, TreeLeafActivation
from engine.runtime.tree.blackboard import IsolatedBlackboard
from engine.runtime.tree.explanation import explain_tree_failure
from engine.runtime.tree.foreign_behaviour import ForeignBehaviour
from engine.runtime.tree.reactive_checks import ReactiveChecks
from engine.runtime.tree.restore import BranchValues, restore_tree
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.ticker import Ticker
from engine.runtime.tree.timers import TreeTimers
from engine.runtime.tree.tree_builder import TreeBuilder
from engine.runtime.tree.tree_history import TreeEvent, fold_tree_events
from engine.runtime.tree.tree_leaf import TreeLeaf
from engine.runtime.tree.tree_livelock import TreeLivelockDetector
from engine.runtime.tree.tree_node import TreeNode
from engine.runtime.userdata.userdata import Scope
from engine.state import Outcome

_FINAL = (Status.SUCCESS, Status.FAILURE)
_REMEMBERED = 32
"""Number of recent names kept to describe an endless loop."""


class TreeRunner:
    """One activation of a tree; used on the loop thread, run once.

    Args:
        root: The planned tree.
        path: The path of the tree.
        scope: The scope of the tree.
        execution: The execution of the run.
        history: The events of an interrupted activation that is resumed.
        branches: Values written by branches of its parallels, by the path of the branch.
    """

    def __init__(
        self,
        root: TreeNode,
        *,
        path: str,
        scope: Scope,
        execution: Execution,
        history: Sequence[TreeEvent] = (),
        branches: BranchValues | None = None,
    ) -> None:
        self._path = path
        self._execution = execution
        self._changed = asyncio.Event()
        self._recent: deque[str] = deque(maxlen=_REMEMBERED)
        self._leaves = ActiveLeaves(execution, path, self._changed.set)
        self._tree_timers = TreeTimers(execution, self._changed.set)
        self._builder = TreeBuilder(
            execution=execution, leaves=self._leaves, tree_timers=self._tree_timers, clear=self._clear
        )
        self._ticker = Ticker(execution, self._leaves, self._builder.turn, self._builder.statuses)
        self._polling = TreeLivelockDetector(
            path, execution, lambda: (*self._tree_timers.timers, *self._reactive.timers)
        )
        self._reactive = ReactiveChecks(
            path, execution, builder=self._builder, polling=self._polling, wake=self._changed.set
        )
        self._blackboard: AbstractContextManager[None] = IsolatedBlackboard() if root.holds_foreign else nullcontext()
        self._watched = frozenset[str]()
        self._written: set[str] = set()
        self._planned = root
        self._place = ScopeAccess(scope)
        self._history = history
        self._branches: BranchValues = branches or {}

    async def run(self) -> Outcome:
        """Tick until the root has ended; all leaves have ended then.

        Raises:
            FlexcellError: a leaf, a foreign behaviour or a clean-up failed and nothing in the tree handles the error.
            CancelledError: the tree was preempted; all clean-up is complete.
        """
        recorder, watcher = self._execution.recorder, self._on_event
        ready: list[ForeignBehaviour] = []
        try:
            root = self._build(ready)
            if self._builder.reactive or self._watched:
                # Without watchers and journal events are not even created.
                recorder.watch(watcher)
            return await self._run(root)
        except asyncio.CancelledError:
            raise_failure(await self._leaves.stop())
            raise
        finally:
            recorder.unwatch(watcher)
            self._tree_timers.close()
            self._reactive.close()
            try:
                await self._leaves.stop()
            finally:
                self._shut_down(ready)
                self._builder.dismantle()

    def _build(self, ready: list[ForeignBehaviour]) -> Behaviour:
        with self._blackboard:
            root = self._builder.build(self._planned, self._place)
            self._watched = frozenset(key for guard in self._builder.guards for key in guard.keys)
            for foreign in self._builder.foreign.values():
                foreign.set_up()
                ready.append(foreign)
        return root

    async def _run(self, root: Behaviour) -> Outcome:
        idle_ticks, wait = 0, self._last_wait()
        try:
            if self._history:
                await self._resume(root)
            while root.status not in _FINAL:
                await self._tick(root)
                if root.status is Status.INVALID:
                    raise StateError("the root of the tree has no status", where=self._path)
                if root.status is Status.RUNNING:
                    await self._wait()
                last, wait = wait, self._last_wait()
                idle_ticks = idle_ticks + 1 if wait == last else 0
                if idle_ticks >= self._execution.instant_limit:
                    raise self._endless(idle_ticks)
            return self._outcome(root)
        except BaseException:
            # The exception propagates; no node of the tree may remain RUNNING.
            self._builder.statuses.closing = True
            self._clear(root)
            raise

    async def _resume(self, root: Behaviour) -> None:
        """Restore the tree to the end of its history, and return when a tick is due."""
        tick_due = restore_tree(root, self._builder, fold_tree_events(self._history), self._branches)
        await self._leaves.go_on()
        self._tree_timers.begin()
        self._reactive.follow(root)
        if root.status is Status.RUNNING and not tick_due:
            await self._wait()

    def _last_wait(self) -> float:
        """Return a value that changes only with waits: virtual time, else the number of the last wait."""
        clock = self._execution.clock
        return clock.now_s() if clock.virtual else self._execution.waits.last(self._path)

    async def _tick(self, root: Behaviour) -> None:
        seen = self._leaves.unread
        self._raise_error(seen)
        self._count_polling()
        self._tree_timers.follow()
        self._changed.clear()
        for guard in self._builder.guards:
            guard.last_value = None
        await self._ticker.tick(self._steps(root))
        for passed in self._leaves.forget(seen):
            self._builder.statuses.pass_over(passed.path)
        await self._leaves.begin()
        self._tree_timers.begin()
        self._recent += (*self._leaves.begun, *self._tree_timers.again)
        self._leaves.begun.clear()
        self._reactive.forget_answers()
        self._reactive.follow(root)

    def _count_polling(self) -> None:
        """Count a tick that only a timer of the tree made due; not with foreign behaviours, whose state is unknown."""
        if self._tree_timers.rang and not (self._leaves.unread or self._reactive.tick_due or self._builder.foreign):
            self._polling.count(lambda: ", ".join(dict.fromkeys(map(self._short, self._recent))) or "its parts")
        else:
            self._polling.forget()

    def _short(self, path: str) -> str:
        return path.removeprefix(f"{self._path}/")

    def _steps(self, root: Behaviour) -> Iterator[Behaviour]:
        steps = root.tick()
        # Only guards and foreign behaviours evaluate expressions or run user code.
        return self._contained_steps(steps) if self._builder.guards or self._builder.foreign else steps

    def _contained_steps(self, steps: Iterator[Behaviour]) -> Iterator[Behaviour]:
        while True:
            with self._execution.counted(), self._blackboard:
                step = next(steps, None)
            if step is None:
                return
            yield step

    def _raise_error(self, ended: frozenset[TreeLeafActivation]) -> None:
        """Raise the first error, in document order, that no decorator handles: it ends the tree at once."""
        for each in sorted(ended, key=lambda each: each.rank):
            if each.error is not None and not each.caught:
                raise each.error

    async def _wait(self) -> None:
        """Return when a tick is due, this instant has settled, and the branch is not held."""
        while not (self._is_due() or self._guard_has_changed()):
            self._changed.clear()
            if self._reactive.stale:
                await self._reactive.ask(until=self._is_due, changed=self._changed)
            else:
                await self._changed.wait()
        await self._execution.settlement.settled(self._path)
        branch_holds = self._execution.branch_holds
        while branch_holds.active and branch_holds.held(self._path):
            await branch_holds.until_free(self._path)
            self._reactive.forget_answers()
            await self._execution.settlement.settled(self._path)

    def _is_due(self) -> bool:
        return self._tree_timers.due or bool(self._leaves.unread) or self._reactive.tick_due

    def _guard_has_changed(self) -> bool:
        """Return whether the value of a guard that was evaluated in the last tick has changed."""
        written, self._written = self._written, set()
        evaluated = [each for each in self._builder.guards if each.last_value is not None and each.keys & written]
        try:
            with METER.limited(MAX_STEPS, "the guards of this tree"):
                return any(each.holds() is not each.last_value for each in evaluated)
        except FlexcellError:
            return True  # the tick raises the error where a decorator may handle it

    def _on_event(self, event: Event) -> None:
        self._reactive.hear(event)
        if isinstance(event, UserdataWritten | UserdataAppended) and event.key in self._watched:
            self._written.add(event.key)
            self._changed.set()
            if not is_inside(self._path, event.path):
                self._execution.waits.add(self._path)

    def _outcome(self, root: Behaviour) -> Outcome:
        if root.status is Status.SUCCESS:
            return Outcome("success")
        return Outcome("failure", cause=explain_tree_failure(root, self._builder.parts, self._builder.entry_guards))

    def _clear(self, torn: Behaviour) -> None:
        """Halt a node and everything below it, also nodes that py_trees misses after an exception in a tick."""
        with self._blackboard:
            nodes = tuple(torn.iterate())
            for node in nodes:
                if node in self._builder.foreign:
                    self._contain(self._builder.foreign[node].clear)
            torn.stop(Status.INVALID)
            for node in nodes:
                if node.status is not Status.INVALID or isinstance(node, TreeLeaf):
                    node.stop(Status.INVALID)

    def _shut_down(self, ready: list[ForeignBehaviour]) -> None:
        for foreign in ready:
            with self._blackboard:
                self._contain(foreign.shut_down)

    def _contain(self, clean_up: Callable[[], None]) -> None:
        try:
            clean_up()
        except FlexcellError as error:
            # The error that caused the clean-up propagates; this one is only logged.
            self._execution.recorder.log(
                self._path, f"clean-up failed: {describe_cause(cause_of(error))}", level="error"
            )

    def _endless(self, idle_ticks: int) -> StateError:
        names = list(dict.fromkeys(map(self._short, self._recent)))
        return StateError(
            f"ticked {idle_ticks} times in a row without waiting for anything, through {' → '.join(names)}",
            where=self._path,
            hint="let one of these wait for something, or leave the loop",
        )
