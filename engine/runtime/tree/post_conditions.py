"""Post-conditions of a tree node: userdata assigned when the node has ended or was halted."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.cause_chain import cause_of, describe_cause
from engine.errors import FlexcellError
from engine.runtime.nodes.execution import Execution
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.status_log import StatusLog
from engine.runtime.tree.tree_leaf import TreeLeaf
from engine.runtime.tree.tree_node import TreeNode

_KEYS = {Status.SUCCESS: "on_success", Status.FAILURE: "on_failure"}


class PostConditions:
    """Wraps the ticks and stops of one node; as in BehaviorTree.CPP 4 a skipped node assigns nothing.

    Assignments are made in document order; each reads the writes of earlier ones.

    Args:
        node: The py_trees node.
        part: The planned tree node.
        place: Access to its scope.
        execution: The execution of the run.
        statuses: Holds the skipped nodes, and whether the tree ends without a status.
    """

    def __init__(
        self, node: Behaviour, part: TreeNode, place: ScopeAccess, execution: Execution, statuses: StatusLog
    ) -> None:
        self.made: dict[str, int] = {}
        """Number of assignments already made in an interrupted activation, by `on_success` and so on."""
        self._node = node
        self._part = part
        self._place = place
        self._execution = execution
        self._statuses = statuses
        self._tick = node.tick
        self._stop = node.stop
        vars(node)["tick"] = self.tick
        vars(node)["stop"] = self.stop

    def tick(self) -> Iterator[Behaviour]:
        """Tick the node, and assign when it has ended."""
        if self._node.status is not Status.RUNNING:
            self.made.clear()
        for step in self._tick():
            if step is self._node:
                # Its end is recorded first: an activation resumed from here makes the remaining assignments.
                self._statuses.note(step)
                self.conclude()
            yield step

    def conclude(self) -> None:
        """Make the assignments for the end of the node, if it has ended."""
        key = _KEYS.get(self._node.status)
        if key is not None and self._node not in self._statuses.skips:
            self._assign(key)
            self._assign("always")

    def stop(self, new_status: Status) -> None:
        """Stop the node, and assign if this halts it."""
        node = self._node
        begun = node.begun if isinstance(node, TreeLeaf) else node.status is Status.RUNNING
        if begun and new_status is Status.INVALID:
            # Before the halt is recorded: an activation resumed from there has no assignments left.
            self._halted()
        self._stop(new_status)

    def _halted(self) -> None:
        try:
            self._assign("on_halted")
        except FlexcellError as error:
            if not self._statuses.closing:
                raise
            # The error that ends the tree propagates; this one is only logged.
            message = f"post-condition failed: {describe_cause(cause_of(error))}"
            self._execution.recorder.log(self._part.path, message, level="error")

    def _assign(self, when: str) -> None:
        for key, value in islice(self._part.post[when], self.made.pop(when, 0), None):
            scope, position = self._place.scope, self._part.position
            with self._execution.counted():
                given = value.evaluate({name: scope.read(name, reader=position) for name in value.names})
            self._execution.write(self._part.path, scope, key, given, post=when)
