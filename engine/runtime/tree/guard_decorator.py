"""The decorator that ticks its child only while an expression is true, and the evaluation of such expressions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.document.expression.expression import Template
from engine.errors import ExpressionError, StateError
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.skipped_nodes import SkippedNodes
from engine.runtime.tree.tree_decorator import TreeDecorator
from engine.runtime.tree.tree_node import TreeNode


class Guard(TreeDecorator):
    """Ticks its child only while a condition holds; otherwise stops it and takes the status of its target.

    Args:
        path: Its node path.
        child: The guarded node.
        keys: The userdata keys and parameters that the condition reads.
        holds: Evaluates the condition; may raise FlexcellError.
        text: The condition as written.
        to: success, failure or skipped, where the condition does not hold.
        skips: Records whether the node is skipped.
    """

    def __init__(
        self,
        path: str,
        child: Behaviour,
        *,
        keys: frozenset[str],
        holds: Callable[[], bool],
        text: str,
        to: str,
        skips: SkippedNodes,
    ) -> None:
        super().__init__(path, child)
        self.keys = keys
        self.holds = holds
        self.last_value: bool | None = None
        """Value of the condition in the current or last tick; None where it was not evaluated."""
        self._text = text
        self._to = to
        self._skips = skips

    def tick(self) -> Iterator[Behaviour]:
        """Evaluate the condition, then tick the child or stop it."""
        self.last_value = self.holds()
        if self.last_value:
            yield from super().tick()
            return
        self.refusal = f"{self._text} is false"
        self.stop(self._skips.closed(self, self._to))
        yield self

    def update(self) -> Status:
        """Return the status of the child."""
        self.refusal = ""
        return self.decorated.status


def guard_condition(part: TreeNode) -> Template:
    """Return the condition of the guard of a node."""
    if part.when is None:
        raise StateError("the guard has no condition", where=part.position)
    return part.when


def holds_in(part: TreeNode, place: ScopeAccess) -> Callable[[], bool]:
    """Return the evaluation of the condition of a guard; it raises FlexcellError where that is not possible."""
    return partial(_holds, guard_condition(part), place, part.position)


def _holds(when: Template, place: ScopeAccess, position: str) -> bool:
    value = when.evaluate({name: place.scope.read(name, reader=position) for name in when.names})
    if not isinstance(value, bool):
        message = f"the guard evaluates to {value!r}, which is not a boolean"
        raise ExpressionError(message, where=position, hint="use a comparison")
    return value
