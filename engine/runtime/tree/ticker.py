"""Executes the steps of a tick; it returns to the task of the tree only where it has to wait."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour

from engine.clock import OneTurn
from engine.document.expression.expression_cost import MAX_STEPS
from engine.runtime.nodes.execution import Execution
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.scheduling.eager_task_runner import EagerTaskRunner, Piece
from engine.runtime.tree.active_leaves import ActiveLeaves
from engine.runtime.tree.status_log import StatusLog
from engine.runtime.tree.tree_leaf import TickPause, TreeLeaf

_MOST_IN_A_ROW = 255
"""Consecutive checks before other tasks have a turn."""


class Ticker:
    """Executes the ticks of one activation of a tree.

    Args:
        execution: The execution of the run.
        leaves: The active leaves.
        at_turn: The step at which a check begins, or halted leaves have to confirm first.
        statuses: Records the status of each ticked node.
    """

    def __init__(self, execution: Execution, leaves: ActiveLeaves, at_turn: TickPause, statuses: StatusLog) -> None:
        self._execution = execution
        self._leaves = leaves
        self._at_turn = at_turn
        self._statuses = statuses
        self._runner = EagerTaskRunner[NodeExit](execution.activity, execution.loop, self._next_piece)
        self._steps: Iterator[Behaviour] = iter(())
        self._over = True
        self._deferred: Behaviour | None = None
        """A step that is deferred until other tasks have had a turn."""
        self._check: TreeLeaf | None = None
        """The check that begins at once, or the last one that did."""
        self._in_a_row = 0
        """Number of checks begun since other tasks had a turn."""

    async def tick(self, steps: Iterator[Behaviour]) -> None:
        """Execute the steps that py_trees yields.

        Checks begin inside the tick. Steps after a check that ends at once run in the task of that check.

        Raises:
            FlexcellError: a step raised it, or a clean-up of a halted leaf failed.
        """
        self._steps, self._over = steps, False
        try:
            piece = self._next_piece()
            while not self._over:
                piece = await (self._after_pending() if piece is None else self._run(piece))
        finally:
            # Between ticks no idle task may count as waiting.
            self._runner.close()
            self._check = None

    async def _run(self, piece: Piece[NodeExit]) -> Piece[NodeExit] | None:
        """Run a check and the following steps; return the next check that may begin."""
        task, check = self._runner.run(piece), self._check
        if task is None or check is None:
            return None
        await self._leaves.settled(check.follow(task))
        return self._next_piece()

    def _next_piece(self, left: NodeExit | None = None) -> Piece[NodeExit] | None:
        """Advance to the next check that may begin at once; None at the end, or where a wait is due first.

        Args:
            left: The exit of the last check, if it ended at once.
        """
        execution, at_turn = self._execution, self._at_turn
        at_turn.left = left
        for step in self._steps:
            if execution.steps > MAX_STEPS:
                self._deferred = step
                return None
            if step is at_turn:
                if self._leaves.halted or self._in_a_row >= _MOST_IN_A_ROW:
                    return None
                if at_turn.check is not None:
                    self._in_a_row += 1
                    return self._begin(at_turn.check)
            elif step.__class__ is not TreeLeaf:
                self._statuses.note(step)
        self._over = True
        return None

    async def _after_pending(self) -> Piece[NodeExit] | None:
        """Wait for pending turns and clean-ups; return the check that may begin then."""
        deferred, self._deferred = self._deferred, None
        if deferred is not None:
            await self._execution.yield_turn()
            if deferred is not self._at_turn:
                self._statuses.note(deferred)
                return self._next_piece()
        await self._leaves.confirm()
        check = self._at_turn.check
        if check is None:
            return self._next_piece()
        if self._in_a_row >= _MOST_IN_A_ROW:
            await OneTurn()
            self._in_a_row = 0
        else:
            self._in_a_row += 1
        return self._begin(check)

    def _begin(self, check: TreeLeaf) -> Piece[NodeExit]:
        self._at_turn.check, self._check = None, check
        node = check.plan.node
        self._leaves.begun.append(node.path)
        return node.path, node.perform(check.place.scope, self._execution)
