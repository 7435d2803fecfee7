"""A state or container as a leaf of a py_trees tree: RUNNING while it runs, then its outcome."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from uuid import UUID

from py_trees.behaviour import Behaviour
from py_trees.common import BlackBoxLevel, Status
from py_trees.logging import Logger

from engine.runtime.record.node_exit import NodeExit
from engine.runtime.tree.active_leaves import ActiveLeaves, TreeLeafActivation
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.status_log import StatusLog
from engine.runtime.tree.tree_node import LeafPlan
from engine.runtime.userdata.userdata import Scope

_SUCCESS, _FAILURE, _RUNNING, _INVALID = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID
"""Module constants: in Python 3.11 the lookup of an enumeration member costs more than the rest of a leaf's status."""


class TickPause(Behaviour):
    """Step that a tick yields where it has to wait: for clean-up of halted leaves, and for `check`."""

    def __init__(self) -> None:
        super().__init__("turn")
        self.check: TreeLeaf | None = None
        self.left: NodeExit | None = None
        """The exit of a check that ended at once, until its tick continues."""

    def update(self) -> Status:
        """Return INVALID; this step is never ticked."""
        return Status.INVALID


class TreeLeaf(Behaviour):
    """One leaf of a tree.

    It skips the constructor of py_trees, which creates an id, a logger and an iterator: trees are rebuilt in each
    activation, and these cost more than running a leaf that ends at once. Nothing is looked up by id here.

    Args:
        plan: Its node and the outcomes that are SUCCESS.
        place: Access to its scope.
        leaves: The active leaves of this tree.
        turn: The step that the tick yields to start a check.
        statuses: Records its end, its halt, and the reset of an end.
        rank: Its position in document order.
        caught: Whether a decorator around it handles its errors.
    """

    id = UUID(int=0)
    logger = Logger("leaf")
    blackbox_level = BlackBoxLevel.NOT_A_BLACKBOX
    feedback_message = ""
    children = []
    stale = False
    """Whether its status may have changed."""

    def __init__(
        self,
        plan: LeafPlan,
        place: ScopeAccess,
        leaves: ActiveLeaves,
        turn: TickPause,
        statuses: StatusLog,
        rank: int,
        *,
        caught: bool,
    ) -> None:
        # All attributes are set here: an attribute added later costs a separate dictionary.
        self.name = plan.node.name
        self.status = _INVALID
        self.parent = None
        self.plan = plan
        self.place = place
        self.left: NodeExit | None = None
        """Its last exit."""
        self.reported = _INVALID
        """Its status when it last ran or was observed."""
        self._leaves = leaves
        self._turn = turn
        self._statuses = statuses
        self._rank = rank
        self._caught = caught
        self._activation: TreeLeafActivation | None = None
        """Its activation while it is active, unless it ends at once."""
        self._counted = False
        """Whether an earlier end was valid when the current activation was requested."""

    def tick(self) -> Iterator[Behaviour]:
        """Request an activation where none is active, then yield the status."""
        turn = self._turn
        if self._activation is None:
            if self.plan.check:
                turn.check = self
                yield turn
            else:
                self._leaves.ask(self._activate())
        left, passed = turn.left, False
        if left is not None:
            turn.left = None
        else:
            passed = self._activation is not None and self._activation.passed
            left = self._read()
        if left is None:
            self.status = _RUNNING
        else:
            self._end(left)
            if passed:
                self._statuses.read(self, self.plan.node.path)
            self._statuses.end(self)
        yield self

    def follow(self, task: asyncio.Task[NodeExit]) -> TreeLeafActivation:
        """Activate it as a check that runs in this task."""
        activation = self._activate()
        self._leaves.follow(activation, task)
        return activation

    def update(self) -> Status:
        """Return the current status; `tick` does the work."""
        return self.status

    def stop(self, new_status: Status) -> None:
        """Halt the leaf if it is active."""
        activation, self._activation = self._activation, None
        if activation is None:
            counted = self.status is not _INVALID
        else:
            self._leaves.halt(activation)
            # An activation that never started recorded nothing; an earlier end remains valid.
            counted = activation.begun or self._counted
        if counted:
            self._statuses.reset(self.plan.node.path)
        self.status = new_status

    def go_on(self) -> None:
        """Resume an interrupted activation without a tick."""
        self._leaves.ask(self._activate())
        self.status = _RUNNING

    def keep(self, left: NodeExit, *, passed: bool) -> None:
        """Restore an unread exit, which the next tick reads; `passed` if a tick did not reach it."""
        self._activation = TreeLeafActivation(
            self.plan, self.place, self._rank, self._caught, restored=left, passed=passed
        )
        self._leaves.keep(self._activation)
        self.status = _RUNNING

    def restore(self, left: NodeExit) -> None:
        """Restore an exit that was already read."""
        self._end(left)
        # Its inputs may have changed meanwhile.
        self.stale = self.plan.every_s is not None or bool(self.plan.reads)

    @property
    def begun(self) -> bool:
        """Whether it is active and has begun."""
        return self._activation is not None and self._activation.task is not None

    @property
    def scope(self) -> Scope:
        """The current scope."""
        return self.place.scope

    def status_of(self, left: NodeExit) -> Status:
        """Return the status of an exit."""
        if left.target is None:
            return _SUCCESS if left.outcome in self.plan.success else _FAILURE
        if left.target == "skipped":
            return self._statuses.skips.passing(self)
        return _SUCCESS if left.target == "success" else _FAILURE

    def _activate(self) -> TreeLeafActivation:
        self._counted = self.status is not _INVALID
        self._activation = TreeLeafActivation(self.plan, self.place, self._rank, self._caught)
        return self._activation

    def _read(self) -> NodeExit | None:
        activation = self._activation
        assert activation is not None, "it is active"
        try:
            left = self._leaves.read(activation)
        except BaseException:
            # It has ended with this exception and starts again at its next tick.
            self._activation = None
            raise
        if left is not None:
            self._activation = None
        return left

    def _end(self, left: NodeExit) -> None:
        self.left = left
        self.status = self.reported = self.status_of(left)
        skips = self._statuses.skips
        if left.target == "skipped":
            skips.skip(self)
        elif skips.skipped:
            skips.run(self)
        if self.stale:
            self.stale = False
