"""The decorator that runs its child again after a failure."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.cause_chain import cause_of, wrap_cause
from engine.document.nodes.node_spec import RetrySpec
from engine.errors import Cause, FlexcellError, JournalError, NotStopped
from engine.runtime.tree.timers import TreeTimers
from engine.runtime.tree.tree_decorator import TreeDecorator
from engine.runtime.tree.tree_history import TreeNodeState
from engine.runtime.tree.tree_node import TreeNode


class Retry(TreeDecorator):
    """Runs its child again after FAILURE, and with `errors` after errors below, waiting in between.

    Args:
        path: Its node path.
        child: The node that is retried.
        spec: The number of retries, the first wait, which doubles each time, and whether errors below are retried.
        tree_timers: The timers of the tree.
        clear: Halts a subtree whose tick was interrupted by an error.
        report: Called with the number of the next attempt, the wait, and the error before it, if any.
    """

    def __init__(
        self,
        path: str,
        child: Behaviour,
        spec: RetrySpec,
        *,
        tree_timers: TreeTimers,
        clear: Callable[[Behaviour], None],
        report: Callable[[int, float, Cause | None], None],
    ) -> None:
        super().__init__(path, child)
        self.attempt = 1
        self._times = spec.times
        self._backoff_s = spec.backoff_s
        self._errors = spec.errors
        self._tree_timers = tree_timers
        self._clear = clear
        self._report = report

    def initialise(self) -> None:
        """Start the first attempt."""
        self.attempt = 1

    def tick(self) -> Iterator[Behaviour]:
        """Tick the child, or wait for the next attempt."""
        if self.status is not Status.RUNNING:
            self.initialise()
        elif self._tree_timers.pending(self.name):
            yield self
            return
        try:
            yield from self.decorated.tick()
        except (JournalError, NotStopped):
            raise
        except FlexcellError as error:
            if not self._errors or self.attempt > self._times:
                raise
            self._clear(self.decorated)
            self._try_again(cause_of(error))
            self.status = Status.RUNNING
            yield self
            return
        status = self.update()
        if status is not Status.RUNNING:
            self.stop(status)
        self.status = status
        yield self

    def update(self) -> Status:
        """Retry after a failure while attempts remain."""
        if self.decorated.status is Status.FAILURE and self.attempt <= self._times:
            self._try_again(None)
            return Status.RUNNING
        return self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Drop the timer of the wait."""
        self._tree_timers.drop(self.name)

    def explain(self, part: TreeNode, below: Cause | None) -> Cause | None:
        """Return the cause of the last attempt, with the number of attempts."""
        return wrap_cause(f"failed {self.attempt} times", below, where=part.path) if self.attempt > 1 else below

    def reads_end(self, end: Status, *, is_recorded: bool) -> bool:
        """Return whether it has begun no other attempt yet."""
        return not (is_recorded and end is Status.FAILURE)

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Resume the attempt, or the wait before it."""
        if state.status == "running":
            self.attempt = state.attempt
            left_s = self._backoff_s * 2 ** (self.attempt - 2) - (now_s - state.since_s)
            if self.attempt > 1 and self.decorated.status is not Status.RUNNING and left_s > 0:
                self._tree_timers.set(self.name, left_s)

    def _try_again(self, error: Cause | None) -> None:
        wait_s = self._backoff_s * 2 ** (self.attempt - 1)
        self.attempt += 1
        self._report(self.attempt, wait_s, error)
        if wait_s > 0:
            self._tree_timers.set(self.name, wait_s)
        else:
            self._tree_timers.call_again(self.name)
