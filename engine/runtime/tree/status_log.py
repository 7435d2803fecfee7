"""Records status changes of composites, decorators and foreign behaviours of one tree.

Leaves record their own entries and exits. For leaves this log records `invalid`, when they are halted or reset,
`running`, when they have ended and the following tick does not reach them, below a `while_do_else` whose condition is
RUNNING, and then their status, when a tick reaches them. With that the event log holds everything that
`engine.runtime.tree.tree_history` needs to resume the tree.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.event import StatusChanged
from engine.runtime.nodes.execution import Execution
from engine.runtime.tree.skipped_nodes import SkippedNodes


class StatusLog:
    """The last recorded status of each behaviour; belongs to one activation of a tree."""

    def __init__(self, execution: Execution) -> None:
        self._recorder = execution.recorder
        self._paths: dict[Behaviour, str] = {}
        self._recorded: dict[Behaviour, Status | None] = {}
        """None for skipped nodes."""
        self.skips = SkippedNodes()
        self._ended_below: set[Behaviour] = set()
        """Nodes below which a node has ended since their own status was recorded."""
        self.closing = False
        """Whether the tree ends without a status: then only nodes that were RUNNING are recorded."""

    def follow(self, behaviour: Behaviour, path: str) -> None:
        """Record the status changes of a behaviour."""
        self._paths[behaviour] = path
        self._recorded[behaviour] = Status.INVALID
        # py_trees yields ticked nodes but not halted ones; it calls `terminate` on those.
        vars(behaviour)["terminate"] = partial(self._terminate, behaviour, behaviour.terminate)

    def take(self, behaviour: Behaviour) -> None:
        """Take the current status as recorded."""
        self._recorded[behaviour] = self._current(behaviour)

    def repeat(self, behaviour: Behaviour) -> None:
        """Record that a RUNNING node begins another round."""
        if self._recorded[behaviour] is not Status.RUNNING:
            self._record(behaviour, Status.RUNNING)
        self._record(behaviour, Status.RUNNING)

    def end(self, behaviour: Behaviour) -> None:
        """Register the end of a node: parents that end with it are recorded, also with an unchanged status."""
        above = behaviour.parent
        while above is not None:
            self._ended_below.add(above)
            above = above.parent

    def reset(self, path: str) -> None:
        """Record that a leaf is halted, or that its end is void as its parent starts again."""
        if not self.closing:
            self._emit(path, Status.INVALID)

    def pass_over(self, path: str) -> None:
        """Record that an ended leaf is RUNNING for the tree: the following tick did not reach it."""
        self._emit(path, Status.RUNNING)

    def read(self, leaf: Behaviour, path: str) -> None:
        """Record the status of a passed-over leaf, once a tick reaches it."""
        self._emit(path, self._current(leaf))

    def note(self, behaviour: Behaviour) -> None:
        """Record the status of a ticked node, if it has changed or results from a new end below."""
        status = self._current(behaviour) if self.skips else behaviour.status
        ended = status is not Status.RUNNING
        is_new_end = ended and behaviour in self._ended_below
        if is_new_end or self._recorded.get(behaviour, status) is not status:
            self._record(behaviour, status)
            self._ended_below.discard(behaviour)
            if ended:
                self.end(behaviour)

    def _current(self, behaviour: Behaviour) -> Status | None:
        return None if behaviour in self.skips else behaviour.status

    def _terminate(self, behaviour: Behaviour, own: Callable[[Status], None], new_status: Status) -> None:
        own(new_status)
        before = self._recorded[behaviour]
        if new_status is Status.INVALID and before is not new_status and (before is Status.RUNNING or not self.closing):
            self._record(behaviour, new_status)

    def _record(self, behaviour: Behaviour, status: Status | None) -> None:
        self._recorded[behaviour] = status
        self._emit(self._paths[behaviour], status)

    def _emit(self, path: str, status: Status | None) -> None:
        text = status.value.lower() if status is not None else "skipped"
        self._recorder.emit(StatusChanged, path=path, status=text)
