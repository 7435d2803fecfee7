"""A native py_trees behaviour in a tree: its exceptions are contained and named.

An exception in one of its methods becomes an error that names the node. Its `terminate` runs at most once for each
`initialise`, also where py_trees would call it twice after an exception.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from functools import partial
from typing import Any, TypeVar

import msgspec
from py_trees.behaviour import Behaviour
from py_trees.blackboard import Blackboard
from py_trees.common import Status

from engine.errors import StateError
from engine.runtime.nodes.error_containment import contain_errors
from engine.runtime.nodes.execution import Execution
from engine.runtime.tree.active_leaves import ActiveLeaves
from engine.runtime.tree.arguments import converted_arguments
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.timers import TreeTimers
from engine.runtime.tree.tree_leaf import TickPause
from engine.runtime.tree.tree_node import ForeignPlan, TreeNode
from engine.runtime.userdata.userdata_value import plain_value

T = TypeVar("T")


class ForeignBehaviour:
    """Creates the behaviour and adapts it to the tree; `behaviour` holds it.

    Args:
        part: Its tree node.
        plan: Its class and arguments.
        place: Access to its userdata scope.
        execution: The execution of the run.
        leaves: The active leaves; halted ones confirm before this behaviour begins.
        tree_timers: Timers for its periodic tick while it is RUNNING.
        turn: The pause that a tick yields until clean-up is confirmed.

    Raises:
        FlexcellError: its constructor raised, or an argument does not fit.
    """

    def __init__(
        self,
        part: TreeNode,
        plan: ForeignPlan,
        place: ScopeAccess,
        *,
        execution: Execution,
        leaves: ActiveLeaves,
        tree_timers: TreeTimers,
        turn: TickPause,
    ) -> None:
        self._part = part
        self._plan = plan
        self._place = place
        self._execution = execution
        self._leaves = leaves
        self._tree_timers = tree_timers
        self._turn = turn
        self._open: set[Behaviour] = set()
        self.behaviour = self._create()
        self._tick = self.behaviour.tick
        for inner in self.behaviour.iterate():
            vars(inner)["initialise"] = partial(self._initialise, inner, inner.initialise)
            vars(inner)["update"] = partial(self._update, inner.update)
            vars(inner)["terminate"] = partial(self._terminate, inner, inner.terminate)
        vars(self.behaviour)["tick"] = self.tick

    @property
    def reads(self) -> Collection[str]:
        """The userdata keys that it reads."""
        return self._plan.inputs.values()

    def set_up(self) -> None:
        """Call `setup` of the behaviour and its children once, before the first tick."""
        for inner in self.behaviour.iterate():
            self._contain("setup", inner.setup)

    def shut_down(self) -> None:
        """Call `shutdown` of the behaviour and its children."""
        for inner in self.behaviour.iterate():
            self._contain("shutdown", inner.shutdown)

    def clear(self) -> None:
        """Terminate initialised behaviours, which py_trees does not do after an exception."""
        for inner in self.behaviour.iterate():
            if inner in self._open:
                inner.terminate(Status.INVALID)
            inner.status = Status.INVALID

    def tick(self) -> Iterator[Behaviour]:
        """Tick the behaviour once; the first tick waits until halted leaves are at rest."""
        behaviour = self.behaviour
        if behaviour.status is not Status.RUNNING and self._leaves.halted:
            yield self._turn
        self._show_inputs()
        steps = self._tick()
        while (step := self._contain("tick", partial(next, steps, None))) is not None:
            if step is behaviour:
                self._follow()
            yield step

    def _follow(self) -> None:
        if self.behaviour.status is Status.RUNNING:
            self._tree_timers.set(self._part.path, self._plan.every_s)
            return
        self._tree_timers.drop(self._part.path)
        self._write_outputs()

    def _create(self) -> Behaviour:
        plan, position = self._plan, self._part.position
        scope = self._place.scope
        given = plan.arguments.evaluate({name: scope.read(name, reader=position) for name in plan.arguments.names})
        arguments = converted_arguments(plan.kind, msgspec.convert(given, dict[str, Any]), position=position)
        if plan.takes_name:
            arguments.setdefault("name", self._part.name)
        return self._contain("constructor", partial(plan.kind, **arguments))

    def _initialise(self, inner: Behaviour, own: Callable[[], None]) -> None:
        self._contain("initialise", own)
        self._open.add(inner)

    def _update(self, own: Callable[[], Status]) -> Status:
        status: Any = self._contain("update", own)
        if not isinstance(status, Status) or status is Status.INVALID:
            raise StateError(
                f"update of {self._part.path} ({self._plan.kind.__qualname__}) returned {status!r}",
                where=self._part.position,
                hint="return Status.SUCCESS, FAILURE or RUNNING",
            )
        return status

    def _terminate(self, inner: Behaviour, own: Callable[[Status], None], new_status: Status) -> None:
        if inner is self.behaviour:
            self._tree_timers.drop(self._part.path)
        if inner in self._open:
            self._open.discard(inner)
            self._contain("terminate", partial(own, new_status))

    def _show_inputs(self) -> None:
        for key, source in self._plan.inputs.items():
            if self._place.scope.has(source):
                Blackboard.set(f"/{key}", self._place.scope.read(source, reader=self._part.position))

    def _write_outputs(self) -> None:
        for key, target in self._plan.outputs.items():
            if not Blackboard.exists(f"/{key}"):
                continue
            given: object = Blackboard.get(f"/{key}")
            value = self._contain("output", partial(plain_value, given, key=target, where=self._part.position))
            written_to = self._place.scope.write(target, value)
            self._execution.record_write(self._part.path, written_to, target, value)

    def _contain(self, what: str, call: Callable[[], T]) -> T:
        with contain_errors(f"{what} of {self._part.path} ({self._plan.kind.__qualname__})", where=self._part.position):
            return call()
