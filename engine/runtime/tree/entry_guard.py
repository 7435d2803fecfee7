"""Guard of a composite, decorator or py_trees behaviour, evaluated before it begins and not while it runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.runtime.tree.skipped_nodes import SkippedNodes


class EntryGuard:
    """Wraps the ticks of one node; a closed guard gives the node the status of its target without a tick.

    Args:
        part: The guarded node.
        keys: The userdata keys and parameters that the condition reads.
        holds: Evaluates the condition; may raise FlexcellError.
        text: The condition as written.
        to: success, failure or skipped.
        skips: Records whether the node is skipped.
    """

    def __init__(
        self,
        part: Behaviour,
        *,
        keys: frozenset[str],
        holds: Callable[[], bool],
        text: str,
        to: str,
        skips: SkippedNodes,
    ) -> None:
        self.keys = keys
        self.holds = holds
        self.last_value: bool | None = None
        """False where it was closed in the current or last tick; else None."""
        self.refusal = ""
        """Reason of a failure by this guard; else empty."""
        self._part = part
        self._text = text
        self._to = to
        self._skips = skips
        self._tick = part.tick
        vars(part)["tick"] = self.tick

    def tick(self) -> Iterator[Behaviour]:
        """Evaluate the guard, unless the node is RUNNING; then tick the node."""
        part, self.refusal = self._part, ""
        if part.status is Status.RUNNING or self.holds():
            self._skips.run(part)
            yield from self._tick()
            return
        self.last_value = False
        for child in part.children:
            if child.status is not Status.INVALID:
                child.stop(Status.INVALID)
        self.refusal = f"{self._text} is false" if self._to == "failure" else ""
        part.status = self._skips.closed(part, self._to)
        yield part
