"""The leaves of one tree that are active: asked for and halted inside a tick, begun and stopped around it.

py_trees halts in the middle of a tick and cannot wait. So a tick only notes what it halts and what
it begins; what it begins starts after everything it has halted has confirmed its clean-up. A leaf
that is a check starts inside the tick, which is held up until it is clear whether the check ends
at once; what was halted before it in the tick has confirmed by then.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from functools import partial

import msgspec

from engine.preemption import preempt
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.node import overdue_policy
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.scheduling.eager_start import start_eagerly
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.tree_node import LeafPlan

CHECK_TIMEOUT_S = 1.0
"""How long a tick waits for a check that has asked a service, before the check counts as RUNNING."""


class TreeLeafActivation(msgspec.Struct, eq=False):
    """One activation of a leaf, from the tick that asks for it to the tick that reads how it ended.

    Args:
        plan: The leaf.
        place: Where it reads and writes.
        rank: Its place in the document.
        caught: Whether a decorator around it takes its errors.
        task: What it is carried by; None before it begins.
        restored: How it had ended, unread, in an activation of the tree that was cut.
        passed: Whether a tick has not come to it since it has ended.
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
        """How it ended; None while it has not.

        Raises:
            FlexcellError: it ended with this error.
        """
        return self.task.result() if self.task is not None and self.task.done() else self.restored

    @property
    def begun(self) -> bool:
        """Whether it was entered, or is about to be."""
        return self.task is not None or self.restored is not None

    @property
    def ended(self) -> bool:
        """Whether it has ended, be it with an error."""
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
        execution: The run.
        path: The tree.
        wake: Called when a leaf has ended that the next tick has to read.
    """

    def __init__(self, execution: Execution, path: str, wake: Callable[[], None]) -> None:
        self._execution = execution
        self._path = path
        self._wake = wake
        self._asked: list[TreeLeafActivation] = []
        self._running: set[TreeLeafActivation] = set()
        self.halted: list[TreeLeafActivation] = []
        """What was halted in this tick and has not confirmed yet."""
        self._unread: set[TreeLeafActivation] = set()
        self._probed: TreeLeafActivation | None = None
        self.begun: list[str] = []
        """Paths of the leaves begun since `begun` was last cleared."""

    @property
    def unread(self) -> frozenset[TreeLeafActivation]:
        """Those that have ended and that no tick has read."""
        return frozenset(self._unread)

    def ask(self, activation: TreeLeafActivation) -> None:
        """Have a leaf begin when the tick is carried out."""
        self._asked.append(activation)

    def read(self, activation: TreeLeafActivation) -> NodeExit | None:
        """Return how it ended and forget it; None while it runs.

        Raises:
            FlexcellError: it ended with this error.
        """
        if not activation.ended:
            return None
        self._running.discard(activation)
        self._unread.discard(activation)
        return activation.left

    def halt(self, activation: TreeLeafActivation) -> None:
        """Have a leaf stopped before anything else begins; one that has not begun never does.

        How it ended no longer matters, unless with an error that nothing in the tree takes.
        """
        if not activation.begun:
            if activation in self._asked:
                self._asked.remove(activation)
            return
        self._running.discard(activation)
        self._unread.discard(activation)
        if not activation.ended or (activation.error is not None and not activation.caught):
            self.halted.append(activation)

    def keep(self, activation: TreeLeafActivation) -> None:
        """Have one that has ended in an activation of the tree that was cut wake the tree, unless that was ticked."""
        if not activation.passed:
            self._unread.add(activation)

    def forget(self, seen: frozenset[TreeLeafActivation]) -> Sequence[TreeLeafActivation]:
        """Do not wake for these any more: a tick has followed. Return those to which it has not come, by rank."""
        passed = sorted(self._unread & seen, key=lambda each: each.rank) if self._unread else ()
        self._unread -= seen
        for each in passed:
            each.passed = True
        return passed

    async def confirm(self) -> None:
        """Stop what was halted, in document order, and return when all clean-up is done.

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
        """Carry out the tick: stop what it halted, then begin what it asked for."""
        await self.confirm()
        asked, self._asked = self._asked, []
        for activation in asked:
            self._start(activation)

    async def go_on(self) -> None:
        """Begin what is asked for in place of activations that were cut; a check may have been in mid-tick."""
        for activation in tuple(self._asked):
            if not activation.plan.check:
                continue
            self._asked.remove(activation)
            start_eagerly(self._start(activation))
            await self.settled(activation)
            if activation.ended:
                self._unread.add(activation)
        await self.begin()

    def follow(self, activation: TreeLeafActivation, task: asyncio.Task[NodeExit]) -> None:
        """Have it be carried by this task, and wake the tree when that ends."""
        activation.task = task
        self._running.add(activation)
        task.add_done_callback(partial(self._end, activation))

    async def settled(self, activation: TreeLeafActivation) -> None:
        """Return when a check that goes on has ended, or waits for something but the answer of a service."""
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
        """Stop everything and return what was stopped, once all clean-up is done; errors of clean-ups are not raised.

        Raises:
            NotStopped: a clean-up did not end in time.
        """
        self._asked.clear()
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
        """Wait until the check has an answer or has ended; return how long that took."""
        clock = self._execution.clock
        since_s = clock.now_s()
        with self._execution.pending_calls.changed() as changed:
            await asyncio.wait({task, changed}, timeout=timeout_s, return_when=asyncio.FIRST_COMPLETED)
        return clock.now_s() - since_s
