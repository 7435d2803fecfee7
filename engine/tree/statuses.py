"""Records when the status of a composite, decorator or foreign behaviour of one tree has changed."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from engine.event import StatusChanged
from engine.execution import Execution


class Statuses:
    """What was recorded last, by behaviour; belongs to one activation of a tree."""

    def __init__(self, execution: Execution) -> None:
        self._recorder = execution.recorder
        self._paths: dict[Behaviour, str] = {}
        self._recorded: dict[Behaviour, Status] = {}

    def follow(self, behaviour: Behaviour, path: str) -> None:
        """Record the changes of a behaviour from now on."""
        self._paths[behaviour] = path
        self._recorded[behaviour] = Status.INVALID
        # py_trees yields what it has ticked but not what it has halted; this is where it tells that.
        vars(behaviour)["terminate"] = partial(self._terminate, behaviour, behaviour.terminate)

    def note(self, behaviour: Behaviour) -> None:
        """Record the status of one that was just ticked, if it has changed."""
        if self._recorded.get(behaviour, behaviour.status) is not behaviour.status:
            self._record(behaviour, behaviour.status)

    def _terminate(self, behaviour: Behaviour, own: Callable[[Status], None], new_status: Status) -> None:
        own(new_status)
        if new_status is Status.INVALID and self._recorded[behaviour] is not new_status:
            self._record(behaviour, new_status)

    def _record(self, behaviour: Behaviour, status: Status) -> None:
        self._recorded[behaviour] = status
        recorder = self._recorder
        recorder.record(
            StatusChanged(
                seq=recorder.next_seq(),
                time_s=recorder.now_s(),
                path=self._paths[behaviour],
                status=status.value.lower(),
            )
        )
