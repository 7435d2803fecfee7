"""Restores a newly built tree to the state of an interrupted activation.

Leaves that were at work are begun again (their own points say from where); timers go on with what
was left of them; a py_trees behaviour that was RUNNING begins anew, as nobody knows its inside.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from py_trees import composites, decorators
from py_trees.behaviour import Behaviour
from py_trees.common import OneShotPolicy, ParallelPolicy, Status
from py_trees.decorators import Decorator

from engine.runtime.record.node_exit import NodeExit
from engine.runtime.tree.branching import IfThenElse, WhileDoElse
from engine.runtime.tree.decorators import Cooldown, Remap, Repeat, Retry, StatusCondition, Timeout
from engine.runtime.tree.parallel import Parallel, ThresholdParallel
from engine.runtime.tree.tree_builder import TreeBuilder
from engine.runtime.tree.tree_history import TreeNodeState
from engine.runtime.tree.tree_leaf import TreeLeaf

_STATUS = {"success": Status.SUCCESS, "failure": Status.FAILURE, "running": Status.RUNNING}
_FINAL = (Status.SUCCESS, Status.FAILURE)
_NEVER = TreeNodeState()

BranchValues = Mapping[str, Mapping[str, object]]
"""What branches of parallels had written, by the path of the branch."""


def restore_tree(
    root: Behaviour, builder: TreeBuilder, known: Mapping[str, TreeNodeState], branches: BranchValues
) -> bool:
    """Give every part the state it stood in; return whether a tick is due at once.

    Args:
        root: The tree as grown.
        builder: What its parts share.
        known: How each part stood, by path.
        branches: Values of the branches of parallels that were at work.
    """
    restoring = _Restoring(builder, known, branches, builder.execution.recorder.now_s())
    if not restoring.part(root):
        restoring.tick_due = True
    # In the order in which they had begun, so that those which end together end in the same order.
    for leaf, _ in sorted(restoring.going_on, key=lambda each: each[1]):
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
    """The mark since which no tick comes to the part at hand, as the condition of a `while_do_else` is RUNNING."""
    echoed: set[Behaviour] = field(default_factory=set[Behaviour])
    going_on: list[tuple[TreeLeaf, int]] = field(default_factory=list[tuple[TreeLeaf, int]])

    @cached_property
    def newest(self) -> int:
        """The last of all marks."""
        return max((max(each.order, each.passed) for each in self.known.values()), default=-1)

    def part(self, node: Behaviour) -> bool:
        """Restore a part and everything below it; tell whether anything there will wake the tree."""
        part = self.builder.parts[node]
        standing = self.known.get(part.path, _NEVER)
        if standing.status != "running" and self._last(node) > standing.order:
            # It was in its first tick, and had not come to tell its status.
            self.tick_due = True
            standing = replace(standing, status="running", since_s=self.now_s, attempt=1, rounds=0)
        if node in self.builder.posts:
            self.builder.posts[node].made = dict(standing.assigned)
        if isinstance(node, TreeLeaf):
            return self._leaf(node, standing)
        if part.foreign is not None:
            # Its own state is lost; it is INVALID, so the tick that is due initialises it again.
            return False
        skips = self.builder.statuses.skips
        skipped = standing.status == "skipped"
        node.status = skips.skip(node) if skipped else _STATUS.get(standing.status, Status.INVALID)
        self.builder.statuses.take(node)
        running = node.status is Status.RUNNING
        if isinstance(node, Parallel) and running:
            node.restore(self.branches)
        wakes = [self._inside(node, child) for child in node.children]
        awake = any(wakes)
        if isinstance(node, Decorator):
            awake = self._decorator(node, standing) or awake
        if running:
            skips.restore(node, (child for child in node.children if self._was_skipped(child, standing)))
            unread = self._unread(node, standing)
            for child in unread:
                self._echo(child)
            if isinstance(node, composites.Composite):
                node.current_child = unread[0] if unread else self._current(node, standing)
            # A tick was under way, or had just ended, when it was cut: it is done again.
            self.tick_due = self.tick_due or bool(unread) or not awake
        return awake

    def _inside(self, node: Behaviour, child: Behaviour) -> bool:
        """Restore a child; a branch of a `while_do_else` whose condition is RUNNING gives no reason to tick."""
        if not (isinstance(node, WhileDoElse) and child in node.branches and node.condition.status is Status.RUNNING):
            return self.part(child)
        around, due, since = self.unreached, self.tick_due, self._passed_since(node.condition, child)
        self.unreached = since if around is None else min(around, since)
        wakes = self.part(child)
        self.unreached, self.tick_due = around, due
        return wakes

    def _passed_since(self, condition: Behaviour, branch: Behaviour) -> int:
        """Return the mark since which no tick has come to a branch, by when its condition became RUNNING."""
        standing, last = self._standing(condition), max(self._order(condition), self._last(condition))
        if last == self.newest:
            # The tick that asked it may have been under way, and not have come to tell what it passed over.
            return max(standing.over, *map(self._ticked, branch.iterate()))
        return standing.opened if standing.status == "running" else last

    def _ticked(self, node: Behaviour) -> int:
        """Return the last mark by which a tick had come to a part; leaves that command begin when it is over."""
        standing = self._standing(node)
        if not isinstance(node, TreeLeaf):
            return standing.order
        if not node.plan.check:
            return -1
        # One whose guard was closed was not entered.
        return standing.order if standing.target is not None else standing.began

    def _unread(self, node: Behaviour, standing: TreeNodeState) -> list[Behaviour]:
        """Return the children whose end a RUNNING part had not come to read."""
        ended = [child for child in node.children if child.status in _FINAL and self._order(child) > standing.over]
        if isinstance(node, ThresholdParallel):
            return ended if node.verdict is not Status.RUNNING else []
        if isinstance(node, composites.Parallel):
            return ended if _decided(node, ended) else []
        if isinstance(node, IfThenElse):
            return self._unread_choice(node, standing)
        if isinstance(node, composites.Composite):
            final = Status.FAILURE if isinstance(node, composites.Sequence) else Status.SUCCESS
            decisive = [child for child in ended if child.status is final]
            last = node.children[-1]
            return decisive[:1] or ([last] if last in ended else [])
        match node:
            case Repeat() | Retry():
                again = Status.SUCCESS if isinstance(node, Repeat) else Status.FAILURE
                told = standing.order > max(self._last(node), self._order(node.children[0]))
                return [] if told and node.children[0].status is again else ended
            case Remap():
                return [child for child in ended if node.shown[child.status] is not Status.RUNNING]
            case StatusCondition():
                return [child for child in ended if child.status is node.succeed_status]
            case _:
                return ended

    def _unread_choice(self, node: IfThenElse, standing: TreeNodeState) -> list[Behaviour]:
        """Return what has ended, in the order in which it is to be read: the condition, the branch at work."""
        ended = [branch for branch in node.branches if branch.status in _FINAL]
        unread = [branch for branch in ended if self._order(branch) > standing.over]
        if node.condition.status not in _FINAL or self._order(node.condition) < standing.over:
            return []
        asked_last = all(self._order(node.condition) > self._order(branch) for branch in ended)
        at_work = [branch for branch in node.branches if branch.status is Status.RUNNING]
        if not (unread or at_work) or (isinstance(node, WhileDoElse) and (at_work or asked_last)):
            # A tick was cut in which the condition had been asked, and nothing had come of it.
            return [] if at_work == [node.chosen] else [node.condition, *unread]
        return unread

    def _current(self, node: composites.Composite, standing: TreeNodeState) -> Behaviour:
        """Return the child at which a composite with memory goes on."""
        if isinstance(node, IfThenElse):
            return next((branch for branch in node.branches if branch.status is Status.RUNNING), node.condition)
        passed = Status.SUCCESS if isinstance(node, composites.Sequence) else Status.FAILURE
        following = 0
        for index, child in enumerate(node.children):
            if child.status is Status.RUNNING:
                return child
            if child.status is passed and self._order(child) > standing.over:
                following = index + 1
        return node.children[min(following, len(node.children) - 1)]

    def _was_skipped(self, child: Behaviour, around: TreeNodeState) -> bool:
        standing = self._standing(child)
        return standing.skipped > max(around.over, standing.began)

    def _order(self, node: Behaviour) -> int:
        """Return which of the marks was the last one of a part."""
        return self._standing(node).order

    def _standing(self, node: Behaviour) -> TreeNodeState:
        # What a py_trees behaviour brings with it is no part.
        return self.known.get(self.builder.parts[node].path, _NEVER) if node in self.builder.parts else _NEVER

    def _last(self, node: Behaviour) -> int:
        """Return which of the marks was the last one by which something below a part was at work, or ended."""
        found = -1
        for child in node.children:
            standing = self._standing(child)
            own = standing.order if standing.status != "invalid" else -1
            found = max(found, own, self._last(child))
        return found

    def _leaf(self, leaf: TreeLeaf, standing: TreeNodeState) -> bool:
        execution = self.builder.execution
        path = leaf.plan.node.path
        told_again = not standing.read and path in execution.points
        if standing.status == "running" or told_again:
            leaf.status = Status.RUNNING
            self.going_on.append((leaf, standing.order))
            return True
        execution.points.pop(path, None)
        if standing.status == "ended" and (standing.outcome is not None or standing.target is not None):
            left = NodeExit(standing.outcome or "", standing.target)
            if self._is_unread(standing):
                leaf.keep(left, passed=standing.passed >= 0)
                return True
            leaf.restore(left)
        return False

    def _is_unread(self, ended: TreeNodeState) -> bool:
        """Tell whether no tick has come to a leaf since it has ended."""
        if self.unreached is None:
            # A tick was under way that was about to come there.
            self.tick_due = self.tick_due or ended.passed >= 0
            return ended.passed >= 0
        return ended.passed >= 0 or ended.order > self.unreached

    def _echo(self, node: Behaviour) -> None:
        """Have a part that has ended tell its status once more in the next tick, without doing anything."""
        if node not in self.echoed:
            self.echoed.add(node)
            _echo(node)

    def _decorator(self, node: Behaviour, standing: TreeNodeState) -> bool:
        """Restore what a decorator keeps; tell whether it has set a timer."""
        elapsed_s = self.now_s - standing.since_s
        match node:
            case Timeout():
                node.restore(standing, elapsed_s, reached=self.unreached is None)
            case Retry() | Remap() | StatusCondition():
                node.restore(standing, elapsed_s)
            case Cooldown():
                ended_s = standing.since_s if standing.first is not None else 0.0
                node.restore(standing, self.now_s - max(standing.ended_s or 0.0, ended_s))
            case Repeat():
                node.success = standing.rounds
            case decorators.OneShot():
                kept = standing.first if node.policy is OneShotPolicy.ON_COMPLETION else standing.final
                node.final_status = _STATUS[kept] if kept is not None and _STATUS[kept] in node.policy.value else None
            case _:
                pass
        path = self.builder.parts[node].path
        return self.builder.tree_timers.pending(path)


def _decided(node: composites.Parallel, ended: Sequence[Behaviour]) -> bool:
    """Tell whether a parallel would end with a tick that reads these."""
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
            yield from node.tick()  # it was halted before the tick came to it

    vars(node)["tick"] = tick
