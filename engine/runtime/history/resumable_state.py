"""What resume needs beside the state of a run: where containers stand, exits that wait for them, userdata scopes.

It needs the plan: initial userdata is in the document, not in the events.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import msgspec

from engine.document.nodes.node_spec import FOREACH_OUTCOMES
from engine.errors import Cause, DocumentError
from engine.event import (
    BehaviorChanged,
    BranchesPreempted,
    Event,
    GatePassed,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    NodeRetried,
    NodeSkipped,
    RunStarted,
    RunSteppedBack,
    StatusChanged,
    TransitionTaken,
    UndoStarted,
    UserdataAppended,
    UserdataWritten,
)
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.container_reason import reason_of
from engine.runtime.history.node_state import ActiveNodeState, PendingExit, exit_of
from engine.runtime.history.run_reducer import DIVERTED_TO_OUTCOME, RunReducer
from engine.runtime.history.run_state_part import RunStatePart
from engine.runtime.nodes.diagnosis import Diagnosis
from engine.runtime.nodes.foreach import ForEach
from engine.runtime.nodes.machine import Machine
from engine.runtime.nodes.node import Node, NodeWork
from engine.runtime.nodes.priority import Priority
from engine.runtime.plan import Plan
from engine.runtime.record.node_checkpoint import NodeCheckpoint
from engine.runtime.record.node_exit import guard_closed_cause
from engine.runtime.record.tree_event import TreeEvent
from engine.runtime.userdata.append_only_lists import AppendOnlyLists
from engine.wording.suggestions import did_you_mean


class ResumableState(RunStatePart):
    """Part of the state of a run from which it can be resumed.

    Nodes that a changed document no longer contains are an error only while they are active.

    Args:
        plan: The behavior.
        run: The id of the run.
    """

    def __init__(self, plan: Plan, *, run: str) -> None:
        self._reducer = RunReducer(run, parts=(self,))
        self.state = self._reducer.state
        """The state of the run."""
        self.visits: dict[str, int] = {}
        """The number of the last visit of each entered node; parts of trees, which are only ticked, have none."""
        self._plan = plan
        self._trees = frozenset(path for path, node in plan.nodes.items() if node.work.kind == "tree")
        self._open: dict[str, ActiveNodeState] = {}
        self._left: dict[str, PendingExit] = {}
        self._scopes: dict[str, dict[str, object]] = {"": dict(plan.userdata)}
        self._pending: dict[str, list[UserdataWritten | UserdataAppended]] = {}
        self._lists = AppendOnlyLists()

    def read(self, events: Iterable[Event], *, until_seq: int | None = None) -> ResumableState:
        """Apply events in order, up to and including `until_seq`; returns itself."""
        for event in events:
            if until_seq is not None and event.seq > until_seq:
                break
            self._reducer.apply(event)
        self._lists.give_away()
        return self

    @property
    def active(self) -> tuple[str, ...]:
        """The paths of the active nodes, in order of entry."""
        return tuple(self.state.active)

    @property
    def active_states(self) -> tuple[str, ...]:
        """The paths of the active states."""
        return tuple(path for path in self.active if not self._node(path).work.children)

    def course(self, path: str) -> tuple[Cause | None, Cause | None]:
        """Return the last failure among the children of an active container, and the reason of their course."""
        node = self._open.get(path)
        return (node.diagnosis.cause, node.diagnosis.reason) if node is not None else (None, None)

    def userdata(self, scope: str = "") -> Mapping[str, object]:
        """Return the values of one scope."""
        return dict(self._scopes.get(scope, {}))

    def scopes(self) -> Mapping[str, Mapping[str, object]]:
        """Return all scopes by the path of their container."""
        return {path: dict(values) for path, values in self._scopes.items()}

    def checkpoint(self, *, epoch: int = 1) -> Checkpoint:
        """Return the current state as a checkpoint; interrupted states are to be entered again.

        Raises:
            DocumentError: a node is active that the plan does not contain.
        """
        points: dict[str, NodeCheckpoint] = {}
        for path, node in self._open.items():
            points[path] = self._open_point(path, node)
        for path, left in self._left.items():
            self._node(path)
            points[path] = NodeCheckpoint(
                visit=left.visit,
                left=left.outcome,
                diverted=left.diverted,
                failed=left.outcome is None and left.diverted is None,
                cause=left.cause,
                reason=left.reason,
                passed=left.passed,
                attempt=left.attempt,
                elapsed_s=self.state.time_s - left.since_s,
            )
        return Checkpoint(
            run=self.state.run,
            seq=self.state.seq,
            read_seq=self.state.seq,
            time_s=self.state.time_s,
            userdata=self.userdata(),
            points=points,
            visits=dict(self.visits),
            parameters=self.state.parameters,
            seed=self.state.seed,
            epoch=epoch,
            rerun=self.active_states,
            stepping_back=self.state.stepping_back,
        )

    def _open_point(self, path: str, node: ActiveNodeState) -> NodeCheckpoint:
        work = self._node(path).work
        if isinstance(work, Machine | Priority) and node.current not in (None, *work.children, *work.outcomes):
            self._node(f"{path}/{node.current}")
        scope = f"{path}#{node.round}" if isinstance(work, ForEach) else path
        branches = {
            key.removeprefix(f"{path}/").removesuffix("*"): values
            for key, values in self._scopes.items()
            if key.startswith(f"{path}/") and key.endswith("*")
        }
        return NodeCheckpoint(
            visit=node.visit,
            entered=path in self.state.active,
            attempt=node.attempt,
            elapsed_s=self.state.time_s - node.since_s,
            inputs=node.inputs,
            current=node.current,
            cause=node.diagnosis.cause,
            reason=node.diagnosis.reason,
            values=dict(self._scopes.get(scope, {})),
            branches=branches,
            preempted=dict(node.preempted),
            failed_clean_ups=dict(node.failed_clean_ups),
            round=node.round,
            done=tuple(node.done),
        )

    def _node(self, path: str) -> Node:
        node = self._plan.nodes.get(path)
        if node is None:
            raise DocumentError(
                "this node is active and the behavior does not contain it",
                where=path,
                hint=f"the document has changed since; {did_you_mean(path, self._plan.nodes)}",
            )
        return node

    def _work(self, path: str) -> NodeWork | None:
        node = self._plan.nodes.get(path)
        return node.work if node is not None else None

    def run_started(self, event: RunStarted) -> None:
        """Take over the inputs."""
        self._scopes[""].update(event.inputs)

    def node_entered(self, event: NodeEntered) -> None:
        """Open the node and its scope."""
        path = event.path
        self.visits[path] = event.visit
        self._add_tree_event(path, "entered", event.time_s)
        previous = self._open.pop(path, None)
        self._left.pop(path, None)
        self._pending.pop(path, None)
        is_retry = path not in self.state.active
        self._open[path] = ActiveNodeState(
            visit=event.visit,
            inputs=event.inputs,
            since_s=previous.since_s if previous is not None else event.time_s,
            attempt=previous.attempt if previous is not None and is_retry else 1,
        )
        container = self._open.get(path.rpartition("/")[0])
        if container is not None:
            container.current = path.rpartition("/")[2]
        work = self._work(path)
        if isinstance(work, ForEach):
            self._begin_round(path, work, event.inputs, 0)
        else:
            self._scopes[path] = dict(work.initial_values(event.inputs)) if work is not None else {}

    def _begin_round(self, path: str, work: ForEach, inputs: Mapping[str, object], number: int) -> None:
        items = work.items_of(inputs)
        self._scopes.pop(f"{path}#{number - 1}", None)
        if number < len(items):
            self._scopes[f"{path}#{number}"] = work.round_values(number, items[number])

    def value_written(self, event: UserdataWritten | UserdataAppended) -> None:
        """Take a write; it applies when the node ends, as a node that is entered again writes again."""
        if isinstance(event, UserdataWritten) and event.post:
            self._add_tree_event(event.path, f"assigned {event.post}", event.time_s)
        own = f"{event.path}*"
        # The merge of a branch that is still being stopped, or the write of a post-condition, applies at once.
        merged = own in self._scopes and event.scope != own
        post = isinstance(event, UserdataWritten) and bool(event.post)
        if event.path in self._open and event.path != event.scope and not (merged or post):
            self._pending.setdefault(event.path, []).append(event)
        else:
            self._keep(event)

    def _commit_writes(self, path: str) -> None:
        for event in self._pending.pop(path, ()):
            self._keep(event)

    def _keep(self, event: UserdataWritten | UserdataAppended) -> None:
        values = self._scopes.setdefault(event.scope, {})
        values[event.key] = self._lists.value_after(event, values.get(event.key))

    def node_exited(self, event: NodeExited) -> None:
        """Close the node; its container takes the exit with its next transition."""
        path = event.path
        if self._trees:
            what = "invalid" if event.preempted else f"outcome {event.outcome}" if event.outcome else "failed"
            self._add_tree_event(path, what, event.time_s)
        self._commit_writes(path)
        node = self._open.pop(path, None)
        outcome = event.outcome or None
        reason = reason_of(self._work(path), path, outcome, node, self._left)
        self._forget_inside(path)
        if event.preempted:
            if (container := self._open.get(path.rpartition("/")[0])) is not None:
                container.take_clean_up(event)
            return
        attempt, since_s = (node.attempt, node.since_s) if node is not None else (1, event.time_s)
        self._left[path] = PendingExit(
            event.visit, outcome, None, event.cause, reason, attempt=attempt, since_s=since_s
        )

    def branches_preempted(self, event: BranchesPreempted) -> None:
        """Take preempted branches; one that waited between two attempts, or at the gate, has ended with that."""
        container = self._open.get(event.path)
        if container is None:
            return
        container.preempted[event.condition] = event.branches
        for path in (f"{event.path}/{name}" for name in event.branches):
            if path not in self.state.active:
                self._drop(path)

    def node_diverted(self, event: NodeDiverted) -> None:
        """Close the node; its container takes the target."""
        path = event.path
        self._open.pop(path, None)
        self._forget_inside(path)
        by_outcome = event.by in DIVERTED_TO_OUTCOME
        # An operator names an outcome; timeout, guard and on_error name a status.
        self._add_tree_event(path, f"{'outcome' if by_outcome else 'target'} {event.target}", event.time_s)
        outcome, target = (event.target, None) if by_outcome else (None, event.target)
        reason = guard_closed_cause(path) if event.by == "guard" else None
        self._left[path] = PendingExit(event.visit, outcome, target, event.cause, reason)

    def node_skipped(self, event: NodeSkipped) -> None:
        """Let the container take the outcome; a resumed run passes over the node again."""
        self._left[event.path] = PendingExit(self.visits.get(event.path, 0), event.outcome, None, None, None)

    def node_retried(self, event: NodeRetried) -> None:
        """Open the node again, not entered yet."""
        self._add_tree_event(event.path, f"attempt {event.attempt}", event.time_s)
        if event.path not in self._plan.nodes:
            return  # a decorator of a tree, covered by its tree events
        left = self._left.pop(event.path, None)
        since_s = left.since_s if left is not None else event.time_s
        self._open[event.path] = ActiveNodeState(self.visits.get(event.path, 0), {}, since_s, attempt=event.attempt)

    def transition_taken(self, event: TransitionTaken) -> None:
        """Let the container proceed, and keep how its child had ended."""
        left = self._left.pop(f"{event.path}/{event.source}", None)
        self._commit_writes(event.path)
        container = self._open.get(event.path)
        if container is None:
            return
        container.current = event.target
        child = self._plan.nodes.get(f"{event.path}/{event.source}")
        if left is not None and child is not None:
            container.diagnosis.take(child, exit_of(left))
        work = self._work(event.path)
        if isinstance(work, ForEach) and event.target not in FOREACH_OUTCOMES:
            container.round += 1
            self._begin_round(event.path, work, container.inputs, container.round)

    def status_changed(self, event: StatusChanged) -> None:
        """Add the status to the tree; a parallel that ended has merged its branches, or was halted."""
        self._add_tree_event(event.path, event.status, event.time_s)
        if event.status != "running":
            self._forget_branches(event.path)

    def gate_passed(self, event: GatePassed) -> None:
        """Release the exit of a node."""
        if event.point == "after" and event.path in self._left:
            self._left[event.path] = msgspec.structs.replace(self._left[event.path], passed=True)

    def behavior_changed(self, event: BehaviorChanged) -> None:
        """Drop what the new version restarts or removes."""
        for path in event.removed:
            # Its writes were merged just before.
            self._scopes.pop(f"{path}*", None)
            above, _, name = path.rpartition("/")
            if (container := self._open.get(above)) is not None:
                container.forget_branch(name)
        for path in (*event.restarted, *event.removed):
            self._drop(path)

    def _drop(self, path: str) -> None:
        """Drop the state of a node that has not begun, except its visit count."""
        self._forget_inside(path)
        for table in (self._open, self._left, self._pending):
            table.pop(path, None)

    def undo_started(self, event: UndoStarted) -> None:
        """Count the undo as a visit."""
        self.visits[event.path] = event.visit

    def run_stepped_back(self, event: RunSteppedBack) -> None:
        """Restore userdata and the course of the container."""
        if event.cause is not None:
            return
        for path in (event.path, event.source):
            self._drop(path)
        for each in event.values:
            values = self._scopes.setdefault(each.scope, {})
            if each.defined:
                values[each.key] = each.value
            else:
                values.pop(each.key, None)
        container = self._open.get(event.path.rpartition("/")[0])
        if container is not None:
            container.current = event.path.rpartition("/")[2]
            container.diagnosis = Diagnosis(event.went_wrong, event.reason)

    def _add_tree_event(self, path: str, what: str, at_s: float) -> None:
        """Add what happened to a tree node or leaf to the tree around it."""
        if not self._trees:
            return
        above = path
        while above := above.rpartition("/")[0]:
            node = self._open.get(above)
            if node is None:
                continue
            if above in self._trees:
                node.done.append(TreeEvent(path, what, at_s))
            return

    def _forget_branches(self, path: str) -> None:
        for key in [key for key in self._scopes if key.endswith("*") and key.rpartition("/")[0] == path]:
            del self._scopes[key]

    def _forget_inside(self, path: str) -> None:
        """Drop the state inside a node that was exited."""
        self._scopes.pop(path, None)
        if path not in self.state.containers and not isinstance(self._work(path), ForEach):
            return  # nothing was entered inside, nor a round begun
        inside = (f"{path}/", f"{path}#")
        for table in (self._open, self._left, self._scopes):
            for inner in [key for key in table if key.startswith(inside)]:
                del table[inner]
