"""Grows a planned tree into py_trees nodes for one activation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import OneShotPolicy, ParallelPolicy, Status

from engine.document import node as nodes
from engine.document.expression import Template
from engine.errors import ExpressionError, StateError
from engine.event import Cause, Retried
from engine.execution import Execution
from engine.tree.alarms import Alarms
from engine.tree.decorators import Condition, Cooldown, Guard, Remap, Repeat, Retry, Timeout
from engine.tree.explanation import reason
from engine.tree.foreign import Foreign
from engine.tree.leaf import TreeLeaf, Turn
from engine.tree.leaves import Leaves
from engine.tree.parallel import CountingParallel, Parallel, Thresholds
from engine.tree.part import Part
from engine.tree.place import Place
from engine.tree.statuses import Statuses

_STATUS = {"success": Status.SUCCESS, "failure": Status.FAILURE, "running": Status.RUNNING}
_ONE_SHOT = {"completion": OneShotPolicy.ON_COMPLETION, "success": OneShotPolicy.ON_SUCCESSFUL_COMPLETION}


@dataclass(kw_only=True)
class Growth:
    """What the parts of one activation of a tree share, and what has grown so far.

    Args:
        execution: The run.
        leaves: Those that are active.
        alarms: Timers of decorators.
        clear: Brings a subtree to rest whose tick was torn by an error.
    """

    execution: Execution
    leaves: Leaves
    alarms: Alarms
    clear: Callable[[Behaviour], None]
    turn: Turn = field(default_factory=Turn)
    parts: dict[Behaviour, Part] = field(default_factory=dict[Behaviour, Part])
    guards: list[Guard] = field(default_factory=list[Guard])
    foreign: dict[Behaviour, Foreign] = field(default_factory=dict[Behaviour, Foreign])
    statuses: Statuses = field(init=False)
    reactive: bool = False
    """Whether it holds a composite without memory, which asks again what has ended."""
    _rank: int = 0

    def __post_init__(self) -> None:
        """Begin with nothing recorded."""
        self.statuses = Statuses(self.execution)

    def grow(self, part: Part, place: Place, *, caught: bool = False) -> Behaviour:
        """Return the py_trees node for a part with everything below it.

        Args:
            part: What to grow.
            place: Where it reads and writes.
            caught: Whether a decorator around it takes the errors of its leaves.

        Raises:
            FlexcellError: a foreign behaviour cannot be made.
        """
        if part.leaf is not None:
            self._rank += 1
            rank = self._rank
            leaf = TreeLeaf(part.leaf, place, self.leaves, self.turn, self.statuses, rank=rank, caught=caught)
            self.parts[leaf] = part
            return leaf
        if part.foreign is not None:
            node: Behaviour = self._foreign(part, place)
        elif part.source.parallel is not None:
            node = self._parallel(part, place, caught)
        elif part.source.kind in ("sequence", "selector"):
            node = self._line(part, place, caught)
        else:
            retry = part.source.retry
            errors = retry is not None and retry.errors
            node = self._decorator(part, self.grow(part.children[0], place, caught=caught or errors), place)
        self.parts[node] = part
        self.statuses.follow(node, part.path)
        return node

    def take_apart(self) -> None:
        """Let go of everything once the tree has ended: nodes that know each other would wait for the collector."""
        for node in self.parts:
            node.parent = None
            if node not in self.foreign:
                node.children = []
        self.parts.clear()

    def _line(self, part: Part, place: Place, caught: bool) -> Behaviour:
        children = [self.grow(child, place, caught=caught) for child in part.children]
        group = part.source.sequence or part.source.selector
        memory = group.memory if isinstance(group, nodes.Composite) else True
        self.reactive = self.reactive or not memory
        if part.source.sequence is not None:
            return composites.Sequence(part.path, memory, children)
        return composites.Selector(part.path, memory, children)

    def _parallel(self, part: Part, place: Place, caught: bool) -> Behaviour:
        places = {child.name: Place(place.scope) for child in part.children}
        children = [self.grow(child, places[child.name], caught=caught) for child in part.children]
        group = part.source.parallel
        written = group if isinstance(group, nodes.Parallel) else nodes.Parallel(children=())
        policy: ParallelPolicy.Base
        if written.counts:
            policy = Thresholds(written.success_count or len(children), written.failure_count or 1)
        elif written.policy == "one":
            policy = ParallelPolicy.SuccessOnOne()
        elif written.policy == "all":
            policy = ParallelPolicy.SuccessOnAll(synchronise=written.synchronise)
        else:
            chosen = [node for node, child in zip(children, part.children, strict=True) if child.name in written.policy]
            policy = ParallelPolicy.SuccessOnSelected(chosen, synchronise=written.synchronise)
        kind = CountingParallel if written.counts else Parallel
        return kind(part.path, policy, children, places=places, outside=place, execution=self.execution)

    def _foreign(self, part: Part, place: Place) -> Behaviour:
        plan = part.foreign
        if plan is None:
            raise StateError("not a py_trees behaviour", where=part.position)
        foreign = Foreign(
            part,
            plan,
            place,
            execution=self.execution,
            leaves=self.leaves,
            alarms=self.alarms,
            turn=self.turn,
        )
        self.foreign[foreign.behaviour] = foreign
        return foreign.behaviour

    def _decorator(self, part: Part, child: Behaviour, place: Place) -> Behaviour:
        path, alarms = part.path, self.alarms
        match part.source:
            case nodes.Node(inverter=nodes.Decorator()):
                return decorators.Inverter(path, child)
            case nodes.Node(one_shot=nodes.OneShot() as shot):
                return decorators.OneShot(path, child, _ONE_SHOT[shot.policy])
            case nodes.Node(repeat=nodes.Repeat() as repeat):
                return Repeat(path, child, repeat.times, alarms, self.statuses.repeat)
            case nodes.Node(cooldown=nodes.Cooldown() as cooldown):
                return Cooldown(path, child, cooldown.after_s, alarms)
            case nodes.Node(remap=nodes.Remap() as remap):
                shown = {_STATUS[actual]: _STATUS[getattr(remap, actual)] for actual in _STATUS}
                return Remap(path, child, shown, remap.every_s, alarms)
            case nodes.Node(condition=nodes.StatusCondition() as condition):
                return Condition(path, child, _STATUS[condition.status], condition.every_s, alarms)
            case nodes.Node(timeout=nodes.Timeout() as timeout):
                return Timeout(path, child, timeout.after_s, alarms)
            case nodes.Node(retry=nodes.Retry() as retry):
                return self._retry(part, retry, child)
            case nodes.Node(guard=nodes.Guard() as guard):
                return self._guard(part, guard, child, place)
            case _:
                raise StateError(f"a tree cannot hold a `{part.source.kind}`", where=part.position)

    def _guard(self, part: Part, guard: nodes.Guard, child: Behaviour, place: Place) -> Behaviour:
        when = part.when
        if when is None:
            raise StateError("a guard without a condition", where=part.position)
        holds = partial(_holds, when, place, part.position)
        node = Guard(part.path, child, keys=when.names, holds=holds, text=guard.when)
        self.guards.append(node)
        return node

    def _retry(self, part: Part, retry: nodes.Retry, child: Behaviour) -> Behaviour:
        return Retry(
            part.path,
            child,
            times=retry.times,
            backoff_s=retry.backoff_s,
            errors=retry.errors,
            alarms=self.alarms,
            clear=self.clear,
            tell=partial(self._tell_retry, part.path, child),
        )

    def _tell_retry(self, path: str, child: Behaviour, attempt: int, wait_s: float, error: Cause | None) -> None:
        self.execution.recorder.emit(
            Retried, path=path, attempt=attempt, wait_s=wait_s, cause=error or reason(child, self.parts)
        )


def _holds(when: Template, place: Place, position: str) -> bool:
    value = when.evaluate({name: place.scope.read(name, reader=position) for name in when.names})
    if not isinstance(value, bool):
        raise ExpressionError(f"the guard gave {value!r}, which is no truth value", where=position, hint="compare it")
    return value
