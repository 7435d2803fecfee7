"""Records how the children of a container ended, to explain the outcome of the container.

An outcome may be nominal for its node and a failure of an outer container: `not_found`, led to `failed`. Events hold no
cause for it, as nothing has failed yet; once an outer container fails, its cause chain still reaches this outcome.
"""

from __future__ import annotations

from collections.abc import Collection

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.runtime.nodes.node import Node
from engine.runtime.record.node_exit import ContainerOutcome, NodeExit


class Diagnosis:
    """Collects the exits of the children during one visit of a container.

    Args:
        cause: The last failure before, in a resumed run.
        reason: The last reason of its course before.
    """

    def __init__(self, cause: Cause | None = None, reason: Cause | None = None) -> None:
        self.cause = cause
        self._reason: Cause | tuple[Node, NodeExit] | None = reason
        self._is_decided = reason is not None

    @property
    def reason(self) -> Cause | None:
        """The exit of the last child that failed or had a choice; without any, of the child that ended last."""
        return explain_exit(*self._reason) if isinstance(self._reason, tuple) else self._reason

    def take(self, child: Node, left: NodeExit) -> None:
        """Take the exit of a child."""
        if left.outcome in child.expected and left.cause is None and left.target is None:
            # Fast path: nearly all exits.
            if not self._is_decided:
                self._reason = (child, left)
        elif is_failure(child, left):
            self.cause = self._reason = explain_exit(child, left)
            self._is_decided = True
        elif _has_chosen(child, left):
            self._reason, self._is_decided = (child, left), True
        elif not self._is_decided:
            self._reason = (child, left)

    def outcome(self, name: str, nominal: Collection[str]) -> ContainerOutcome:
        """Return the outcome of the container."""
        return ContainerOutcome(name, cause=None if name in nominal else self.cause, reason=self.reason)


def explain_exit(child: Node, left: NodeExit) -> Cause:
    """Return the cause of a container outcome that follows from this exit of a child."""
    message = f"{child.name} ended with {left.outcome}" if left.outcome else f"{child.name} was left for {left.target}"
    return wrap_cause(message, left.cause or left.reason, where=child.path)


def is_failure(child: Node, left: NodeExit) -> bool:
    """Return whether a child has failed: its exit has a cause or a non-nominal outcome."""
    return left.cause is not None or bool(left.outcome and left.outcome not in child.work.nominal)


def _has_chosen(child: Node, left: NodeExit) -> bool:
    """Return whether another nominal exit of the child leads to a different target; always true for a guard."""
    return left.target is not None or child.has_choice
