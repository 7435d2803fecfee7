"""Ticks one activation of a tree when something woke it, and carries out what each tick decided."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.cause_chain import cause_of, describe_cause
from engine.document.expression_cost import MAX_STEPS
from engine.document.step_meter import METER
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
"""How many names are kept to name an endless loop."""


class TreeRunner:
    """One activation of a tree; used on the loop thread, run once.

    Args:
        root: The planned tree.
        path: The node that it is the work of.
        scope: Where its parts read and write.
        execution: The run.
        history: What had happened in an activation that was cut, to go on from there; see `mark_of`.
        branches: What branches of its parallels had written, by the path of the branch.
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
        self.ticks = 0
        """How often the tree was ticked."""
        self._path = path
        self._execution = execution
        self._news = asyncio.Event()
        self._recent: deque[str] = deque(maxlen=_REMEMBERED)
        self._leaves = ActiveLeaves(execution, path, self._news.set)
        self._tree_timers = TreeTimers(execution, self._news.set)
        self._builder = TreeBuilder(
            execution=execution, leaves=self._leaves, tree_timers=self._tree_timers, clear=self._clear
        )
        self._ticker = Ticker(execution, self._leaves, self._builder.turn, self._builder.statuses)
        self._polling = TreeLivelockDetector(
            path, execution, lambda: (*self._tree_timers.timers, *self._reactive.timers)
        )
        self._reactive = ReactiveChecks(
            path, execution, builder=self._builder, polling=self._polling, wake=self._news.set
        )
        self._blackboard: AbstractContextManager[None] = IsolatedBlackboard() if root.holds_foreign else nullcontext()
        self._watched = frozenset[str]()
        self._written: set[str] = set()
        self._planned = root
        self._place = ScopeAccess(scope)
        self._history = history
        self._branches: BranchValues = branches or {}

    async def run(self) -> Outcome:
        """Tick until the root has ended; everything it has begun has ended then.

        Raises:
            FlexcellError: a leaf, a foreign behaviour or a clean-up failed and nothing in the tree takes that.
            CancelledError: the tree was preempted; all clean-up is done.
        """
        recorder, hear = self._execution.recorder, self._hear
        ready: list[ForeignBehaviour] = []
        try:
            root = self._grow(ready)
            if self._builder.reactive or self._watched:
                # Events that nobody hears are not even made.
                recorder.watch(hear)
            return await self._run(root)
        except asyncio.CancelledError:
            raise_failure(await self._leaves.stop())
            raise
        finally:
            recorder.unwatch(hear)
            self._tree_timers.close()
            self._reactive.close()
            try:
                await self._leaves.stop()
            finally:
                self._shut_down(ready)
                self._builder.dismantle()

    def _grow(self, ready: list[ForeignBehaviour]) -> Behaviour:
        with self._blackboard:
            root = self._builder.build(self._planned, self._place)
            self._watched = frozenset(key for guard in self._builder.guards for key in guard.keys)
            for foreign in self._builder.foreign.values():
                foreign.set_up()
                ready.append(foreign)
        return root

    async def _run(self, root: Behaviour) -> Outcome:
        instants, moment = 0, self._moment()
        try:
            if self._history:
                await self._go_on(root)
            while root.status not in _FINAL:
                await self._tick(root)
                if root.status is Status.INVALID:
                    raise StateError("the root of the tree has no status", where=self._path)
                if root.status is Status.RUNNING:
                    await self._wait()
                last, moment = moment, self._moment()
                instants = instants + 1 if moment == last else 0
                if instants >= self._execution.instant_limit:
                    raise self._endless(instants)
            return self._outcome(root)
        except BaseException:
            # Whatever it is goes on; nothing in the tree may be left RUNNING.
            self._builder.statuses.closing = True
            self._clear(root)
            raise

    async def _go_on(self, root: Behaviour) -> None:
        """Stand where the history ends, and return when there is a reason to tick."""
        tick_due = restore_tree(root, self._builder, fold_tree_events(self._history), self._branches)
        await self._leaves.go_on()
        self._tree_timers.begin()
        self._reactive.follow(root)
        if root.status is Status.RUNNING and not tick_due:
            await self._wait()

    def _moment(self) -> float:
        """What is unchanged while no time passes: virtual time itself, else what was last waited for."""
        clock = self._execution.clock
        return clock.now_s() if clock.virtual else self._execution.waits.last(self._path)

    async def _tick(self, root: Behaviour) -> None:
        self.ticks += 1
        seen = self._leaves.unread
        self._raise_error(seen)
        self._count_polling()
        self._tree_timers.follow()
        self._news.clear()
        for guard in self._builder.guards:
            guard.said = None
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
        """Count a tick that only a timer of the tree has made due; what a foreign behaviour counts nobody knows."""
        if self._tree_timers.rang and not (self._leaves.unread or self._reactive.tick_due or self._builder.foreign):
            self._polling.count(lambda: ", ".join(dict.fromkeys(map(self._short, self._recent))) or "its parts")
        else:
            self._polling.forget()

    def _short(self, path: str) -> str:
        return path.removeprefix(f"{self._path}/")

    def _steps(self, root: Behaviour) -> Iterator[Behaviour]:
        steps = root.tick()
        # Nothing else in a tree evaluates anything, or runs code of others.
        return self._watched_over(steps) if self._builder.guards or self._builder.foreign else steps

    def _watched_over(self, steps: Iterator[Behaviour]) -> Iterator[Behaviour]:
        while True:
            with self._execution.counted(), self._blackboard:
                step = next(steps, None)
            if step is None:
                return
            yield step

    def _raise_error(self, ended: frozenset[TreeLeafActivation]) -> None:
        """Raise the first error, in document order, that no decorator takes: it ends the tree at once."""
        for each in sorted(ended, key=lambda each: each.rank):
            if each.error is not None and not each.caught:
                raise each.error

    async def _wait(self) -> None:
        """Return when there is a reason to tick, everything of this instant has played out, and nothing holds us."""
        while not (self._is_due() or self._guard_has_changed()):
            self._news.clear()
            if self._reactive.stale:
                await self._reactive.ask(until=self._is_due, news=self._news)
            else:
                await self._news.wait()
        await self._execution.settlement.settled(self._path)
        branch_holds = self._execution.branch_holds
        while branch_holds.active and branch_holds.held(self._path):
            await branch_holds.until_free(self._path)
            self._reactive.forget_answers()
            await self._execution.settlement.settled(self._path)

    def _is_due(self) -> bool:
        return self._tree_timers.due or bool(self._leaves.unread) or self._reactive.tick_due

    def _guard_has_changed(self) -> bool:
        """Tell whether a guard that was asked in the last tick would now say something else."""
        written, self._written = self._written, set()
        asked = [each for each in self._builder.guards if each.said is not None and each.keys & written]
        try:
            with METER.limited(MAX_STEPS, "the guards of this tree"):
                return any(each.holds() is not each.said for each in asked)
        except FlexcellError:
            return True  # the tick will meet the error where a decorator may take it

    def _hear(self, event: Event) -> None:
        self._reactive.hear(event)
        if isinstance(event, UserdataWritten | UserdataAppended) and event.key in self._watched:
            self._written.add(event.key)
            self._news.set()
            if not is_inside(self._path, event.path):
                self._execution.waits.add(self._path)

    def _outcome(self, root: Behaviour) -> Outcome:
        if root.status is Status.SUCCESS:
            return Outcome("success")
        return Outcome("failure", cause=explain_tree_failure(root, self._builder.parts, self._builder.entry_guards))

    def _clear(self, torn: Behaviour) -> None:
        """Halt everything at and below a node, also what py_trees forgets when an exception has torn its tick."""
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
            # What made the clean-up necessary goes on; this is told beside it.
            self._execution.recorder.log(
                self._path, f"clean-up failed: {describe_cause(cause_of(error))}", level="error"
            )

    def _endless(self, instants: int) -> StateError:
        names = list(dict.fromkeys(map(self._short, self._recent)))
        return StateError(
            f"ticked {instants} times in a row without waiting for anything, through {' → '.join(names)}",
            where=self._path,
            hint="let one of these wait for something, or leave the loop",
        )
