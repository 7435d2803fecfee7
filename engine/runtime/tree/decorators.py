"""Decorators that py_trees lacks, or implements with another clock or without a wake-up, and how each is built."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

from py_trees import decorators
from py_trees.behaviour import Behaviour
from py_trees.common import OneShotPolicy, Status

from engine.document.duration import seconds
from engine.document.nodes import node_spec as nodes
from engine.errors import Cause, StateError
from engine.runtime.tree.guard_decorator import Guard, guard_condition, holds_in
from engine.runtime.tree.retry_decorator import Retry
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.status_log import StatusLog
from engine.runtime.tree.timers import TreeTimers
from engine.runtime.tree.tree_decorator import STATUSES, TreeDecorator
from engine.runtime.tree.tree_history import TreeNodeState
from engine.runtime.tree.tree_node import TreeNode

_ONE_SHOT = {"completion": OneShotPolicy.ON_COMPLETION, "success": OneShotPolicy.ON_SUCCESSFUL_COMPLETION}


class Inverter(decorators.Inverter, TreeDecorator):
    """Inverter of py_trees."""

    def explain(self, part: TreeNode, below: Cause | None) -> Cause | None:
        """Return the success of its child."""
        return Cause(message=f"{part.children[0].name} succeeded, which counts as FAILURE", where=part.path)


class OneShot(decorators.OneShot, TreeDecorator):
    """One-shot of py_trees."""

    keeps_end = True

    @property
    def ticks_child(self) -> bool:
        """Whether it keeps no status yet."""
        return self.final_status is None

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Restore the status that it keeps."""
        kept = state.first if self.policy is OneShotPolicy.ON_COMPLETION else state.final
        self.final_status = STATUSES[kept] if kept is not None and STATUSES[kept] in self.policy.value else None


class Timeout(TreeDecorator):
    """Fails when its child does not end in time; a child that ends at that instant is in time."""

    def __init__(self, path: str, child: Behaviour, after_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child)
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

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Resume the timer; if it had elapsed and no tick reaches this node, its tick has already followed."""
        elapsed_s = now_s - state.since_s
        if state.status == "running" and (is_reached or elapsed_s <= self._after_s):
            self._tree_timers.set(self.name, max(0.0, self._after_s - elapsed_s))


class Cooldown(TreeDecorator):
    """Fails without ticking its child until a time has passed since the child last ended or was halted."""

    keeps_end = True

    def __init__(self, path: str, child: Behaviour, after_s: float, tree_timers: TreeTimers) -> None:
        super().__init__(path, child)
        self._after_s = after_s
        self._tree_timers = tree_timers
        self._child_active = False

    @property
    def ticks_child(self) -> bool:
        """Whether it is not cooling down."""
        return not self._tree_timers.pending(self.name)

    def tick(self) -> Iterator[Behaviour]:
        """Tick the child, or fail while cooling down."""
        if self.ticks_child:
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

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Resume the cooldown, where it has not elapsed."""
        self._child_active = state.status == "running"
        ended_s = max(state.ended_s or 0.0, state.since_s if state.first is not None else 0.0)
        left_s = self._after_s - (now_s - ended_s)
        if not self._child_active and left_s > 0 and (state.first is not None or state.ended_s is not None):
            self._tree_timers.set(self.name, left_s)


class Repeat(decorators.Repeat, TreeDecorator):
    """Repeat of py_trees that requests the next tick at once instead of waiting for it."""

    def __init__(
        self, path: str, child: Behaviour, times: int, tree_timers: TreeTimers, report: Callable[[Behaviour], None]
    ) -> None:
        super().__init__(path, child, times)
        self._tree_timers = tree_timers
        self._report = report

    def update(self) -> Status:
        """Count a success and request the next tick."""
        status = super().update()
        if status is Status.RUNNING and self.decorated.status is Status.SUCCESS:
            self._tree_timers.call_again(self.name)
            self._report(self)
        return status

    def terminate(self, new_status: Status) -> None:
        """Drop the request for a tick."""
        self._tree_timers.drop(self.name)

    def reads_end(self, end: Status, *, is_recorded: bool) -> bool:
        """Return whether it has begun no other round yet."""
        return not (is_recorded and end is Status.SUCCESS)

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Restore the number of rounds."""
        self.success = state.rounds


class Remap(TreeDecorator):
    """Maps the status of its child to another; ticked periodically where it hides an end as RUNNING."""

    def __init__(
        self, path: str, child: Behaviour, shown: Mapping[Status, Status], every_s: float, tree_timers: TreeTimers
    ) -> None:
        super().__init__(path, child)
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

    def reads_end(self, end: Status, *, is_recorded: bool) -> bool:
        """Return whether it ends with its child."""
        return self.shown[end] is not Status.RUNNING

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Resume the periodic tick if it is needed."""
        hidden = state.status == "running" and self.decorated.status is not Status.RUNNING
        _schedule_tick(self._tree_timers, self.name, self._every_s, hidden=hidden)


class StatusCondition(decorators.Condition, TreeDecorator):
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

    def reads_end(self, end: Status, *, is_recorded: bool) -> bool:
        """Return whether it has waited for this end."""
        return end is self.succeed_status

    def restore(self, state: TreeNodeState, now_s: float, *, is_reached: bool) -> None:
        """Resume the periodic tick if it is needed."""
        hidden = state.status == "running" and self.decorated.status is not Status.RUNNING
        _schedule_tick(self._tree_timers, self.name, self._every_s, hidden=hidden)


def _schedule_tick(tree_timers: TreeTimers, path: str, every_s: float, *, hidden: bool) -> None:
    """Schedule a tick for a node that is RUNNING although its child has ended: nothing below wakes the tree."""
    if hidden:
        tree_timers.set(path, every_s)
    else:
        tree_timers.drop(path)


@dataclass(frozen=True, kw_only=True)
class DecoratorSite:
    """What a decorator finds in the activation of its tree.

    `clear` halts a subtree whose tick was interrupted by an error; `record_retry` receives the number of the next
    attempt, the wait, and the error before it, if any.
    """

    place: ScopeAccess
    statuses: StatusLog
    tree_timers: TreeTimers
    clear: Callable[[Behaviour], None]
    record_retry: Callable[[int, float, Cause | None], None]


def new_decorator(part: TreeNode, child: Behaviour, site: DecoratorSite) -> TreeDecorator:
    """Return the decorator that a document specifies, around its child."""
    path, tree_timers = part.path, site.tree_timers
    match part.source.decorator:
        case nodes.InverterSpec():
            return Inverter(path, child)
        case nodes.OneShotSpec() as spec:
            return OneShot(path, child, _ONE_SHOT[spec.policy])
        case nodes.RepeatSpec() as spec:
            return Repeat(path, child, spec.times, tree_timers, site.statuses.repeat)
        case nodes.CooldownSpec() as spec:
            return Cooldown(path, child, seconds(spec.after), tree_timers)
        case nodes.RemapSpec() as spec:
            shown = {status: STATUSES[getattr(spec, word)] for word, status in STATUSES.items()}
            return Remap(path, child, shown, seconds(spec.every), tree_timers)
        case nodes.StatusConditionSpec() as spec:
            return StatusCondition(path, child, STATUSES[spec.status], seconds(spec.every), tree_timers)
        case nodes.TimeoutSpec() as spec:
            return Timeout(path, child, spec.after_s, tree_timers)
        case nodes.RetrySpec() as spec:
            return Retry(path, child, spec, tree_timers=tree_timers, clear=site.clear, report=site.record_retry)
        case nodes.GuardSpec() as spec:
            keys, holds, skips = guard_condition(part).names, holds_in(part, site.place), site.statuses.skips
            return Guard(path, child, keys=keys, holds=holds, text=spec.when, to=spec.to or "failure", skips=skips)
        case _:
            raise StateError(f"a tree cannot hold a `{part.source.kind}`", where=part.position)
