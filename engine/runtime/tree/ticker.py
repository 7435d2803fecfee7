"""Goes through the steps of a tick; only where something has to be waited for does it come back to the tree's task."""

from __future__ import annotations

from collections.abc import Iterator

from py_trees.behaviour import Behaviour

from engine.clock import OneTurn
from engine.document.expression_cost import MAX_STEPS
from engine.runtime.nodes.execution import Execution
from engine.runtime.record.node_exit import NodeExit
from engine.runtime.scheduling.eager_task_runner import EagerTaskRunner, Piece
from engine.runtime.tree.active_leaves import ActiveLeaves
from engine.runtime.tree.status_log import StatusLog
from engine.runtime.tree.tree_leaf import TickPause, TreeLeaf

_MOST_IN_A_ROW = 255
"""Checks that begin in a row before everybody else has a turn."""


class Ticker:
    """Belongs to one activation of a tree.

    Args:
        execution: The run.
        leaves: Those that are active.
        at_turn: What is among the steps where a check is to begin, or where what was halted has to confirm first.
        statuses: Told of each part that was ticked.
    """

    def __init__(self, execution: Execution, leaves: ActiveLeaves, at_turn: TickPause, statuses: StatusLog) -> None:
        self._execution = execution
        self._leaves = leaves
        self._at_turn = at_turn
        self._statuses = statuses
        self._carrier = EagerTaskRunner[NodeExit](execution.activity, execution.loop, self._next_piece)
        self._steps: Iterator[Behaviour] = iter(())
        self._over = True
        self._late: Behaviour | None = None
        """A step that is due once everybody else has had a turn."""
        self._check: TreeLeaf | None = None
        """The one that begins on the spot, or did so last."""
        self._in_a_row = 0
        """How many checks have begun since everybody else had a turn."""

    async def tick(self, steps: Iterator[Behaviour]) -> None:
        """Go through what py_trees yields.

        The checks on the way begin in it. The steps that follow one that ends at once are gone through where it ran.

        Raises:
            FlexcellError: what a step raises, or a clean-up of what was halted.
        """
        self._steps, self._over = steps, False
        try:
            piece = self._next_piece()
            while not self._over:
                piece = await (self._past_what_is_due() if piece is None else self._run(piece))
        finally:
            # Between ticks nothing stands by that would count among what waits.
            self._carrier.close()
            self._check = None

    async def _run(self, piece: Piece[NodeExit]) -> Piece[NodeExit] | None:
        """Run a check and what follows it; return the next one that may begin."""
        task, check = self._carrier.run(piece), self._check
        if task is None or check is None:
            return None
        await self._leaves.settled(check.follow(task))
        return self._next_piece()

    def _next_piece(self, left: NodeExit | None = None) -> Piece[NodeExit] | None:
        """Go on to the next check that may begin at once; None at the end, and where others are due before.

        Args:
            left: How the last check has ended on the spot.
        """
        execution, at_turn = self._execution, self._at_turn
        at_turn.left = left
        for step in self._steps:
            if execution.steps > MAX_STEPS:
                self._late = step
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

    async def _past_what_is_due(self) -> Piece[NodeExit] | None:
        """Wait for what is due first; return the check that may begin then."""
        late, self._late = self._late, None
        if late is not None:
            await self._execution.yield_turn()
            if late is not self._at_turn:
                self._statuses.note(late)
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
