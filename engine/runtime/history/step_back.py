"""Plans one step back of a paused run, or states why it is impossible; changes nothing.

It undoes the node that started last and was not undone yet, in one branch: a node that has begun is undone and waits
before its entry again; where the node has not begun, its predecessor in the machine is undone. The activations inside
are undone in reverse order, so each of them must declare an undo.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from engine.errors import Cause, ControlError
from engine.event import Event
from engine.node_path import is_inside
from engine.runtime.control.gate import GateWait
from engine.runtime.history.effective_events import effective_events
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.history.undo_log import UndoLog
from engine.runtime.history.userdata_history import UserdataHistory
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.plan import Plan
from engine.runtime.record.leaf_activation import LeafActivation
from engine.state import State, nothing_to_undo
from engine.wording.suggestions import did_you_mean


@dataclass(frozen=True, kw_only=True)
class PausedPosition:
    """Position of a paused run: the nodes that wait at the gate, and those that were entered and not exited."""

    waiting: Mapping[str, GateWait]
    active: Mapping[str, int]


@dataclass(frozen=True, kw_only=True)
class StepBack:
    """One planned step back: `node` is preempted, and the run then waits before `target`."""

    cursor: str
    """The node that waits or is active in the branch."""
    node: str
    target: str
    since: int
    """The event with which the run reached `target`."""
    plan: Plan
    undo_log: UndoLog
    former: Mapping[str, Mapping[str, object]]
    """The userdata scopes at that event."""
    went_wrong: Cause | None
    reason: Cause | None

    @property
    def undone(self) -> tuple[LeafActivation, ...]:
        """The activations to undo, in this order."""
        return self.undo_log.done(self.target, self.since)


def plan_step_back(plan: Plan, events: Sequence[Event], position: PausedPosition, *, path: str = "") -> StepBack:
    """Plan the next step back of a paused run.

    Args:
        plan: The current plan of the run.
        events: All events of the run.
        position: The position of the run.
        path: The branch; by default the one in which something started last.

    Raises:
        ControlError: no node in that branch can be undone; the message states the reason.
    """
    effective = effective_events(events)
    undo_log = UndoLog().read(effective)
    cursor, node, target, since = _chosen(plan, undo_log, position, path)
    for activation in undo_log.done(target, since):
        _require_undo(plan, activation, is_over=activation.path not in position.active)
    before = [event for event in effective if event.seq <= since]
    userdata = UserdataHistory(lambda: plan)
    userdata.read(before)
    history = ResumableState(plan, run="").read(before)
    went_wrong, reason = history.course(target.rpartition("/")[0])
    return StepBack(
        cursor=cursor,
        node=node,
        target=target,
        since=since,
        plan=plan,
        undo_log=undo_log,
        former={
            path: {key: entry.value for key, entry in view.values.items()} for path, view in userdata.scopes.items()
        },
        went_wrong=went_wrong,
        reason=reason,
    )


def undoable(plan: Plan, activation: LeafActivation) -> Leaf | None:
    """Return the state that undoes an activation; None where there is nothing to undo; raises ControlError."""
    node = plan.nodes.get(activation.path)
    if node is None:
        raise _refused(activation, "the behavior no longer contains it")
    if activation.replaced:
        raise _refused(activation, "a hot change has replaced its state class since")
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
    hint = "nothing has moved; continue from here, or start a new run at an earlier event"
    return ControlError(f"cannot step back over visit {activation.visit}: {why}", where=activation.path, hint=hint)


def _chosen(plan: Plan, undo_log: UndoLog, position: PausedPosition, path: str) -> tuple[str, str, str, int]:
    """Return cursor, node, target, and the event with which the run reached the target."""
    refusals: list[ControlError] = []
    options: list[tuple[int, tuple[str, str, str, int]]] = []
    for cursor in _cursors(plan, position, path):
        try:
            node, target, since = _target(plan, undo_log, position, cursor)
        except ControlError as error:
            refusals.append(error)
            continue
        latest = max((each.seq for each in undo_log.done(target, since)), default=since)
        options.append((latest, (cursor, node, target, since)))
    if options:
        return max(options)[1]
    if refusals:
        raise refusals[0]
    candidates = [*position.waiting, *position.active]
    raise ControlError("no node waits or is active there", where=path or "root", hint=did_you_mean(path, candidates))


def _cursors(plan: Plan, position: PausedPosition, path: str) -> Iterator[str]:
    """Yield the innermost nodes at which the branches wait or are active; a tree counts as one node."""
    known = [each for each in (*position.waiting, *position.active) if each in plan.nodes]
    for each in dict.fromkeys(known):
        if (each in position.waiting or not plan.nodes[each].work.children) and (not path or is_inside(path, each)):
            yield each


def _target(plan: Plan, undo_log: UndoLog, position: PausedPosition, cursor: str) -> tuple[str, str, int]:
    node = _tree_around(plan, cursor) or cursor
    while True:
        if _has_begun(undo_log, position, node):
            return node, node, undo_log.since(node)
        container = node.rpartition("/")[0]
        if not container:
            raise ControlError("the run is at its beginning", where=cursor, hint="there is nothing to undo")
        kind = plan.nodes[container].work.kind
        if kind in ("machine", "priority") and (before := undo_log.previous(container)) is not None:
            name, since = before
            return node, f"{container}/{name}", since
        if kind == "foreach" and (rounds := undo_log.rounds(container)):
            raise ControlError(
                f"round {rounds + 1} has not begun, and completed rounds cannot be undone one by one",
                where=container,
                hint="continue to the end of the loop, then step back over the whole loop",
            )
        if kind == "concurrency":
            _require_alone(plan, undo_log, position, container, node)
        node = container


def _tree_around(plan: Plan, path: str) -> str:
    """Return the path of the outermost behavior tree around a node; empty where there is none."""
    parts = path.split("/")
    around = ("/".join(parts[:count]) for count in range(1, len(parts)))
    return next((each for each in around if each in plan.nodes and plan.nodes[each].work.kind == "tree"), "")


def _has_begun(undo_log: UndoLog, position: PausedPosition, node: str) -> bool:
    waiting = position.waiting.get(node)
    return bool(undo_log.done(node)) or (waiting is not None and waiting.point == "after")


def _require_alone(plan: Plan, undo_log: UndoLog, position: PausedPosition, container: str, branch: str) -> None:
    """Refuse to undo the entry of a concurrency container while another branch of it is active.

    Branches that have ended are undone with the container.
    """
    for child in plan.nodes[container].work.children.values():
        is_occupied = any(is_inside(child.path, each) for each in (*position.waiting, *position.active))
        if child.path != branch and is_occupied and undo_log.done(child.path):
            raise ControlError(
                f"{branch} is at its beginning, and the parallel branch {child.path} has begun",
                where=container,
                hint=f"step {child.path} back first",
            )
