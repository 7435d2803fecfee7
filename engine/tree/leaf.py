"""A state or container as a leaf of a py_trees tree: RUNNING while its task runs, then its outcome."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.node import Left
from engine.tree.leaves import Activation, Leaves
from engine.tree.part import LeafPlan
from engine.tree.place import Place


class Turn(Behaviour):
    """What a tick yields where it has to wait: for clean-up of what it halted, and for `check`."""

    def __init__(self) -> None:
        super().__init__("turn")
        self.check: Activation | None = None

    def update(self) -> Status:
        """Never be ticked."""
        return Status.INVALID


class TreeLeaf(Behaviour):
    """One leaf.

    Args:
        plan: What it runs and which outcomes are SUCCESS.
        place: Where it reads and writes.
        leaves: Those that are active in this tree.
        turn: What the tick yields to have a check begin.
        rank: Its place in the document.
        caught: Whether a decorator around it takes its errors.
    """

    def __init__(self, plan: LeafPlan, place: Place, leaves: Leaves, turn: Turn, *, rank: int, caught: bool) -> None:
        super().__init__(plan.node.name)
        self.plan = plan
        self.left: Left | None = None
        """How it ended last."""
        self._place = place
        self._leaves = leaves
        self._turn = turn
        self._rank = rank
        self._caught = caught
        self._activation: Activation | None = None

    def tick(self) -> Iterator[Behaviour]:
        """Begin when it is not active, then tell how it stands."""
        activation = self._activation
        if activation is None:
            activation = Activation(self.plan, self._place, rank=self._rank, caught=self._caught)
            self._activation = activation
            self._leaves.ask(activation)
            if self.plan.check:
                self._turn.check = activation
                yield self._turn
        if activation.error is not None:
            self._activation = None
        left = self._leaves.read(activation)
        if left is None:
            self.status = Status.RUNNING
        else:
            self._activation = None
            self.left = left
            self.status = self._status(left)
        yield self

    def update(self) -> Status:
        """Return the present status; `tick` does the work."""
        return self.status

    def stop(self, new_status: Status) -> None:
        """Halt it if it is active."""
        if self._activation is not None:
            self._leaves.halt(self._activation)
            self._activation = None
        self.status = new_status

    def _status(self, left: Left) -> Status:
        succeeded = left.target == "success" if left.target is not None else left.outcome in self.plan.success
        return Status.SUCCESS if succeeded else Status.FAILURE
