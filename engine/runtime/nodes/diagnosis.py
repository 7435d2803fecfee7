"""Records how the children of a container ended, to explain the outcome of the container.

An outcome may be nominal to whoever has it and a failure further out: `not_found`, led to `failed`. Events hold no
cause for it, as nothing has gone wrong yet; once somebody calls it a failure, the chain goes down to it all the same.
"""

from __future__ import annotations

from collections.abc import Collection

from engine.cause_chain import wrap_cause
from engine.event import Cause
from engine.runtime.nodes.node import Node
from engine.runtime.record.node_exit import ContainerOutcome, NodeExit


class Diagnosis:
    """The children of one visit of a container as they end, one after the other.

    Args:
        cause: What had gone wrong last before, where a run is gone on with.
        reason: What had decided its course last.
    """

    def __init__(self, cause: Cause | None = None, reason: Cause | None = None) -> None:
        self.cause = cause
        self._reason: Cause | tuple[Node, NodeExit] | None = reason
        self._is_decided = reason is not None

    @property
    def reason(self) -> Cause | None:
        """The last child that went wrong or had a choice; without any, the one that ended last."""
        return explain_exit(*self._reason) if isinstance(self._reason, tuple) else self._reason

    def take(self, child: Node, left: NodeExit) -> None:
        """Note how a child has ended."""
        if left.outcome in child.expected and left.cause is None and left.target is None:
            # Nearly all that end do so.
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
        """Return how the container ends."""
        return ContainerOutcome(name, cause=None if name in nominal else self.cause, reason=self.reason)


def explain_exit(child: Node, left: NodeExit) -> Cause:
    """Return why a container failed through this child."""
    said = f"{child.name} ended with {left.outcome}" if left.outcome else f"{child.name} was left for {left.target}"
    return wrap_cause(said, left.cause or left.reason, where=child.path)


def is_failure(child: Node, left: NodeExit) -> bool:
    """Tell whether a child has failed: it has a cause, or an outcome that does not mean success to it."""
    return left.cause is not None or bool(left.outcome and left.outcome not in child.work.nominal)


def _has_chosen(child: Node, left: NodeExit) -> bool:
    """Tell whether a child could have ended well and led elsewhere; a guard always could."""
    return left.target is not None or child.has_choice
