"""Reduces the events of a run, in order, to its state; live view, past, resume, coverage and progress ask it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import cast

import msgspec

from engine.cause_chain import describe_cause
from engine.event import (
    BehaviorChanged,
    BranchesPreempted,
    Event,
    GatePassed,
    GateReached,
    GoalFinished,
    GoalSent,
    MessageLogged,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    NodeRetried,
    NodeSkipped,
    OperatorCommanded,
    RunEnded,
    RunResumed,
    RunStarted,
    RunSteppedBack,
    ServiceAnswered,
    ServiceCalled,
    StatusChanged,
    TransitionTaken,
    UndoEnded,
    UndoStarted,
    UserdataAppended,
    UserdataWritten,
)
from engine.node_path import is_inside
from engine.runtime.control.autonomy import AutonomyLevel
from engine.runtime.history.effective_events import effective_events
from engine.runtime.history.run_state import IDLE, UNCHANGED, NodeLive, NodeStep, PlanLive, RunState, RunStateChange
from engine.runtime.history.run_state_part import RunStatePart
from engine.skills.planning import PlannedMotion

DIVERTED_TO_OUTCOME = ("operator", "start")
"""Values of `NodeStep.by` whose target is an outcome and not a transition target."""
# Outcomes shown as a failure if the event has no cause.
FAILURE_OUTCOMES = frozenset({"failed", "failure", "error", "errored", "aborted"})
# The answers of conditions: why one does not hold is its cause, and no failure. In trees, ticks say what fails.
_ANSWERS = frozenset({"true", "false"})
# Frequent, and of interest to parts only.
_CHANGES_NOTHING = frozenset(
    {UserdataWritten, UserdataAppended, GoalSent, ServiceCalled, ServiceAnswered, MessageLogged}
)
_TICKED = {"running": "active", "success": "done", "failure": "failed", "skipped": "skipped"}


def exit_status(event: NodeExited) -> str:
    """Return the status of an exited node: done, failed or stopped."""
    if event.preempted:
        return "stopped"
    if event.outcome in _ANSWERS:
        return "done"
    return "failed" if event.cause is not None or event.outcome in FAILURE_OUTCOMES else "done"


class RunReducer(RunStatePart):
    """Reduces the events of one run to `state`.

    Args:
        run: The id of the run.
        parts: What a view needs besides; each takes an event before `state` does.
        history: Returns the events of the run, for a resume that takes the last ones back; needed where they are not
            effective events anyway.
    """

    def __init__(
        self,
        run: str = "",
        *,
        parts: Sequence[RunStatePart] = (),
        history: Callable[[], Iterable[Event]] = tuple[Event, ...],
    ) -> None:
        self.state = RunState(run)
        self._parts = tuple(parts)
        self._history = history
        self._nodes: dict[str, NodeLive] = {}
        self._step: NodeStep | None = None
        self._run_changed = False

    def apply(self, event: Event) -> RunStateChange | None:
        """Apply the next event and return what it changed; None if it was applied before."""
        state = self.state
        if event.seq <= state.seq:
            return None
        for part in self._parts:
            part.take(event)
        if type(event) in _CHANGES_NOTHING:
            state.seq, state.time_s = event.seq, event.time_s
            return UNCHANGED
        self._nodes, self._step, self._run_changed = {}, None, False
        self.take(event)
        state = self.state
        state.seq, state.time_s = event.seq, event.time_s
        if self._nodes:
            for path in self._nodes:
                if path not in state.nodes:
                    self._note_containers(path)
            state.nodes.update(self._nodes)
        return RunStateChange(nodes=self._nodes, step=self._step, run_changed=self._run_changed)

    def copy(self) -> RunReducer:
        """Return an independent reducer of the same state, without the parts."""
        copied = RunReducer(history=self._history)
        copied.state = self.state.copy()
        return copied

    def run_started(self, event: RunStarted) -> None:
        """Take over how the run was started."""
        state = self.state
        state.real_time = event.clock == "real"
        state.seed, state.document, state.parameters = event.seed, event.document, event.parameters
        self._run_changed = True

    def run_resumed(self, event: RunResumed) -> None:
        """Return to the event after which the run was resumed."""
        self._run_changed = True
        before = self.state
        if event.after_seq >= before.seq:
            return
        known = [each for each in self._history() if each.seq < event.seq]
        if not known:
            return
        earlier = RunReducer(before.run)
        for each in effective_events(known):
            if each.seq <= event.after_seq:
                earlier.apply(each)
        self.state = earlier.state
        self._nodes = {
            path: self.state.node(path) for path, node in before.nodes.items() if self.state.node(path) != node
        }

    def node_entered(self, event: NodeEntered) -> None:
        """Activate the node; the nodes inside are reset with their container, their visit counters are kept."""
        state, path = self.state, event.path
        if path in state.containers:
            inside = f"{path}/"
            self._nodes = {
                inner: NodeLive(visits=node.visits)
                for inner, node in state.nodes.items()
                if inner.startswith(inside) and node.status != "idle"
            }
        taken = state.node(path).taken
        self._nodes[path] = NodeLive(status="active", visits=event.visit, entered_s=event.time_s, taken=taken)
        self._step = NodeStep(kind="entered", path=path)
        state.active.pop(path, None)
        state.active[path] = None
        self._proceed_from(path)

    def node_exited(self, event: NodeExited) -> None:
        """End the node, and everything inside."""
        path = event.path
        node = self._started_by(path, event.time_s)
        self._nodes[path] = msgspec.structs.replace(
            node,
            status=exit_status(event),
            visits=event.visit,
            outcome=event.outcome,
            duration_s=event.time_s - node.entered_s,
            cause=describe_cause(event.cause) if event.cause else "",
        )
        children = self._leave(path)
        if not event.preempted:
            self._await_container(path, event.outcome)
        self._step = NodeStep(
            kind="ended", path=path, name=event.outcome, is_preempted=event.preempted, children=children, before=node
        )

    def node_diverted(self, event: NodeDiverted) -> None:
        """Leave the node for a target."""
        path = event.path
        node = self.state.node(path)
        self._nodes[path] = msgspec.structs.replace(node, status="stopped", outcome=event.target)
        self._leave(path)
        self._await_container(path, event.target)
        self._step = NodeStep(kind="diverted", path=path, name=event.target, by=event.by, before=node)

    def node_skipped(self, event: NodeSkipped) -> None:
        """Pass over the node with an outcome."""
        path = event.path
        node = self.state.node(path)
        self._nodes[path] = NodeLive(status="skipped", visits=node.visits, outcome=event.outcome, taken=node.taken)
        self._await_container(path, event.outcome)
        self._step = NodeStep(kind="skipped", path=path, name=event.outcome, before=node)

    def node_retried(self, event: NodeRetried) -> None:
        """Forget the end of the last attempt; the node shows it until it is entered again."""
        self.state.active.pop(event.path, None)
        self._proceed_from(event.path)
        self._step = NodeStep(kind="retried", path=event.path)

    def branches_preempted(self, event: BranchesPreempted) -> None:
        """Note the condition; each branch ends with an event of its own."""
        is_active = event.path in self.state.active
        for path in (f"{event.path}/{name}" for name in event.branches):
            if is_active and path not in self.state.active:
                # It waited for its next attempt, or at the gate.
                self._forget_inside(path)
                self._proceed_from(path)
        self._step = NodeStep(kind="preempts", path=event.path, name=event.condition)

    def transition_taken(self, event: TransitionTaken) -> None:
        """Note the transition that a container follows."""
        node = self.state.node(event.path)
        self._nodes[event.path] = msgspec.structs.replace(node, last_transition=f"{event.source}|{event.outcome}")
        child = f"{event.path}/{event.source}"
        left = self.state.node(child)
        taken = {**left.taken, event.outcome: left.taken.get(event.outcome, 0) + 1}
        self._nodes[child] = msgspec.structs.replace(left, taken=taken)
        self._proceed_from(child)
        self._step = NodeStep(kind="transition", path=child, name=event.outcome)

    def goal_finished(self, event: GoalFinished) -> None:
        """Apply a finished goal; it changes its node only if its result is a planned path."""
        if event.result is None or "tool_path" not in event.result:
            return
        try:
            plan = msgspec.convert(event.result, PlannedMotion)
        except msgspec.ValidationError:
            return
        line = PlanLive(
            robot=plan.robot,
            duration_s=plan.duration_s,
            length_m=sum(math.dist(start, end) for start, end in pairwise(plan.tool_path)),
            found_by=plan.found_by,
            planning_s=plan.planning_s,
        )
        self._nodes[event.path] = msgspec.structs.replace(self.state.node(event.path), plan=line)

    def status_changed(self, event: StatusChanged) -> None:
        """Apply a tick status; those of composites and decorators are their visits, leaves keep their outcome.

        Whether the answer of a condition is a failure is for the tree to say.
        """
        path = event.path
        node = self.state.node(path)
        self._step = NodeStep(kind="ticked", path=path, name=event.status, before=node)
        if (node.outcome or node.cause) and event.status != "invalid":
            is_failure = event.status == "failure" and node.outcome in _ANSWERS
            self._nodes[path] = msgspec.structs.replace(node, status="failed") if is_failure else node
            return
        status = _TICKED.get(event.status, "idle")
        started = status == "active" and node.status != "active"
        self._nodes[path] = msgspec.structs.replace(
            node,
            status=status,
            visits=node.visits + started,
            entered_s=event.time_s if started else node.entered_s,
            duration_s=event.time_s - node.entered_s if status != "active" else node.duration_s,
        )

    def gate_reached(self, event: GateReached) -> None:
        """Note that what the run waits for has changed."""
        self._run_changed = True

    def gate_passed(self, event: GatePassed) -> None:
        """Note that what the run waits for has changed."""
        self._run_changed = True

    def supervision_changed(self) -> None:
        """Note that what the run waits for has changed."""
        self._run_changed = True

    def operator_commanded(self, event: OperatorCommanded) -> None:
        """Apply a command that lasts: pause, locks, autonomy."""
        self._run_changed = True
        state = self.state
        match event.command:
            case "pause":
                state.paused = True
            case "resume":
                state.paused = False
            case "lock":
                state.locks[event.path] = str(event.arguments.get("reason", ""))
            case "unlock":
                state.locks.pop(event.path, None)
            case "autonomy":
                state.autonomy = cast("AutonomyLevel", event.arguments["level"])
            case _:
                pass

    def undo_started(self, event: UndoStarted) -> None:
        """Show the node under undo as active."""
        self.state.stepping_back = event.path
        self._nodes[event.path] = NodeLive(status="active", visits=event.visit, entered_s=event.time_s)

    def undo_ended(self, event: UndoEnded) -> None:
        """Show how the undo ended; the step back follows."""
        node = self._started_by(event.path, event.time_s)
        status = "stopped" if event.preempted else "failed" if event.cause is not None else "idle"
        cause = describe_cause(event.cause) if event.cause is not None else ""
        duration_s = event.time_s - node.entered_s
        self._nodes[event.path] = msgspec.structs.replace(node, status=status, cause=cause, duration_s=duration_s)

    def run_stepped_back(self, event: RunSteppedBack) -> None:
        """Return the undone nodes to the state before their entry."""
        self._run_changed = True
        state = self.state
        state.stepping_back = ""
        if event.cause is not None:
            return
        for path, node in state.nodes.items():
            if is_inside(event.path, path) or is_inside(event.source, path):
                self._nodes[path] = NodeLive(visits=node.visits)
        parent = event.path.rpartition("/")[0]
        if parent in state.nodes:
            # The last transition of the parent leads into an undone node.
            self._nodes[parent] = msgspec.structs.replace(state.nodes[parent], last_transition="")
        for path in (event.path, event.source):
            self._drop(path)

    def behavior_changed(self, event: BehaviorChanged) -> None:
        """Take over the version; the nodes that it restarts or removes have not begun."""
        self.state.document = event.document
        for path in (*event.restarted, *event.removed):
            self._drop(path)

    def run_ended(self, event: RunEnded) -> None:
        """Stop what is still active."""
        self.state.end = event
        self._run_changed = True
        for path, node in self.state.nodes.items():
            if node.status == "active":
                duration_s = event.time_s - node.entered_s
                self._nodes[path] = msgspec.structs.replace(node, status="stopped", duration_s=duration_s)

    def _started_by(self, path: str, time_s: float) -> NodeLive:
        """Return a node that ends now; one that was never entered, or whose entry was taken back, started now."""
        node = self.state.node(path)
        return NodeLive(entered_s=time_s) if node == IDLE else node

    def _note_containers(self, path: str) -> None:
        state = self.state
        parent = path.rpartition("/")[0]
        # Never changed in place: copies share the set.
        while parent and parent not in state.containers:
            state.containers = state.containers | {parent}
            parent = parent.rpartition("/")[0]

    def _leave(self, path: str) -> dict[str, str]:
        """End a node and everything inside; return how its children had ended."""
        state = self.state
        state.active.pop(path, None)
        children = state.exits.get(path, {})
        if path in state.containers:
            self._forget_inside(path)
        return children

    def _await_container(self, path: str, name: str) -> None:
        container, _, child = path.rpartition("/")
        ended = self.state.exits.get(container)
        if ended is not None:
            ended[child] = name
        elif container:
            self.state.exits[container] = {child: name}

    def _proceed_from(self, path: str) -> None:
        container, _, child = path.rpartition("/")
        if (ended := self.state.exits.get(container)) is not None:
            ended.pop(child, None)

    def _drop(self, path: str) -> None:
        """Forget a node that has not begun, except its visits."""
        self.state.active.pop(path, None)
        self._forget_inside(path)
        self._proceed_from(path)

    def _forget_inside(self, path: str) -> None:
        state, inside = self.state, f"{path}/"
        state.exits.pop(path, None)
        for table in (state.active, state.exits):
            for inner in [key for key in table if key.startswith(inside)]:
                del table[inner]
