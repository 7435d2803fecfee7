"""Builds the py_trees nodes of a planned tree for one activation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from engine.document.nodes.node_kind import SLOTS
from engine.document.nodes.node_spec import GuardSpec, NodeSpec
from engine.document.nodes.tree_composites import CompositeSpec, ParallelSpec
from engine.errors import Cause, StateError
from engine.event import NodeRetried
from engine.runtime.nodes.execution import Execution
from engine.runtime.tree.active_leaves import ActiveLeaves
from engine.runtime.tree.branching import IfThenElse, WhileDoElse
from engine.runtime.tree.decorators import DecoratorSite, new_decorator
from engine.runtime.tree.disabled_part import DisabledPart
from engine.runtime.tree.entry_guard import EntryGuard
from engine.runtime.tree.explanation import explain_tree_failure
from engine.runtime.tree.foreign_behaviour import ForeignBehaviour
from engine.runtime.tree.guard_decorator import Guard, guard_condition, holds_in
from engine.runtime.tree.parallel import Parallel, ThresholdParallel, ThresholdPolicy
from engine.runtime.tree.post_conditions import PostConditions
from engine.runtime.tree.scope_access import ScopeAccess
from engine.runtime.tree.status_log import StatusLog
from engine.runtime.tree.timers import TreeTimers
from engine.runtime.tree.tree_leaf import TickPause, TreeLeaf
from engine.runtime.tree.tree_node import TreeNode


@dataclass(kw_only=True)
class TreeBuilder:
    """Builds the nodes of one activation of a tree, and holds what they share.

    Args:
        execution: The execution of the run.
        leaves: The active leaves.
        tree_timers: Timers of decorators.
        clear: Halts a subtree whose tick was interrupted by an error.
    """

    execution: Execution
    leaves: ActiveLeaves
    tree_timers: TreeTimers
    clear: Callable[[Behaviour], None]
    turn: TickPause = field(default_factory=TickPause)
    parts: dict[Behaviour, TreeNode] = field(default_factory=dict[Behaviour, TreeNode])
    guards: list[Guard | EntryGuard] = field(default_factory=list["Guard | EntryGuard"])
    entry_guards: dict[Behaviour, EntryGuard] = field(default_factory=dict[Behaviour, EntryGuard])
    foreign: dict[Behaviour, ForeignBehaviour] = field(default_factory=dict[Behaviour, ForeignBehaviour])
    posts: dict[Behaviour, PostConditions] = field(default_factory=dict[Behaviour, PostConditions])
    statuses: StatusLog = field(init=False)
    reactive: bool = False
    """Whether a node ticks ended children again: a composite without memory, or a `while_do_else`."""
    _rank: int = 0

    def __post_init__(self) -> None:
        """Create an empty status log."""
        self.statuses = StatusLog(self.execution)

    def build(
        self, part: TreeNode, place: ScopeAccess, *, caught: bool = False, passing: Status = Status.SUCCESS
    ) -> Behaviour:
        """Return the py_trees node for a planned node with everything below it.

        Args:
            part: The planned node.
            place: Access to its scope.
            caught: Whether a decorator around it handles the errors of its leaves.
            passing: Its status when it is skipped, by which its parent passes over it.

        Raises:
            FlexcellError: a foreign behaviour cannot be created.
        """
        if part.disabled:
            passed = DisabledPart(part.path, self.statuses.skips)
            self.parts[passed] = part
            self.statuses.skips.place(passed, passing)
            self.statuses.follow(passed, part.path)
            return passed
        if part.leaf is not None:
            self._rank += 1
            rank = self._rank
            leaf = TreeLeaf(part.leaf, place, self.leaves, self.turn, self.statuses, rank, caught=caught)
            self.parts[leaf] = part
            if part.post:
                self._post(part, leaf, place)
            self.statuses.skips.place(leaf, passing)
            return leaf
        if part.foreign is not None:
            node: Behaviour = self._foreign(part, place)
        elif part.source.parallel is not None:
            node = self._parallel(part, place, caught=caught)
        elif part.source.kind in ("sequence", "selector"):
            node = self._composite(part, place, caught=caught)
        elif part.source.kind in SLOTS:
            node = self._branching(part, place, caught=caught)
        else:
            retry = part.source.retry
            errors = retry is not None and retry.errors
            inside = self.build(part.children[0], place, caught=caught or errors, passing=passing)
            node = self._decorator(part, inside, place)
        self.parts[node] = part
        self.statuses.skips.place(node, passing)
        if part.skips and node not in self.foreign and part.source.kind not in SLOTS:
            self.statuses.skips.follow(node)
        if part.source.guard is not None and part.source.kind != "guard":
            self._entry_guard(part, part.source.guard, node, place)
        if part.post:
            self._post(part, node, place)
        self.statuses.follow(node, part.path)
        return node

    def _post(self, part: TreeNode, node: Behaviour, place: ScopeAccess) -> None:
        self.posts[node] = PostConditions(node, part, place, self.execution, self.statuses)

    def dismantle(self) -> None:
        """Release all nodes once the tree has ended: reference cycles would wait for the garbage collector."""
        for node in self.parts:
            node.parent = None
            if node in self.posts or (node.children and node not in self.foreign):
                # Its children, its iterator, and its wrapped methods.
                vars(node).clear()
        self.parts.clear()
        self.statuses.skips.forget_all()

    def _composite(self, part: TreeNode, place: ScopeAccess, *, caught: bool) -> Behaviour:
        passing = Status.SUCCESS if part.source.sequence is not None else Status.FAILURE
        children = [self.build(child, place, caught=caught, passing=passing) for child in part.children]
        group = part.source.sequence or part.source.selector
        memory = group.memory if isinstance(group, CompositeSpec) else True
        self.reactive = self.reactive or not memory
        if part.source.sequence is not None:
            return composites.Sequence(part.path, memory, children)
        return composites.Selector(part.path, memory, children)

    def _branching(self, part: TreeNode, place: ScopeAccess, *, caught: bool) -> Behaviour:
        # A skipped condition does not hold.
        children = [self.build(child, place, caught=caught, passing=Status.FAILURE) for child in part.children]
        if part.source.if_then_else is not None:
            return IfThenElse(part.path, children, self.statuses.skips)
        self.reactive = True
        return WhileDoElse(part.path, children, self.statuses.skips)

    def _parallel(self, part: TreeNode, place: ScopeAccess, *, caught: bool) -> Behaviour:
        places = {child.name: ScopeAccess(place.scope) for child in part.children}
        group = part.source.parallel
        written = group if isinstance(group, ParallelSpec) else ParallelSpec[NodeSpec](children=())
        # Where one success or a count of successes decides, a skipped child is neither success nor failure.
        passing = Status.INVALID if written.counts or written.policy == "one" else Status.SUCCESS
        children = [self.build(child, places[child.name], caught=caught, passing=passing) for child in part.children]
        policy: ParallelPolicy.Base
        if written.counts:
            policy = ThresholdPolicy(written.success_count, written.failure_count or 1)
        elif written.policy == "one":
            policy = ParallelPolicy.SuccessOnOne()
        elif written.policy == "all":
            policy = ParallelPolicy.SuccessOnAll(synchronise=written.synchronise)
        else:
            chosen = [node for node, child in zip(children, part.children, strict=True) if child.name in written.policy]
            policy = ParallelPolicy.SuccessOnSelected(chosen, synchronise=written.synchronise)
        kind = ThresholdParallel if written.counts else Parallel
        return kind(
            part.path,
            policy,
            children,
            places=places,
            outside=place,
            execution=self.execution,
            skips=self.statuses.skips,
        )

    def _foreign(self, part: TreeNode, place: ScopeAccess) -> Behaviour:
        plan = part.foreign
        if plan is None:
            raise StateError("not a py_trees behaviour", where=part.position)
        foreign = ForeignBehaviour(
            part,
            plan,
            place,
            execution=self.execution,
            leaves=self.leaves,
            tree_timers=self.tree_timers,
            turn=self.turn,
        )
        self.foreign[foreign.behaviour] = foreign
        return foreign.behaviour

    def _decorator(self, part: TreeNode, child: Behaviour, place: ScopeAccess) -> Behaviour:
        site = DecoratorSite(
            place=place,
            statuses=self.statuses,
            tree_timers=self.tree_timers,
            clear=self.clear,
            record_retry=partial(self._record_retry, part.path, child),
        )
        node = new_decorator(part, child, site)
        if isinstance(node, Guard):
            self.guards.append(node)
        return node

    def _entry_guard(self, part: TreeNode, guard: GuardSpec, node: Behaviour, place: ScopeAccess) -> None:
        entry_guard = EntryGuard(
            node,
            keys=guard_condition(part).names,
            holds=holds_in(part, place),
            text=guard.when,
            to=guard.to or "failure",
            skips=self.statuses.skips,
        )
        self.guards.append(entry_guard)
        self.entry_guards[node] = entry_guard

    def _record_retry(self, path: str, child: Behaviour, attempt: int, wait_s: float, error: Cause | None) -> None:
        self.execution.recorder.emit(
            NodeRetried,
            path=path,
            attempt=attempt,
            wait_s=wait_s,
            cause=error or explain_tree_failure(child, self.parts, self.entry_guards),
        )
