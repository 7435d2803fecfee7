"""py_trees' Parallel with a userdata scope for each branch, merged in document order when it ends."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from engine.concurrency import branch_scope, merge
from engine.execution import Execution
from engine.tree.place import Place


class Parallel(composites.Parallel):
    """Branches do not see what the others write until the parallel has ended, as in a concurrency container.

    Args:
        path: Its node path.
        policy: Whose success is its own.
        children: The branches.
        places: Where each branch reads and writes, by name, in document order.
        outside: Where the parallel itself stands.
        execution: The run.
    """

    def __init__(
        self,
        path: str,
        policy: ParallelPolicy.Base,
        children: Sequence[Behaviour],
        *,
        places: Mapping[str, Place],
        outside: Place,
        execution: Execution,
    ) -> None:
        super().__init__(path, policy, children)
        self._places = places
        self._outside = outside
        self._execution = execution

    def initialise(self) -> None:
        """Give each branch a scope of its own."""
        for name, place in self._places.items():
            place.scope = branch_scope(self.name, name, self._outside.scope, {})

    def restore(self, written: Mapping[str, Mapping[str, object]]) -> None:
        """Give each branch the scope it had, by the path of the branch."""
        for name, place in self._places.items():
            values = written.get(f"{self.name}/{name}", {})
            place.scope = branch_scope(self.name, name, self._outside.scope, values)

    def terminate(self, new_status: Status) -> None:
        """Merge what was written, unless the parallel was halted."""
        if new_status is not Status.INVALID:
            for place in self._places.values():
                merge(place.scope, self._outside.scope, self._execution)
