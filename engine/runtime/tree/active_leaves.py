"""Active leaves of one tree: requested and halted inside a tick, started and stopped after it.

py_trees halts during a tick and cannot wait. So a tick only registers the leaves that it halts and requests; requested
leaves start after all halted leaves have confirmed their clean-up. A check starts inside the tick, which waits until it
is known whether the check ends at once; leaves halted before it in the tick have confirmed by then.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial

import msgspec

from engine.preemption import preempt
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.overdue_nodes import overdue_policy
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.scheduling.eager_start import start_eagerly
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.tree_node import LeafPlan

CHECK_TIMEOUT_S = 1.0
"""Maximum time a tick waits for a check that calls a service, before the check counts as RUNNING."""


class TreeLeafActivation(msgspec.Struct, eq=False):
    """One activation of a leaf, from the tick that requests it to the tick that reads its exit.

    Args:
        plan: The leaf.
        place: Access to its scope.
        rank: Its position in document order.
        caught: Whether a decorator around it handles its errors.
        task: Its task; None before it begins.
        restored: Its unread exit in an interrupted activation of the tree.
        passed: Whether a tick after its end has not reached it.
    """

    plan: LeafPlan
    place: ScopeAccess
    rank: int
    caught: bool
    task: asyncio.Task[NodeExit] | None = None
    restored: NodeExit | None = None
    passed: bool = False

    @property
    def path(self) -> str:
        """The leaf's node path."""
        return self.plan.node.path

    @property
    def left(self) -> NodeExit | None:
        """Its exit; None while it has not ended.

        Raises:
            FlexcellError: it ended with this error.
        """
        return self.task.result() if self.task is not None and self.task.done() else self.restored

    @property
    def begun(self) -> bool:
        """Whether it was entered, or is about to be entered."""
        return self.task is not None or self.restored is not None

    @property
    def ended(self) -> bool:
        """Whether it has ended, with an exit or an error."""
        return self.restored is not None or (self.task is not None and self.task.done())

    @property
    def error(self) -> BaseException | None:
        """The error it ended with, if any."""
        if self.task is None or not self.task.done() or self.task.cancelled():
            return None
        return self.task.exception()


class ActiveLeaves:
    """The active leaves of one activation of the tree at `path`.

    Args:
        execution: The execution of the run.
        path: The path of the tree.
        wake: Called when a leaf has ended that the next tick must read.
    """

    def __init__(self, execution: Execution, path: str, wake: Callable[[], None]) -> None:
        self._execution = execution
        self._path = path
        self._wake = wake
        self._requested: list[TreeLeafActivation] = []
        self._running: set[TreeLeafActivation] = set()
        self.halted: list[TreeLeafActivation] = []
        """The leaves halted in this tick that have not confirmed yet."""
        self._unread: set[TreeLeafActivation] = set()
        self._probed: TreeLeafActivation | None = None
        self.begun: list[str] = []
        """Paths of the leaves begun since `begun` was last cleared."""

    @property
    def unread(self) -> frozenset[TreeLeafActivation]:
        """The leaves that have ended and that no tick has read."""
        return frozenset(self._unread)

    def ask(self, activation: TreeLeafActivation) -> None:
        """Request a leaf; it begins when the tick is executed."""
        self._requested.append(activation)

    def read(self, activation: TreeLeafActivation) -> NodeExit | None:
        """Return the exit of a leaf and remove it; None while it runs.

        Raises:
            FlexcellError: it ended with this error.
        """
        if not activation.ended:
            return None
        self._running.discard(activation)
        self._unread.discard(activation)
        return activation.left

    def halt(self, activation: TreeLeafActivation) -> None:
        """Halt a leaf before any other begins; one that has not begun never begins.

        Its exit no longer matters, except for an error that nothing in the tree handles.
        """
        if not activation.begun:
            if activation in self._requested:
                self._requested.remove(activation)
            return
        self._running.discard(activation)
        self._unread.discard(activation)
        if not activation.ended or (activation.error is not None and not activation.caught):
            self.halted.append(activation)

    def keep(self, activation: TreeLeafActivation) -> None:
        """Keep an unread exit of an interrupted activation; it wakes the tree unless a tick passed it over."""
        if not activation.passed:
            self._unread.add(activation)

    def forget(self, seen: frozenset[TreeLeafActivation]) -> Sequence[TreeLeafActivation]:
        """Drop leaves that a tick has followed from the unread ones; return those that it did not reach, by rank."""
        passed = sorted(self._unread & seen, key=lambda each: each.rank) if self._unread else ()
        self._unread -= seen
        for each in passed:
            each.passed = True
        return passed

    async def confirm(self) -> None:
        """Stop the halted leaves in document order, and return when all clean-up is complete.

        Raises:
            FlexcellError: a clean-up failed, or did not end in time.
        """
        if not self.halted:
            return
        halted = self._take_halted()
        tasks = [each.task for each in halted if each.task is not None]
        await preempt(tasks, overdue_policy(self._execution, self._path))
        for each in halted:
            if each.error is not None:
                raise each.error

    async def begin(self) -> None:
        """Execute the tick: stop the halted leaves, then begin the requested ones."""
        await self.confirm()
        requested, self._requested = self._requested, []
        for activation in requested:
            self._start(activation)

    async def go_on(self) -> None:
        """Begin the leaves that resume interrupted activations; a check may have been interrupted during a tick."""
        for activation in tuple(self._requested):
            if not activation.plan.check:
                continue
            self._requested.remove(activation)
            start_eagerly(self._start(activation))
            await self.settled(activation)
            if activation.ended:
                self._unread.add(activation)
        await self.begin()

    def follow(self, activation: TreeLeafActivation, task: asyncio.Task[NodeExit]) -> None:
        """Assign the task of an activation, and wake the tree when it ends."""
        activation.task = task
        self._running.add(activation)
        task.add_done_callback(partial(self._end, activation))

    async def settled(self, activation: TreeLeafActivation) -> None:
        """Return when a running check has ended, or waits for anything but the answer of a service."""
        execution, path, task = self._execution, activation.path, activation.task
        assert task is not None, "it has begun"
        self._probed = activation
        waited_s = 0.0
        try:
            while not task.done():
                await execution.settlement.settled(self._path)
                if execution.branch_holds.held(path):
                    await execution.branch_holds.until_free(path)
                elif task.done() or not execution.pending_calls.any_inside(path) or waited_s >= CHECK_TIMEOUT_S:
                    break
                else:
                    waited_s += await self._answer(task, CHECK_TIMEOUT_S - waited_s)
        finally:
            self._probed = None

    async def stop(self) -> Sequence[asyncio.Task[NodeExit]]:
        """Stop all leaves and return their tasks once all clean-up is complete; clean-up errors are not raised.

        Raises:
            NotStopped: a clean-up did not end in time.
        """
        self._requested.clear()
        self.halted += self._running
        self._running.clear()
        self._unread.clear()
        tasks = [each.task for each in self._take_halted() if each.task is not None]
        await preempt(tasks, overdue_policy(self._execution, self._path))
        return tasks

    def _start(self, activation: TreeLeafActivation) -> asyncio.Task[NodeExit]:
        work = activation.plan.node.perform(activation.place.scope, self._execution)
        task = self._execution.activity.branch(activation.path, work)
        self.follow(activation, task)
        self.begun.append(activation.path)
        return task

    def _end(self, activation: TreeLeafActivation, _: asyncio.Task[NodeExit]) -> None:
        if activation in self._running and activation is not self._probed:
            self._unread.add(activation)
            self._wake()

    def _take_halted(self) -> list[TreeLeafActivation]:
        halted, self.halted = sorted(self.halted, key=lambda each: each.rank), []
        return halted

    async def _answer(self, task: asyncio.Task[NodeExit], timeout_s: float) -> float:
        """Wait until the check has an answer or has ended; return the elapsed time."""
        clock = self._execution.clock
        since_s = clock.now_s()
        with self._execution.pending_calls.changed() as changed:
            await asyncio.wait({task, changed}, timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
        return clock.now_s() - since_s
