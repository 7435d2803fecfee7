"""Decides how far one step back of a paused run goes, or why it is impossible; changes nothing.

It takes back the node that began last and has not been taken back, in one branch: a node that has begun is undone and
stands before its entry again; where none has, the one before it in its machine. Whatever was done in it is undone in
reverse order, so all of it must declare how.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from engine.errors import ControlError
from engine.event import Cause, Event
from engine.node_path import is_inside
from engine.runtime.control.gate import GateWait
from engine.runtime.history.resume import effective_events
from engine.runtime.history.run_reducer import RunStateReducer
from engine.runtime.history.userdata_history import UserdataHistory
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.plan import Plan
from engine.runtime.record.undo_log import LeafActivation, UndoLog
from engine.state import State, nothing_to_undo
from engine.suggestions import did_you_mean


@dataclass(frozen=True, kw_only=True)
class PausedPosition:
    """Where a paused run stands: the nodes at the gate, and those that were entered and not left."""

    waiting: Mapping[str, GateWait]
    active: Mapping[str, int]


@dataclass(frozen=True, kw_only=True)
class StepBack:
    """One step back, decided: `node` gives up, and the run then stands before `target`."""

    cursor: str
    """The node that waits or is active, by which the branch was found."""
    node: str
    target: str
    since: int
    """The event with which the run had come to `target`."""
    plan: Plan
    trail: UndoLog
    former: Mapping[str, Mapping[str, object]]
    """The scopes as they were then."""
    went_wrong: Cause | None
    reason: Cause | None

    @property
    def undone(self) -> tuple[LeafActivation, ...]:
        """What is to be undone, in this order."""
        return self.trail.done(self.target, self.since)


def plan_step_back(plan: Plan, events: Sequence[Event], standing: PausedPosition, *, path: str = "") -> StepBack:
    """Decide what the next step back of a paused run is.

    Args:
        plan: What it executes.
        events: All that has happened.
        standing: Where it stands.
        path: The branch; by default the one in which something began last.

    Raises:
        ControlError: nothing in that branch can be taken back; says what is in the way.
    """
    counted = effective_events(events)
    trail = UndoLog().read(counted)
    cursor, node, target, since = _chosen(plan, trail, standing, path)
    for activation in trail.done(target, since):
        _require_undo(plan, activation, is_over=activation.path not in standing.active)
    before = [event for event in counted if event.seq <= since]
    book = UserdataHistory(lambda: plan)
    book.read(before)
    history = RunStateReducer(plan, run="").read(before)
    went_wrong, reason = history.course(target.rpartition("/")[0])
    return StepBack(
        cursor=cursor,
        node=node,
        target=target,
        since=since,
        plan=plan,
        trail=trail,
        former={path: {key: entry.value for key, entry in view.values.items()} for path, view in book.scopes.items()},
        went_wrong=went_wrong,
        reason=reason,
    )


def undoable(plan: Plan, activation: LeafActivation) -> Leaf | None:
    """Return the state that undoes an activation, None where there is nothing to undo; raises ControlError."""
    node = plan.nodes.get(activation.path)
    if node is None:
        raise _refused(activation, "it is not in the behavior any more")
    if activation.replaced:
        raise _refused(activation, "the behavior was changed since, and it was another state then")
    leaf = node.work
    if not isinstance(leaf, Leaf) or leaf.state.observes or leaf.state.undo is nothing_to_undo:
        return None
    if leaf.state.undo is State.undo:
        raise _refused(activation, f"{leaf.signature.name} does not declare how to undo what it did")
    return leaf


def _require_undo(plan: Plan, activation: LeafActivation, *, is_over: bool) -> None:
    leaf = undoable(plan, activation)
    if leaf is None or not is_over:
        return
    if (why := leaf.cannot_undo(activation)) != "":
        raise _refused(activation, why)


def _refused(activation: LeafActivation, why: str) -> ControlError:
    hint = "nothing was moved; go on from here, or begin a new run at an earlier event"
    return ControlError(f"there is no step back over visit {activation.visit}: {why}", where=activation.path, hint=hint)


def _chosen(plan: Plan, trail: UndoLog, standing: PausedPosition, path: str) -> tuple[str, str, str, int]:
    """Return cursor, node, target, and the event with which the run came to the target."""
    refusals: list[ControlError] = []
    found: list[tuple[int, tuple[str, str, str, int]]] = []
    for cursor in _cursors(plan, standing, path):
        try:
            node, target, since = _target(plan, trail, standing, cursor)
        except ControlError as error:
            refusals.append(error)
            continue
        newest = max((each.seq for each in trail.done(target, since)), default=since)
        found.append((newest, (cursor, node, target, since)))
    if found:
        return max(found)[1]
    if refusals:
        raise refusals[0]
    stand = [*standing.waiting, *standing.active]
    raise ControlError("nothing waits or is active there", where=path or "root", hint=did_you_mean(path, stand))


def _cursors(plan: Plan, standing: PausedPosition, path: str) -> Iterator[str]:
    """Go through the innermost nodes at which the branches stand; a tree is one of them, whatever is in it."""
    known = [each for each in (*standing.waiting, *standing.active) if each in plan.nodes]
    for each in dict.fromkeys(known):
        if (each in standing.waiting or not plan.nodes[each].work.children) and (not path or is_inside(path, each)):
            yield each


def _target(plan: Plan, trail: UndoLog, standing: PausedPosition, cursor: str) -> tuple[str, str, int]:
    node = _tree_around(plan, cursor) or cursor
    while True:
        if _has_begun(trail, standing, node):
            return node, node, trail.since(node)
        container = node.rpartition("/")[0]
        if not container:
            raise ControlError("the run stands at its beginning", where=cursor, hint="there is nothing to take back")
        kind = plan.nodes[container].work.kind
        if kind in ("machine", "priority") and (before := trail.previous(container)) is not None:
            name, since = before
            return node, f"{container}/{name}", since
        if kind == "foreach" and (rounds := trail.rounds(container)):
            raise ControlError(
                f"round {rounds + 1} has not begun, and rounds that are over are not taken back one by one",
                where=container,
                hint="go on to the end of the loop, then step back over all of it",
            )
        if kind == "concurrency":
            _require_alone(plan, trail, standing, container, node)
        node = container


def _tree_around(plan: Plan, path: str) -> str:
    """Return the outermost behavior tree around a node; empty where there is none."""
    parts = path.split("/")
    around = ("/".join(parts[:count]) for count in range(1, len(parts)))
    return next((each for each in around if each in plan.nodes and plan.nodes[each].work.kind == "tree"), "")


def _has_begun(trail: UndoLog, standing: PausedPosition, node: str) -> bool:
    waiting = standing.waiting.get(node)
    return bool(trail.done(node)) or (waiting is not None and waiting.point == "after")


def _require_alone(plan: Plan, trail: UndoLog, standing: PausedPosition, container: str, branch: str) -> None:
    """Refuse to go back over the entry of a concurrency container while another branch of it is under way.

    Branches that are over are taken back with the container.
    """
    for child in plan.nodes[container].work.children.values():
        is_standing = any(is_inside(child.path, each) for each in (*standing.waiting, *standing.active))
        if child.path != branch and is_standing and trail.done(child.path):
            raise ControlError(
                f"{branch} stands at its beginning, and {child.path} beside it has begun",
                where=container,
                hint=f"step {child.path} back first",
            )
