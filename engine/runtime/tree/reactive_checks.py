"""Re-evaluates the checks of composites without memory while an action runs.

A composite without memory ticks its checks at every tick, a `while_do_else` its condition, and reacts to their status.
The tree is not ticked while no leaf ends, so checks are observed outside of ticks: when userdata that they read is
written, when a topic that they read has a new message, and at their period. A tick is due only when the status of a
check would change.
"""

from __future__ import annotations

import asyncio
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import partial

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.event import Event, MessageReceived, UserdataAppended, UserdataWritten
from engine.node_path import is_inside
from engine.preemption import preempt
from engine.runtime.nodes.execution import Execution
from engine.runtime.nodes.observation import Observation, observe
from engine.runtime.nodes.overdue_nodes import overdue_policy
from engine.runtime.scheduling.timer import Timer
from engine.runtime.tree.active_leaves import CHECK_TIMEOUT_S
from engine.runtime.tree.branching import WhileDoElse
from engine.runtime.tree.foreign_behaviour import ForeignBehaviour
from engine.runtime.tree.tree_builder import TreeBuilder
from engine.runtime.tree.tree_decorator import TreeDecorator
from engine.runtime.tree.tree_leaf import TreeLeaf
from engine.runtime.tree.tree_livelock import TreeLivelockDetector

_FINAL = (Status.SUCCESS, Status.FAILURE)


class _Watch:
    """One check that is observed while the nodes behind it are active."""

    def __init__(self, leaf: TreeLeaf) -> None:
        self.leaf = leaf
        self.timer: Timer | None = None
        self.topics: dict[str, Callable[[], None]] = {}
        self.visit = 0
        self.forget_entry: Callable[[], None] = lambda: None

    @property
    def path(self) -> str:
        return self.leaf.plan.node.path


class ReactiveChecks:
    """The checks that the next tick of one tree activation would tick again; used on the loop thread.

    Args:
        path: The path of the tree.
        execution: The execution of the run.
        builder: The nodes of the tree.
        polling: Counts observations without a change.
        wake: Called when the status of a check may have changed, or a tick is due.
    """

    def __init__(
        self,
        path: str,
        execution: Execution,
        *,
        builder: TreeBuilder,
        polling: TreeLivelockDetector,
        wake: Callable[[], None],
    ) -> None:
        self.tick_due = False
        """Whether a change requires a tick of the tree."""
        self._path = path
        self._execution = execution
        self._builder = builder
        self._polling = polling
        self._wake = wake
        self._watches: dict[Behaviour, _Watch] = {}
        self._foreign: dict[Behaviour, ForeignBehaviour] = {}
        self._topics: dict[str, set[str]] = defaultdict(set)

    @property
    def timers(self) -> tuple[Timer, ...]:
        """The active timers."""
        return tuple(watch.timer for watch in self._watches.values() if watch.timer is not None)

    @property
    def stale(self) -> bool:
        """Whether the status of a check may have changed, so that `ask` has to observe it."""
        return any(watch.leaf.stale for watch in self._watches.values())

    def follow(self, root: Behaviour) -> None:
        """Watch the checks that the next tick would tick again; called after each tick."""
        self.tick_due = False
        if not self._builder.reactive:
            return
        leaves = tuple(self._reactive_leaves(root)) if root.status is Status.RUNNING else ()
        for removed in [leaf for leaf in self._watches if leaf not in leaves]:
            self._end(self._watches.pop(removed))
        self._foreign = {each: self._builder.foreign[each] for each in leaves if each in self._builder.foreign}
        for leaf in leaves:
            if isinstance(leaf, TreeLeaf) and leaf.plan.check:
                self._watch(self._watches.setdefault(leaf, _Watch(leaf)))
        # In document order, which is the order of observation.
        self._watches = {leaf: self._watches[leaf] for leaf in leaves if leaf in self._watches}

    def hear(self, event: Event) -> None:
        """Take an event of the run."""
        if isinstance(event, UserdataWritten | UserdataAppended):
            if (self._watches or self._foreign) and self._execution.skills.entries is None:
                self._on_write(event)
        elif isinstance(event, MessageReceived) and self._builder.reactive and is_inside(self._path, event.path):
            self._topics[event.path].add(event.topic)

    async def ask(self, *, until: Callable[[], bool], changed: asyncio.Event) -> None:
        """Observe the checks that may have changed, in document order, until a tick is due.

        Args:
            until: Returns whether a tick is due for another reason, which ends the observation.
            changed: Set when there may be such a reason.

        Raises:
            StateError: in virtual time only observations would continue, forever.
            CancelledError: the tree was preempted.
        """
        for watch in tuple(self._watches.values()):
            if not watch.leaf.stale or self.tick_due:
                continue
            await self._execution.branch_holds.until_free(watch.path)
            if until():
                return
            watch.leaf.stale = False
            observed = await self._observe(watch.leaf, until, changed)
            if until():
                watch.leaf.stale = True
                return
            self._compare(watch, observed)
            self._start_timer(watch)
            if not self.tick_due:
                self._polling.count(self._names)

    def forget_answers(self) -> None:
        """Drop the observed answers: time has passed since the observation."""
        for watch in self._watches.values():
            self._execution.observed.forget(watch.path)

    def close(self) -> None:
        """End all watches."""
        for watch in self._watches.values():
            self._end(watch)
        self._watches.clear()
        self._foreign.clear()

    def _reactive_leaves(self, node: Behaviour) -> Iterator[Behaviour]:
        """Yield the leaves in front of the RUNNING child of composites without memory, below a RUNNING node."""
        without_memory = isinstance(node, WhileDoElse) or (
            isinstance(node, composites.Sequence | composites.Selector) and not node.memory
        )
        for child in node.children:
            if child.status is Status.RUNNING:
                yield from self._reactive_leaves(child)
                if without_memory:
                    return
            elif without_memory:
                yield from self._ended(child)

    def _ended(self, node: Behaviour) -> Iterator[Behaviour]:
        """Yield the leaves of an ended node, which a tick would tick again."""
        if node.status not in _FINAL:
            return
        if isinstance(node, TreeDecorator) and not node.ticks_child:
            return
        if isinstance(node, TreeLeaf) or node in self._builder.foreign:
            yield node
            return
        for child in node.children:
            yield from self._ended(child)

    def _compare(self, watch: _Watch, observed: Observation) -> None:
        self._topics[watch.path] |= observed.topics
        self._subscribe_topics(watch)
        if observed.left is not None:
            status = watch.leaf.status_of(observed.left)
            if status is watch.leaf.reported:
                return
            # If the tick does not reach it, it must not cause another tick.
            watch.leaf.reported = status
        self._execution.observed.keep(watch.path, observed.answers)
        self.tick_due = True

    async def _observe(self, leaf: TreeLeaf, until: Callable[[], bool], changed: asyncio.Event) -> Observation:
        path = leaf.plan.node.path
        work = observe(leaf.plan.node, leaf.scope, self._execution)
        task = asyncio.create_task(work, name=f"observing {path}")
        changed_task: asyncio.Task[bool] | None = None
        try:
            # Most observations end in the first iteration of the loop.
            await asyncio.sleep(0)
            deadline_s = self._execution.clock.now_s() + CHECK_TIMEOUT_S
            while not task.done() and not until():
                left_s = deadline_s - self._execution.clock.now_s()
                if left_s <= 0:
                    break
                if changed_task is None or changed_task.done():
                    changed.clear()
                    changed_task = asyncio.create_task(changed.wait(), name=f"changes of {self._path}")
                await asyncio.wait({task, changed_task}, timeout=left_s, return_when=asyncio.FIRST_COMPLETED)
        finally:
            if changed_task is not None:
                changed_task.cancel()
            await preempt((task,), overdue_policy(self._execution, self._path))
        return Observation() if task.cancelled() else task.result()

    def _on_write(self, event: UserdataWritten | UserdataAppended) -> None:
        affected = False
        for watch in self._watches.values():
            reads = watch.leaf.plan.reads
            if (reads is None or event.key in reads) and not is_inside(watch.path, event.path):
                watch.leaf.stale = affected = True
        for foreign in self._foreign.values():
            if event.key in foreign.reads:
                self.tick_due = affected = True
        if affected:
            if not is_inside(self._path, event.path):
                self._execution.waits.add(self._path)
            self._wake()

    def _watch(self, watch: _Watch) -> None:
        entries = self._execution.skills.entries
        if entries is not None:
            visit = self._execution.visits.get(watch.path, 0) + 1
            if visit != watch.visit:
                watch.forget_entry()
                watch.visit = visit
                watch.forget_entry = entries.expect(watch.path, visit, self._tick)
            return
        self._start_timer(watch)
        self._subscribe_topics(watch)

    def _subscribe_topics(self, watch: _Watch) -> None:
        for topic in self._topics[watch.path] - watch.topics.keys():
            watch.topics[topic] = self._execution.skills.watch(topic, partial(self._mark_stale, watch))

    def _start_timer(self, watch: _Watch) -> None:
        """Start the timer of the next periodic observation, unless it is running."""
        every_s = watch.leaf.plan.every_s
        if every_s is None or (watch.timer is not None and not watch.timer.future.done()):
            return
        if watch.timer is not None:
            self._execution.branch_holds.drop(watch.timer)
        watch.timer = self._execution.branch_holds.timer(watch.path, every_s)
        watch.timer.future.add_done_callback(lambda _: self._mark_stale(watch))

    def _mark_stale(self, watch: _Watch) -> None:
        if watch.leaf in self._watches:
            self._execution.waits.add(watch.path)
            watch.leaf.stale = True
            self._wake()

    def _tick(self) -> None:
        self.tick_due = True
        self._wake()

    def _names(self) -> str:
        return ", ".join(watch.path.removeprefix(f"{self._path}/") for watch in self._watches.values())

    def _end(self, watch: _Watch) -> None:
        if watch.timer is not None:
            self._execution.branch_holds.drop(watch.timer)
        for forget in watch.topics.values():
            forget()
        watch.forget_entry()
        self._execution.observed.forget(watch.path)
