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
from engine.tree.branching import IfThenElse, WhileDoElse
from engine.tree.decorators import Condition, Cooldown, Guard, Remap, Repeat, Retry, Timeout
from engine.tree.entry_guard import EntryGuard
from engine.tree.explanation import reason
from engine.tree.foreign import Foreign
from engine.tree.leaf import TreeLeaf, Turn
from engine.tree.leaves import Leaves
from engine.tree.parallel import CountingParallel, Parallel, Thresholds
from engine.tree.part import Part
from engine.tree.place import Place
from engine.tree.post_conditions import PostConditions
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
    guards: list[Guard | EntryGuard] = field(default_factory=list["Guard | EntryGuard"])
    entry_guards: dict[Behaviour, EntryGuard] = field(default_factory=dict[Behaviour, EntryGuard])
    foreign: dict[Behaviour, Foreign] = field(default_factory=dict[Behaviour, Foreign])
    posts: dict[Behaviour, PostConditions] = field(default_factory=dict[Behaviour, PostConditions])
    statuses: Statuses = field(init=False)
    reactive: bool = False
    """Whether it holds a part that asks again what has ended: a composite without memory, or a `while_do_else`."""
    _rank: int = 0

    def __post_init__(self) -> None:
        """Begin with nothing recorded."""
        self.statuses = Statuses(self.execution)

    def grow(self, part: Part, place: Place, *, caught: bool = False, passing: Status = Status.SUCCESS) -> Behaviour:
        """Return the py_trees node for a part with everything below it.

        Args:
            part: What to grow.
            place: Where it reads and writes.
            caught: Whether a decorator around it takes the errors of its leaves.
            passing: The status by which the part around it passes over it when it is skipped.

        Raises:
            FlexcellError: a foreign behaviour cannot be made.
        """
        if part.leaf is not None:
            self._rank += 1
            rank = self._rank
            leaf = TreeLeaf(part.leaf, place, self.leaves, self.turn, self.statuses, rank, caught)
            self.parts[leaf] = part
            if part.post:
                self._post(part, leaf, place)
            self.statuses.skips.place(leaf, passing)
            return leaf
        if part.foreign is not None:
            node: Behaviour = self._foreign(part, place)
        elif part.source.parallel is not None:
            node = self._parallel(part, place, caught)
        elif part.source.kind in ("sequence", "selector"):
            node = self._line(part, place, caught)
        elif part.source.kind in nodes.SLOTS:
            node = self._branching(part, place, caught)
        else:
            retry = part.source.retry
            errors = retry is not None and retry.errors
            inside = self.grow(part.children[0], place, caught=caught or errors, passing=passing)
            node = self._decorator(part, inside, place)
        self.parts[node] = part
        self.statuses.skips.place(node, passing)
        if part.skips and node not in self.foreign and part.source.kind not in nodes.SLOTS:
            self.statuses.skips.follow(node)
        if part.source.guard is not None and part.source.kind != "guard":
            self._entry_guard(part, part.source.guard, node, place)
        if part.post:
            self._post(part, node, place)
        self.statuses.follow(node, part.path)
        return node

    def _post(self, part: Part, node: Behaviour, place: Place) -> None:
        self.posts[node] = PostConditions(node, part, place, self.execution, self.statuses)

    def take_apart(self) -> None:
        """Let go of everything once the tree has ended: nodes that know each other would wait for the collector."""
        for node in self.parts:
            node.parent = None
            if node in self.posts or (node.children and node not in self.foreign):
                # Its children, its iterator, and what was put in the place of its methods.
                vars(node).clear()
        self.parts.clear()
        self.statuses.skips.forget_all()

    def _line(self, part: Part, place: Place, caught: bool) -> Behaviour:
        passing = Status.SUCCESS if part.source.sequence is not None else Status.FAILURE
        children = [self.grow(child, place, caught=caught, passing=passing) for child in part.children]
        group = part.source.sequence or part.source.selector
        memory = group.memory if isinstance(group, nodes.Composite) else True
        self.reactive = self.reactive or not memory
        if part.source.sequence is not None:
            return composites.Sequence(part.path, memory, children)
        return composites.Selector(part.path, memory, children)

    def _branching(self, part: Part, place: Place, caught: bool) -> Behaviour:
        # A condition that is skipped does not hold.
        children = [self.grow(child, place, caught=caught, passing=Status.FAILURE) for child in part.children]
        if part.source.if_then_else is not None:
            return IfThenElse(part.path, children, self.statuses.skips)
        self.reactive = True
        return WhileDoElse(part.path, children, self.statuses.skips)

    def _parallel(self, part: Part, place: Place, caught: bool) -> Behaviour:
        places = {child.name: Place(place.scope) for child in part.children}
        group = part.source.parallel
        written = group if isinstance(group, nodes.Parallel) else nodes.Parallel(children=())
        # Where one success or a number of them decides, what is skipped is neither.
        passing = Status.INVALID if written.counts or written.policy == "one" else Status.SUCCESS
        children = [self.grow(child, places[child.name], caught=caught, passing=passing) for child in part.children]
        policy: ParallelPolicy.Base
        if written.counts:
            policy = Thresholds(written.success_count, written.failure_count or 1)
        elif written.policy == "one":
            policy = ParallelPolicy.SuccessOnOne()
        elif written.policy == "all":
            policy = ParallelPolicy.SuccessOnAll(synchronise=written.synchronise)
        else:
            chosen = [node for node, child in zip(children, part.children, strict=True) if child.name in written.policy]
            policy = ParallelPolicy.SuccessOnSelected(chosen, synchronise=written.synchronise)
        kind = CountingParallel if written.counts else Parallel
        return kind(
            part.path,
            policy,
            children,
            places=places,
            outside=place,
            execution=self.execution,
            skips=self.statuses.skips,
        )

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
        closed = partial(self._closed, guard.to or "failure")
        node = Guard(part.path, child, keys=when.names, holds=holds, text=guard.when, closed=closed)
        self.guards.append(node)
        return node

    def _entry_guard(self, part: Part, guard: nodes.Guard, node: Behaviour, place: Place) -> None:
        when = part.when
        if when is None:
            raise StateError("a guard without a condition", where=part.position)
        holds = partial(_holds, when, place, part.position)
        made = EntryGuard(
            node,
            keys=when.names,
            holds=holds,
            text=guard.when,
            to=guard.to or "failure",
            skips=self.statuses.skips,
        )
        self.guards.append(made)
        self.entry_guards[node] = made

    def _closed(self, to: str, node: Behaviour) -> Status:
        if to == "skipped":
            return self.statuses.skips.skip(node)
        self.statuses.skips.run(node)
        return _STATUS[to]

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
            Retried,
            path=path,
            attempt=attempt,
            wait_s=wait_s,
            cause=error or reason(child, self.parts, self.entry_guards),
        )


def _holds(when: Template, place: Place, position: str) -> bool:
    value = when.evaluate({name: place.scope.read(name, reader=position) for name in when.names})
    if not isinstance(value, bool):
        raise ExpressionError(f"the guard gave {value!r}, which is no truth value", where=position, hint="compare it")
    return value
