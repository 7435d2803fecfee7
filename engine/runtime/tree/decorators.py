"""Decorators that py_trees lacks, or implements with another clock or without a wake-up.

Every `tick` yields the decorator itself last: the composite above stops iterating there, so no work may remain.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from py_trees import decorators
from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator

from engine.cause_chain import cause_of
from engine.errors import FlexcellError, JournalError, NotStopped
from engine.event import Cause
from engine.runtime.tree.timers import TreeTimers
from engine.runtime.tree.tree_history import TreeNodeState

WHERE_NOTHING_WAKES_S = 0.1
"""Default tick period of a node that is RUNNING while nothing below it can wake the tree."""


class Timeout(Decorator):
    """Fails when its child does not end in time; a child that ends at that instant is in time."""

    def __init__(self, path: str, child: Behaviour, after_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child)
        self.refusal = ""
        """Reason of its own failure; empty where the child determines the status."""
        self._after_s = after_s
        self._tree_timers = tree_timers

    def initialise(self) -> None:
        """Start the timer when this tick is executed."""
        self._tree_timers.set(self.name, self._after_s)

    def update(self) -> Status:
        """Stop the child when the time has elapsed."""
        self.refusal = ""
        if self.decorated.status is Status.RUNNING and not self._tree_timers.pending(self.name):
            self.decorated.stop(Status.INVALID)
            self.refusal = f"did not end within {self._after_s:g} s"
            return Status.FAILURE
        return self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Drop the timer."""
        self._tree_timers.drop(self.name)

    def restore(self, state: TreeNodeState, elapsed_s: float, *, reached: bool) -> None:
        """Resume the timer; if it had elapsed and no tick reaches this node, its tick has already followed."""
        if state.status == "running" and (reached or elapsed_s <= self._after_s):
            self._tree_timers.set(self.name, max(0.0, self._after_s - elapsed_s))


class Cooldown(Decorator):
    """Fails without ticking its child until a time has passed since the child last ended or was halted."""

    def __init__(self, path: str, child: Behaviour, after_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child)
        self.refusal = ""
        """Reason of its own failure; empty where the child determines the status."""
        self._after_s = after_s
        self._tree_timers = tree_timers
        self._child_active = False

    @property
    def cooling(self) -> bool:
        """Whether it fails without ticking its child."""
        return self._tree_timers.pending(self.name)

    def tick(self) -> Iterator[Behaviour]:
        """Tick the child, or fail while cooling down."""
        if not self.cooling:
            self._child_active = True
            yield from super().tick()
            return
        self.refusal = f"the cooldown of {self._after_s:g} s is active"
        self.stop(Status.FAILURE)
        yield self

    def update(self) -> Status:
        """Return the status of the child."""
        self.refusal = ""
        return self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Start the cooldown if the child was ticked."""
        if self._child_active:
            self._child_active = False
            self._tree_timers.set(self.name, self._after_s)

    def restore(self, state: TreeNodeState, elapsed_s: float) -> None:
        """Resume the cooldown, where it has not elapsed."""
        self._child_active = state.status == "running"
        left_s = self._after_s - elapsed_s
        if not self._child_active and left_s > 0 and (state.first is not None or state.ended_s is not None):
            self._tree_timers.set(self.name, left_s)


class Guard(Decorator):
    """Ticks its child only while a condition holds; otherwise stops it and takes the status of its target.

    Args:
        path: Its node path.
        child: The guarded node.
        keys: The userdata keys and parameters that the condition reads.
        holds: Evaluates the condition; may raise FlexcellError.
        text: The condition as written.
        closed: Returns the status for a condition that does not hold.
    """

    def __init__(
        self,
        path: str,
        child: Behaviour,
        *,
        keys: frozenset[str],
        holds: Callable[[], bool],
        text: str,
        closed: Callable[[Behaviour], Status],
    ) -> None:
        super().__init__(path, child)
        self.refusal = ""
        """Reason of its own failure; empty where the child determines the status."""
        self.keys = keys
        self.holds = holds
        self.said: bool | None = None
        """Value of the condition in the current or last tick; None where it was not evaluated."""
        self._text = text
        self._closed = closed

    def tick(self) -> Iterator[Behaviour]:
        """Evaluate the condition, then tick the child or stop it."""
        self.said = self.holds()
        if self.said:
            yield from super().tick()
            return
        self.refusal = f"{self._text} is false"
        self.stop(self._closed(self))
        yield self

    def update(self) -> Status:
        """Return the status of the child."""
        self.refusal = ""
        return self.decorated.status


class Repeat(decorators.Repeat):
    """Repeat of py_trees that requests the next tick at once instead of waiting for it."""

    def __init__(
        self, path: str, child: Behaviour, times: int, tree_timers: TreeTimers, tell: Callable[[Behaviour], None]
    ) -> None:
        super().__init__(path, child, times)
        self._tree_timers = tree_timers
        self._tell = tell

    def update(self) -> Status:
        """Count a success and request the next tick."""
        status = super().update()
        if status is Status.RUNNING and self.decorated.status is Status.SUCCESS:
            self._tree_timers.call_again(self.name)
            self._tell(self)
        return status

    def terminate(self, new_status: Status) -> None:
        """Drop the request for a tick."""
        self._tree_timers.drop(self.name)


class Retry(Decorator):
    """Runs its child again after FAILURE, and with `errors` after errors below, waiting in between.

    Args:
        path: Its node path.
        child: The node that is retried.
        times: Maximum number of retries.
        backoff_s: The first wait; it doubles each time.
        errors: Whether an error of a leaf below counts as a failed attempt.
        tree_timers: The timers of the tree.
        clear: Halts a subtree whose tick was interrupted by an error.
        tell: Called with the number of the next attempt, the wait, and the error before it, if any.
    """

    def __init__(
        self,
        path: str,
        child: Behaviour,
        *,
        times: int,
        backoff_s: float,
        errors: bool,
        tree_timers: TreeTimers,
        clear: Callable[[Behaviour], None],
        tell: Callable[[int, float, Cause | None], None],
    ) -> None:
        super().__init__(path, child)
        self.attempt = 1
        self._times = times
        self._backoff_s = backoff_s
        self._errors = errors
        self._tree_timers = tree_timers
        self._clear = clear
        self._tell = tell

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

    def restore(self, state: TreeNodeState, elapsed_s: float) -> None:
        """Resume the attempt, or the wait before it."""
        if state.status == "running":
            self.attempt = state.attempt
            left_s = self._backoff_s * 2 ** (self.attempt - 2) - elapsed_s
            if self.attempt > 1 and self.decorated.status is not Status.RUNNING and left_s > 0:
                self._tree_timers.set(self.name, left_s)

    def _try_again(self, error: Cause | None) -> None:
        wait_s = self._backoff_s * 2 ** (self.attempt - 1)
        self.attempt += 1
        self._tell(self.attempt, wait_s, error)
        if wait_s > 0:
            self._tree_timers.set(self.name, wait_s)
        else:
            self._tree_timers.call_again(self.name)


class Remap(Decorator):
    """Maps the status of its child to another; ticked periodically where it hides an end as RUNNING."""

    def __init__(
        self, path: str, child: Behaviour, shown: Mapping[Status, Status], every_s: float, tree_timers: TreeTimers
    ) -> None:
        super().__init__(path, child)
        self.refusal = ""
        """Reason of its own failure; empty where the child determines the status."""
        self.shown = shown
        self._every_s = every_s
        self._tree_timers = tree_timers

    def update(self) -> Status:
        """Return the mapped status."""
        actual = self.decorated.status
        shown = self.shown[actual]
        self.refusal = ""
        if shown is not actual and shown is Status.FAILURE:
            self.refusal = f"{actual.value} counts as FAILURE"
        hidden = shown is Status.RUNNING and shown is not actual
        _schedule_tick(self._tree_timers, self.name, self._every_s, hidden=hidden)
        return shown

    def terminate(self, new_status: Status) -> None:
        """Drop the periodic tick."""
        self._tree_timers.drop(self.name)

    def restore(self, state: TreeNodeState, elapsed_s: float) -> None:
        """Resume the periodic tick if it is needed."""
        hidden = state.status == "running" and self.decorated.status is not Status.RUNNING
        _schedule_tick(self._tree_timers, self.name, self._every_s, hidden=hidden)


class StatusCondition(decorators.Condition):
    """Condition of py_trees, ticked periodically while its child has ended with another status."""

    def __init__(self, path: str, child: Behaviour, status: Status, every_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child, status)
        self._every_s = every_s
        self._tree_timers = tree_timers

    def update(self) -> Status:
        """Return RUNNING until the child has the status."""
        status = super().update()
        ended = self.decorated.status is not Status.RUNNING
        _schedule_tick(self._tree_timers, self.name, self._every_s, hidden=status is Status.RUNNING and ended)
        return status

    def terminate(self, new_status: Status) -> None:
        """Drop the periodic tick."""
        self._tree_timers.drop(self.name)

    def restore(self, state: TreeNodeState, elapsed_s: float) -> None:
        """Resume the periodic tick if it is needed."""
        hidden = state.status == "running" and self.decorated.status is not Status.RUNNING
        _schedule_tick(self._tree_timers, self.name, self._every_s, hidden=hidden)


def _schedule_tick(tree_timers: TreeTimers, path: str, every_s: float, *, hidden: bool) -> None:
    """Schedule a tick for a node that is RUNNING although its child has ended: nothing below wakes the tree."""
    if hidden:
        tree_timers.set(path, every_s)
    else:
        tree_timers.drop(path)
