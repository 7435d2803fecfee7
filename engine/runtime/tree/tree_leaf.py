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
"""To look up a member of an enumeration costs more, in Python 3.11, than all else that a leaf tells of itself."""


class TickPause(Behaviour):
    """What a tick yields where it has to wait: for clean-up of what it halted, and for `check`."""

    def __init__(self) -> None:
        super().__init__("turn")
        self.check: TreeLeaf | None = None
        self.left: NodeExit | None = None
        """How that has ended on the spot, until its tick goes on."""

    def update(self) -> Status:
        """Never be ticked."""
        return Status.INVALID


class TreeLeaf(Behaviour):
    """One leaf.

    It does without the constructor of py_trees, which makes an id, a logger and an iterator for each: trees grow anew
    in each activation, and these cost more than to run a leaf that ends at once. Nothing is looked up by id here.

    Args:
        plan: What it runs and which outcomes are SUCCESS.
        place: Where it reads and writes.
        leaves: Those that are active in this tree.
        turn: What the tick yields to have a check begin.
        statuses: Told when it has ended, and when it is halted or an end of it counts no more.
        rank: Its place in the document.
        caught: Whether a decorator around it takes its errors.
    """

    id = UUID(int=0)
    logger = Logger("leaf")
    blackbox_level = BlackBoxLevel.NOT_A_BLACKBOX
    feedback_message = ""
    children = []
    stale = False
    """Whether it may end otherwise now."""

    def __init__(
        self,
        plan: LeafPlan,
        place: ScopeAccess,
        leaves: ActiveLeaves,
        turn: TickPause,
        statuses: StatusLog,
        rank: int,
        caught: bool,
    ) -> None:
        # All that a leaf sets later is set here: a name that comes later costs a dictionary of its own.
        self.name = plan.node.name
        self.status = _INVALID
        self.parent = None
        self.plan = plan
        self.place = place
        self.left: NodeExit | None = None
        """How it ended last."""
        self.said = _INVALID
        """How it ended when it was last run or observed."""
        self._leaves = leaves
        self._turn = turn
        self._statuses = statuses
        self._rank = rank
        self._caught = caught
        self._activation: TreeLeafActivation | None = None
        """While it is active, unless that is over on the spot."""
        self._counted = False
        """Whether an earlier end counted when the present activation was asked for."""

    def tick(self) -> Iterator[Behaviour]:
        """Begin when it is not active, then tell how it stands."""
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
        """Be active, as a check, in this task, in which it has begun."""
        activation = self._activate()
        self._leaves.follow(activation, task)
        return activation

    def update(self) -> Status:
        """Return the present status; `tick` does the work."""
        return self.status

    def stop(self, new_status: Status) -> None:
        """Halt it if it is active."""
        activation, self._activation = self._activation, None
        if activation is None:
            counted = self.status is not _INVALID
        else:
            self._leaves.halt(activation)
            # One that never began has told nothing; what it had told before still counts.
            counted = activation.begun or self._counted
        if counted:
            self._statuses.reset(self.plan.node.path)
        self.status = new_status

    def go_on(self) -> None:
        """Be at work again, without a tick, in place of an activation that was cut."""
        self._leaves.ask(self._activate())
        self.status = _RUNNING

    def keep(self, left: NodeExit, *, passed: bool) -> None:
        """Have ended so in an activation that was cut, and wait for a tick to read it; `passed` if one has not come."""
        self._activation = TreeLeafActivation(
            self.plan, self.place, self._rank, self._caught, restored=left, passed=passed
        )
        self._leaves.keep(self._activation)
        self.status = _RUNNING

    def restore(self, left: NodeExit) -> None:
        """Have ended so, in an activation that was read before."""
        self._end(left)
        # Nobody knows what has changed meanwhile.
        self.stale = self.plan.every_s is not None or bool(self.plan.reads)

    @property
    def begun(self) -> bool:
        """Whether it is at work and has begun."""
        return self._activation is not None and self._activation.task is not None

    @property
    def scope(self) -> Scope:
        """Where it reads and writes at present."""
        return self.place.scope

    def status_of(self, left: NodeExit) -> Status:
        """Return what it means in the tree to end so."""
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
            # It has ended with this, whatever it is, and begins anew when it is ticked again.
            self._activation = None
            raise
        if left is not None:
            self._activation = None
        return left

    def _end(self, left: NodeExit) -> None:
        self.left = left
        self.status = self.said = self.status_of(left)
        skips = self._statuses.skips
        if left.target == "skipped":
            skips.skip(self)
        elif skips.skipped:
            skips.run(self)
        if self.stale:
            self.stale = False
