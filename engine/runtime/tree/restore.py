"""Restores a newly built tree to the state of an interrupted activation.

Active leaves are started again (from their own checkpoints); timers continue with the remaining time; a py_trees
behaviour that was RUNNING starts over, as its internal state is unknown.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status

from engine.runtime.record.node_exit import NodeExit
from engine.runtime.tree.branching import IfThenElse, WhileDoElse
from engine.runtime.tree.parallel import Parallel, ThresholdParallel
from engine.runtime.tree.tree_builder import TreeBuilder
from engine.runtime.tree.tree_decorator import STATUSES, TreeDecorator
from engine.runtime.tree.tree_history import TreeNodeState
from engine.runtime.tree.tree_leaf import TreeLeaf

_FINAL = (Status.SUCCESS, Status.FAILURE)
_NEVER = TreeNodeState()

BranchValues = Mapping[str, Mapping[str, object]]
"""Values written by branches of parallels, by the path of the branch."""


def restore_tree(
    root: Behaviour, builder: TreeBuilder, known: Mapping[str, TreeNodeState], branches: BranchValues
) -> bool:
    """Restore the state of every node; return whether a tick is due at once.

    Args:
        root: The newly built tree.
        builder: The builder of the tree.
        known: The state of each node, by path.
        branches: Values of the branches of active parallels.
    """
    restoring = _Restoring(builder, known, branches, builder.execution.recorder.now_s())
    if not restoring.part(root):
        restoring.tick_due = True
    # In order of their starts, so that leaves that end together end in the same order.
    for leaf, _ in sorted(restoring.resumed_leaves, key=lambda each: each[1]):
        leaf.go_on()
    for post in builder.posts.values():
        post.conclude()
    return restoring.tick_due


@dataclass
class _Restoring:
    builder: TreeBuilder
    known: Mapping[str, TreeNodeState]
    branches: BranchValues
    now_s: float
    tick_due: bool = False
    unreached: int | None = None
    """The event since which no tick reaches the current node, as the condition of a `while_do_else` is RUNNING."""
    echoed: set[Behaviour] = field(default_factory=set[Behaviour])
    resumed_leaves: list[tuple[TreeLeaf, int]] = field(default_factory=list[tuple[TreeLeaf, int]])

    @cached_property
    def latest(self) -> int:
        """The number of the last event."""
        return max((max(each.order, each.passed) for each in self.known.values()), default=-1)

    def part(self, node: Behaviour) -> bool:
        """Restore a node and everything below it; return whether anything there will wake the tree."""
        part = self.builder.parts[node]
        state = self.known.get(part.path, _NEVER)
        if state.status != "running" and self._last(node) > state.order:
            # It was in its first tick, and its status was not recorded yet.
            self.tick_due = True
            state = replace(state, status="running", since_s=self.now_s, attempt=1, rounds=0)
        if node in self.builder.posts:
            self.builder.posts[node].made = dict(state.assigned)
        if isinstance(node, TreeLeaf):
            return self._leaf(node, state)
        if part.foreign is not None:
            # Its internal state is lost; it is INVALID, so the pending tick initialises it again.
            return False
        skips = self.builder.statuses.skips
        skipped = state.status == "skipped"
        node.status = skips.skip(node) if skipped else STATUSES.get(state.status, Status.INVALID)
        self.builder.statuses.take(node)
        running = node.status is Status.RUNNING
        if isinstance(node, Parallel) and running:
            node.restore(self.branches)
        wakes = [self._inside(node, child) for child in node.children]
        awake = any(wakes)
        if isinstance(node, TreeDecorator):
            node.restore(state, self.now_s, is_reached=self.unreached is None)
            awake = self.builder.tree_timers.pending(part.path) or awake
        if running:
            skips.restore(node, (child for child in node.children if self._was_skipped(child, state)))
            unread = self._unread(node, state)
            for child in unread:
                self._echo(child)
            if isinstance(node, composites.Composite):
                node.current_child = unread[0] if unread else self._current(node, state)
            # A tick was in progress, or had just ended, at the interruption: it is repeated.
            self.tick_due = self.tick_due or bool(unread) or not awake
        return awake

    def _inside(self, node: Behaviour, child: Behaviour) -> bool:
        """Restore a child; a branch of a `while_do_else` whose condition is RUNNING does not make a tick due."""
        if not (isinstance(node, WhileDoElse) and child in node.branches and node.condition.status is Status.RUNNING):
            return self.part(child)
        around, due, since = self.unreached, self.tick_due, self._passed_since(node.condition, child)
        self.unreached = since if around is None else min(around, since)
        wakes = self.part(child)
        self.unreached, self.tick_due = around, due
        return wakes

    def _passed_since(self, condition: Behaviour, branch: Behaviour) -> int:
        """Return the event since which no tick has reached a branch: when its condition became RUNNING."""
        state, last = self._state(condition), max(self._order(condition), self._last(condition))
        if last == self.latest:
            # The tick of the condition may have been in progress, before it recorded the nodes that it passed over.
            return max(state.over, *map(self._ticked, branch.iterate()))
        return state.opened if state.status == "running" else last

    def _ticked(self, node: Behaviour) -> int:
        """Return the last event by which a tick had reached a node; leaves that command begin after the tick."""
        state = self._state(node)
        if not isinstance(node, TreeLeaf):
            return state.order
        if not node.plan.check:
            return -1
        # A leaf with a closed guard was not entered.
        return state.order if state.target is not None else state.active

    def _unread(self, node: Behaviour, state: TreeNodeState) -> list[Behaviour]:
        """Return the children whose end a RUNNING node had not read."""
        ended = [child for child in node.children if child.status in _FINAL and self._order(child) > state.over]
        if isinstance(node, ThresholdParallel):
            return ended if node.verdict is not Status.RUNNING else []
        if isinstance(node, composites.Parallel):
            return ended if _decided(node, ended) else []
        if isinstance(node, IfThenElse):
            return self._unread_choice(node, state)
        if isinstance(node, composites.Composite):
            final = Status.FAILURE if isinstance(node, composites.Sequence) else Status.SUCCESS
            decisive = [child for child in ended if child.status is final]
            last = node.children[-1]
            return decisive[:1] or ([last] if last in ended else [])
        if isinstance(node, TreeDecorator):
            is_recorded = state.order > max(self._last(node), self._order(node.decorated))
            return [child for child in ended if node.reads_end(child.status, is_recorded=is_recorded)]
        return ended

    def _unread_choice(self, node: IfThenElse, state: TreeNodeState) -> list[Behaviour]:
        """Return the unread ended children, in the order to read them: the condition, then the active branch."""
        ended = [branch for branch in node.branches if branch.status in _FINAL]
        unread = [branch for branch in ended if self._order(branch) > state.over]
        if node.condition.status not in _FINAL or self._order(node.condition) < state.over:
            return []
        ticked_last = all(self._order(node.condition) > self._order(branch) for branch in ended)
        at_work = [branch for branch in node.branches if branch.status is Status.RUNNING]
        if not (unread or at_work) or (isinstance(node, WhileDoElse) and (at_work or ticked_last)):
            # The interrupted tick had ticked the condition, without an effect yet.
            return [] if at_work == [node.chosen] else [node.condition, *unread]
        return unread

    def _current(self, node: composites.Composite, state: TreeNodeState) -> Behaviour:
        """Return the child at which a composite with memory resumes."""
        if isinstance(node, IfThenElse):
            return next((branch for branch in node.branches if branch.status is Status.RUNNING), node.condition)
        passed = Status.SUCCESS if isinstance(node, composites.Sequence) else Status.FAILURE
        following = 0
        for index, child in enumerate(node.children):
            if child.status is Status.RUNNING:
                return child
            if child.status is passed and self._order(child) > state.over:
                following = index + 1
        return node.children[min(following, len(node.children) - 1)]

    def _was_skipped(self, child: Behaviour, around: TreeNodeState) -> bool:
        state = self._state(child)
        return state.skipped > max(around.over, state.active)

    def _order(self, node: Behaviour) -> int:
        """Return the number of the last event of a node."""
        return self._state(node).order

    def _state(self, node: Behaviour) -> TreeNodeState:
        # Children of a py_trees behaviour are not tree nodes.
        return self.known.get(self.builder.parts[node].path, _NEVER) if node in self.builder.parts else _NEVER

    def _last(self, node: Behaviour) -> int:
        """Return the number of the last event by which something below a node was active, or ended."""
        last = -1
        for child in node.children:
            state = self._state(child)
            own = state.order if state.status != "invalid" else -1
            last = max(last, own, self._last(child))
        return last

    def _leaf(self, leaf: TreeLeaf, state: TreeNodeState) -> bool:
        execution = self.builder.execution
        path = leaf.plan.node.path
        is_repeated = not state.read and path in execution.points
        if state.status == "running" or is_repeated:
            leaf.status = Status.RUNNING
            self.resumed_leaves.append((leaf, state.order))
            return True
        execution.points.pop(path, None)
        if state.status == "ended" and (state.outcome is not None or state.target is not None):
            left = NodeExit(state.outcome or "", state.target)
            if self._is_unread(state):
                leaf.keep(left, passed=state.passed >= 0)
                return True
            leaf.restore(left)
        return False

    def _is_unread(self, ended: TreeNodeState) -> bool:
        """Return whether no tick has reached a leaf since its end."""
        if self.unreached is None:
            # A tick was in progress that had not reached it yet.
            self.tick_due = self.tick_due or ended.passed >= 0
            return ended.passed >= 0
        return ended.passed >= 0 or ended.order > self.unreached

    def _echo(self, node: Behaviour) -> None:
        """Let an ended node yield its status again in the next tick, without work."""
        if node not in self.echoed:
            self.echoed.add(node)
            _echo(node)


def _decided(node: composites.Parallel, ended: Sequence[Behaviour]) -> bool:
    """Return whether a parallel ends with a tick that reads these children."""
    policy = node.policy
    if isinstance(policy, ParallelPolicy.SuccessOnOne) or any(child.status is Status.FAILURE for child in ended):
        return True
    asked = policy.children if isinstance(policy, ParallelPolicy.SuccessOnSelected) else node.children
    return all(child.status is Status.SUCCESS for child in asked)


def _echo(node: Behaviour) -> None:
    before = vars(node).pop("tick", None)

    def tick() -> Iterator[Behaviour]:
        del vars(node)["tick"]
        if before is not None:
            vars(node)["tick"] = before
        if node.status in _FINAL:
            yield node
        else:
            yield from node.tick()  # it was halted before the tick reached it

    vars(node)["tick"] = tick
