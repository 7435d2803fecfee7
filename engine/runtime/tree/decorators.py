"""Decorators that py_trees lacks, or has with another clock or without a wake-up of their own.

In every `tick` the last thing yielded is the decorator itself: the composite above stops listening
there, so nothing may be left to do.
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
"""How often a part is ticked by default that is RUNNING while nothing that could wake it runs below."""


class Timeout(Decorator):
    """Fails when its child has not ended in time; a child that ends at that very moment has."""

    def __init__(self, path: str, child: Behaviour, after_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child)
        self.refusal = ""
        """Why it failed of itself."""
        self._after_s = after_s
        self._tree_timers = tree_timers

    def initialise(self) -> None:
        """Begin to count when this tick is carried out."""
        self._tree_timers.set(self.name, self._after_s)

    def update(self) -> Status:
        """Stop the child when time is up."""
        self.refusal = ""
        if self.decorated.status is Status.RUNNING and not self._tree_timers.pending(self.name):
            self.decorated.stop(Status.INVALID)
            self.refusal = f"no end within {self._after_s:g} s"
            return Status.FAILURE
        return self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Count no longer."""
        self._tree_timers.drop(self.name)

    def restore(self, standing: TreeNodeState, elapsed_s: float, *, reached: bool) -> None:
        """Go on counting; when time was up and no tick comes here, one has followed that all the same."""
        if standing.status == "running" and (reached or elapsed_s <= self._after_s):
            self._tree_timers.set(self.name, max(0.0, self._after_s - elapsed_s))


class Cooldown(Decorator):
    """Fails without ticking its child until a time has passed since the child last ended or was halted."""

    def __init__(self, path: str, child: Behaviour, after_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child)
        self.refusal = ""
        """Why it failed of itself."""
        self._after_s = after_s
        self._tree_timers = tree_timers
        self._busy = False

    @property
    def cooling(self) -> bool:
        """Whether it fails without asking its child."""
        return self._tree_timers.pending(self.name)

    def tick(self) -> Iterator[Behaviour]:
        """Tick the child, or fail while cooling down."""
        if not self.cooling:
            self._busy = True
            yield from super().tick()
            return
        self.refusal = f"cooling down, {self._after_s:g} s in all"
        self.stop(Status.FAILURE)
        yield self

    def update(self) -> Status:
        """Tell what the child says."""
        self.refusal = ""
        return self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Cool down if the child was at work."""
        if self._busy:
            self._busy = False
            self._tree_timers.set(self.name, self._after_s)

    def restore(self, standing: TreeNodeState, elapsed_s: float) -> None:
        """Go on cooling down, where it had ended less than its time ago."""
        self._busy = standing.status == "running"
        left_s = self._after_s - elapsed_s
        if not self._busy and left_s > 0 and (standing.first is not None or standing.ended_s is not None):
            self._tree_timers.set(self.name, left_s)


class Guard(Decorator):
    """Ticks its child only while a condition holds; stops it when it does not, and then has its target for a status.

    Args:
        path: Its node path.
        child: What is guarded.
        keys: The userdata keys and parameters that the condition reads.
        holds: Evaluates the condition; may raise FlexcellError.
        text: The condition as written.
        closed: Gives the status that it has when the condition does not hold.
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
        """Why it failed of itself."""
        self.keys = keys
        self.holds = holds
        self.said: bool | None = None
        """What the condition was in the tick under way, or in the last one; None where it was not asked."""
        self._text = text
        self._closed = closed

    def tick(self) -> Iterator[Behaviour]:
        """Ask, then tick the child or stop it."""
        self.said = self.holds()
        if self.said:
            yield from super().tick()
            return
        self.refusal = f"{self._text} is false"
        self.stop(self._closed(self))
        yield self

    def update(self) -> Status:
        """Tell what the child says."""
        self.refusal = ""
        return self.decorated.status


class Repeat(decorators.Repeat):
    """py_trees' Repeat, which has the tree ticked again at once where py_trees waits for a next tick."""

    def __init__(
        self, path: str, child: Behaviour, times: int, tree_timers: TreeTimers, tell: Callable[[Behaviour], None]
    ) -> None:
        super().__init__(path, child, times)
        self._tree_timers = tree_timers
        self._tell = tell

    def update(self) -> Status:
        """Count, and go on at once."""
        status = super().update()
        if status is Status.RUNNING and self.decorated.status is Status.SUCCESS:
            self._tree_timers.call_again(self.name)
            self._tell(self)
        return status

    def terminate(self, new_status: Status) -> None:
        """Go on no more."""
        self._tree_timers.drop(self.name)


class Retry(Decorator):
    """Runs its child again after FAILURE, and after errors below when `errors`, waiting in between.

    Args:
        path: Its node path.
        child: What is tried.
        times: How often it is tried again.
        backoff_s: The first wait; it doubles each time.
        errors: Whether an error of a leaf below is a failed attempt.
        tree_timers: Where waits are set.
        clear: Brings a subtree to rest whose tick was torn by an error.
        tell: Told the number of the attempt that comes, the wait, and the error before it, if it was one.
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
        """Begin with the first attempt."""
        self.attempt = 1

    def tick(self) -> Iterator[Behaviour]:
        """Tick the child, or wait for the next attempt to begin."""
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
        """Try again after a failure as long as attempts are left."""
        if self.decorated.status is Status.FAILURE and self.attempt <= self._times:
            self._try_again(None)
            return Status.RUNNING
        return self.decorated.status

    def terminate(self, new_status: Status) -> None:
        """Wait no longer."""
        self._tree_timers.drop(self.name)

    def restore(self, standing: TreeNodeState, elapsed_s: float) -> None:
        """Go on with the attempt, or with the wait before it."""
        if standing.status == "running":
            self.attempt = standing.attempt
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
    """Shows another status than its child has; ticked from time to time where it hides an end."""

    def __init__(
        self, path: str, child: Behaviour, shown: Mapping[Status, Status], every_s: float, tree_timers: TreeTimers
    ) -> None:
        super().__init__(path, child)
        self.refusal = ""
        """Why it failed of itself."""
        self.shown = shown
        self._every_s = every_s
        self._tree_timers = tree_timers

    def update(self) -> Status:
        """Show what is to be shown."""
        actual = self.decorated.status
        shown = self.shown[actual]
        self.refusal = ""
        if shown is not actual and shown is Status.FAILURE:
            self.refusal = f"{actual.value} counts as FAILURE"
        _wake_up(self._tree_timers, self.name, self._every_s, hidden=shown is Status.RUNNING and shown is not actual)
        return shown

    def terminate(self, new_status: Status) -> None:
        """Be ticked no longer."""
        self._tree_timers.drop(self.name)

    def restore(self, standing: TreeNodeState, elapsed_s: float) -> None:
        """Be ticked again from time to time if need be."""
        hidden = standing.status == "running" and self.decorated.status is not Status.RUNNING
        _wake_up(self._tree_timers, self.name, self._every_s, hidden=hidden)


class StatusCondition(decorators.Condition):
    """py_trees' Condition, ticked from time to time while its child has ended otherwise."""

    def __init__(self, path: str, child: Behaviour, status: Status, every_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child, status)
        self._every_s = every_s
        self._tree_timers = tree_timers

    def update(self) -> Status:
        """Wait for the status."""
        status = super().update()
        ended = self.decorated.status is not Status.RUNNING
        _wake_up(self._tree_timers, self.name, self._every_s, hidden=status is Status.RUNNING and ended)
        return status

    def terminate(self, new_status: Status) -> None:
        """Be ticked no longer."""
        self._tree_timers.drop(self.name)

    def restore(self, standing: TreeNodeState, elapsed_s: float) -> None:
        """Be ticked again from time to time if need be."""
        hidden = standing.status == "running" and self.decorated.status is not Status.RUNNING
        _wake_up(self._tree_timers, self.name, self._every_s, hidden=hidden)


def _wake_up(tree_timers: TreeTimers, path: str, every_s: float, *, hidden: bool) -> None:
    """Have a part ticked soon that is RUNNING though its child has ended: nothing below will wake it."""
    if hidden:
        tree_timers.set(path, every_s)
    else:
        tree_timers.drop(path)
