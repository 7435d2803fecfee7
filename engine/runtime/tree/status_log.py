"""Records when the status of a composite, decorator or foreign behaviour of one tree has changed.

Leaves tell themselves that they were entered and left. Of them `invalid` is recorded, when they are halted or reset,
and `running` when they have ended and the tick that follows does not come to them, below a `while_do_else` whose
condition is RUNNING; then their status as well, when one comes to them.
With that the log holds what `engine.runtime.tree.tree_history` needs to go on from there.
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
    """What was recorded last, by behaviour; belongs to one activation of a tree."""

    def __init__(self, execution: Execution) -> None:
        self._recorder = execution.recorder
        self._paths: dict[Behaviour, str] = {}
        self._recorded: dict[Behaviour, Status | None] = {}
        """None for those that were skipped."""
        self.skips = SkippedNodes()
        self._ended_below: set[Behaviour] = set()
        """Those below which something has ended since their own status was recorded."""
        self.closing = False
        """Whether the tree comes to an end without a status: then only what was RUNNING is told."""

    def follow(self, behaviour: Behaviour, path: str) -> None:
        """Record the changes of a behaviour from now on."""
        self._paths[behaviour] = path
        self._recorded[behaviour] = Status.INVALID
        # py_trees yields what it has ticked but not what it has halted; this is where it tells that.
        vars(behaviour)["terminate"] = partial(self._terminate, behaviour, behaviour.terminate)

    def take(self, behaviour: Behaviour) -> None:
        """Count the present status as recorded."""
        self._recorded[behaviour] = self._present(behaviour)

    def repeat(self, behaviour: Behaviour) -> None:
        """Record that one that is RUNNING begins a further round."""
        if self._recorded[behaviour] is not Status.RUNNING:
            self._record(behaviour, Status.RUNNING)
        self._record(behaviour, Status.RUNNING)

    def end(self, behaviour: Behaviour) -> None:
        """Take note that a leaf or part has ended: what ends with it is recorded, also with the status it had."""
        above = behaviour.parent
        while above is not None:
            self._ended_below.add(above)
            above = above.parent

    def reset(self, path: str) -> None:
        """Record that a leaf is halted, or that its end counts no more as what is around it begins anew."""
        if not self.closing:
            self._tell(path, Status.INVALID)

    def pass_over(self, path: str) -> None:
        """Record that a leaf has ended and is RUNNING for the tree: a tick has followed that did not come to it."""
        self._tell(path, Status.RUNNING)

    def read(self, leaf: Behaviour, path: str) -> None:
        """Record how a leaf has ended that was passed over, now that a tick has come to it."""
        self._tell(path, self._present(leaf))

    def note(self, behaviour: Behaviour) -> None:
        """Record the status of one that was just ticked, if it has changed, or has come about anew."""
        status = self._present(behaviour) if self.skips else behaviour.status
        ended = status is not Status.RUNNING
        anew = ended and behaviour in self._ended_below
        if anew or self._recorded.get(behaviour, status) is not status:
            self._record(behaviour, status)
            self._ended_below.discard(behaviour)
            if ended:
                self.end(behaviour)

    def _present(self, behaviour: Behaviour) -> Status | None:
        return None if behaviour in self.skips else behaviour.status

    def _terminate(self, behaviour: Behaviour, own: Callable[[Status], None], new_status: Status) -> None:
        own(new_status)
        before = self._recorded[behaviour]
        if new_status is Status.INVALID and before is not new_status and (before is Status.RUNNING or not self.closing):
            self._record(behaviour, new_status)

    def _record(self, behaviour: Behaviour, status: Status | None) -> None:
        self._recorded[behaviour] = status
        self._tell(self._paths[behaviour], status)

    def _tell(self, path: str, status: Status | None) -> None:
        said = status.value.lower() if status is not None else "skipped"
        self._recorder.emit(StatusChanged, path=path, status=said)
