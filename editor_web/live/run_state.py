"""State of one run for the page, reduced from its events: node states, taken transitions, log lines."""

from __future__ import annotations

import math
from collections import deque
from itertools import pairwise

import msgspec

from editor_web.live.event_log import LogLine, log_line, status_of
from engine.cause_chain import describe_cause
from engine.event import (
    Event,
    GatePassed,
    GateReached,
    GoalFinished,
    NodeDiverted,
    NodeEntered,
    NodeExited,
    OperatorChanged,
    OperatorCommanded,
    RunEnded,
    RunStarted,
    RunSteppedBack,
    StatusChanged,
    StopRequested,
    TransitionTaken,
    UndoEnded,
    UndoStarted,
)
from engine.node_path import is_inside
from engine.skills.planning import PlannedMotion

LOG_LINES = 1000
# The other events change no node.
_FOLDED = (RunStarted, NodeEntered, NodeExited, TransitionTaken, GoalFinished, StatusChanged, NodeDiverted, RunEnded)
# These events may change what the run waits for in the list of runs.
_RUN_CHANGING = (
    RunStarted,
    StopRequested,
    RunEnded,
    OperatorCommanded,
    GateReached,
    GatePassed,
    OperatorChanged,
    RunSteppedBack,
)


class PlanLive(msgspec.Struct, frozen=True, kw_only=True):
    """A path that a node has planned: arm, duration, length, planner, and planning time."""

    robot: str
    duration_s: float
    length_m: float
    found_by: str
    planning_s: float


class NodeLive(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One node: idle, active, done, failed or stopped.

    `visits` counts activations, so that a visit shorter than a frame is visible. Times are on the run's clock;
    `duration_s` is that of the last finished visit. `followed` is the last transition of a machine, as
    `source|outcome`. `plan` is the last path that this visit planned.
    """

    status: str = "idle"
    visits: int = 0
    outcome: str = ""
    entered_s: float = 0.0
    duration_s: float = 0.0
    cause: str = ""
    followed: str = ""
    plan: PlanLive | None = None


class RunStateChange(msgspec.Struct, frozen=True, kw_only=True):
    """The changes of one event."""

    nodes: dict[str, NodeLive]
    line: LogLine
    run_changed: bool


class LiveRun:
    """The reduced state of one run; only `apply` and `advance` change it."""

    def __init__(self, run_id: str) -> None:
        self.run_id = run_id
        self.seq = 0
        self.time_s = 0.0
        self.real_time = False
        self.ended = False
        self.lock_reasons: dict[str, str] = {}
        self.nodes: dict[str, NodeLive] = {}
        self.log: deque[LogLine] = deque(maxlen=LOG_LINES)
        self._containers: frozenset[str] = frozenset()

    def apply(self, event: Event) -> RunStateChange | None:
        """Apply one event; None if it was applied before."""
        changed = self.advance(event)
        if changed is None:
            return None
        line = log_line(event, duration_s=_duration(event, changed))
        self.log.append(line)
        return RunStateChange(nodes=changed, line=line, run_changed=isinstance(event, _RUN_CHANGING))

    def advance(self, event: Event) -> dict[str, NodeLive] | None:
        """Apply one event without a log line; return the changed nodes, None if it was applied before."""
        if event.seq <= self.seq:
            return None
        self.seq = event.seq
        self.time_s = event.time_s
        if isinstance(event, OperatorCommanded):
            self._commanded(event)
        changed = self._nodes_changed(event) if isinstance(event, _FOLDED) else self._undone(event)
        for path in changed:
            if path not in self.nodes:
                self._note_containers(path)
        self.nodes.update(changed)
        return changed

    def copy(self) -> LiveRun:
        """Return an independent copy with an empty log."""
        copied = LiveRun(self.run_id)
        copied.seq, copied.time_s, copied.real_time, copied.ended = self.seq, self.time_s, self.real_time, self.ended
        copied.lock_reasons, copied.nodes = dict(self.lock_reasons), dict(self.nodes)
        copied._containers = self._containers
        return copied

    def _note_containers(self, path: str) -> None:
        parent = path.rpartition("/")[0]
        # Never changed in place: copies share the set.
        while parent and parent not in self._containers:
            self._containers = self._containers | {parent}
            parent = parent.rpartition("/")[0]

    def _commanded(self, event: OperatorCommanded) -> None:
        if event.command == "lock":
            self.lock_reasons[event.path] = str(event.arguments.get("reason", ""))
        elif event.command == "unlock":
            self.lock_reasons.pop(event.path, None)

    def _nodes_changed(self, event: Event) -> dict[str, NodeLive]:
        if isinstance(event, RunStarted):
            self.real_time = event.clock == "real"
        if isinstance(event, NodeEntered):
            return self._entered(event)
        if isinstance(event, NodeExited):
            return {event.path: self._exited(event)}
        if isinstance(event, TransitionTaken):
            node = self.nodes.get(event.path, NodeLive())
            return {event.path: msgspec.structs.replace(node, followed=f"{event.source}|{event.outcome}")}
        if isinstance(event, GoalFinished):
            return self._planned(event)
        if isinstance(event, StatusChanged):
            return {event.path: self._status_changed(event)}
        if isinstance(event, NodeDiverted):
            node = self.nodes.get(event.path, NodeLive())
            return {event.path: msgspec.structs.replace(node, status="stopped", outcome=event.target)}
        if isinstance(event, RunEnded):
            self.ended = True
            return {
                path: msgspec.structs.replace(node, status="stopped", duration_s=event.time_s - node.entered_s)
                for path, node in self.nodes.items()
                if node.status == "active"
            }
        return {}

    def _undone(self, event: Event) -> dict[str, NodeLive]:
        """Apply an undo: a node under undo is active; an undone node has the state before its entry."""
        match event:
            case UndoStarted():
                return {event.path: NodeLive(status="active", visits=event.visit, entered_s=event.time_s)}
            case UndoEnded():
                node = self.nodes.get(event.path, NodeLive(entered_s=event.time_s))
                status = "stopped" if event.preempted else "failed" if event.cause is not None else "idle"
                cause = describe_cause(event.cause) if event.cause is not None else ""
                duration_s = event.time_s - node.entered_s
                return {event.path: msgspec.structs.replace(node, status=status, cause=cause, duration_s=duration_s)}
            case RunSteppedBack() if event.cause is None:
                return self._stepped_back(event)
            case _:
                return {}

    def _stepped_back(self, event: RunSteppedBack) -> dict[str, NodeLive]:
        changed = {
            path: NodeLive(visits=node.visits)
            for path, node in self.nodes.items()
            if is_inside(event.path, path) or is_inside(event.source, path)
        }
        parent = event.path.rpartition("/")[0]
        if parent in self.nodes:
            # The last transition of the parent leads into an undone node.
            changed[parent] = msgspec.structs.replace(self.nodes[parent], followed="")
        return changed

    def _entered(self, event: NodeEntered) -> dict[str, NodeLive]:
        changed: dict[str, NodeLive] = {}
        if event.path in self._containers:
            inside = f"{event.path}/"
            # The nodes inside are reset with their container; the visit counters are kept.
            changed = {
                path: NodeLive(visits=node.visits)
                for path, node in self.nodes.items()
                if path.startswith(inside) and node.status != "idle"
            }
        changed[event.path] = NodeLive(status="active", visits=event.visit, entered_s=event.time_s)
        return changed

    def _planned(self, event: GoalFinished) -> dict[str, NodeLive]:
        """Apply a finished goal; it changes its node only if its result is a planned path."""
        if event.result is None or "tool_path" not in event.result:
            return {}
        try:
            plan = msgspec.convert(event.result, PlannedMotion)
        except msgspec.ValidationError:
            return {}
        line = PlanLive(
            robot=plan.robot,
            duration_s=plan.duration_s,
            length_m=sum(math.dist(start, end) for start, end in pairwise(plan.tool_path)),
            found_by=plan.found_by,
            planning_s=plan.planning_s,
        )
        return {event.path: msgspec.structs.replace(self.nodes.get(event.path, NodeLive()), plan=line)}

    def _status_changed(self, event: StatusChanged) -> NodeLive:
        """Apply a tick status; composites and decorators have no visits of their own, leaves keep their outcome."""
        node = self.nodes.get(event.path, NodeLive())
        if (node.outcome or node.cause) and event.status != "invalid":
            return node
        status = {"running": "active", "success": "done", "failure": "failed"}.get(event.status, "idle")
        started = status == "active" and node.status != "active"
        return msgspec.structs.replace(
            node,
            status=status,
            visits=node.visits + started,
            entered_s=event.time_s if started else node.entered_s,
            duration_s=event.time_s - node.entered_s if status != "active" else node.duration_s,
        )

    def _exited(self, event: NodeExited) -> NodeLive:
        node = self.nodes.get(event.path, NodeLive(entered_s=event.time_s))
        return msgspec.structs.replace(
            node,
            status=status_of(event),
            visits=event.visit,
            outcome=event.outcome,
            duration_s=event.time_s - node.entered_s,
            cause=describe_cause(event.cause) if event.cause else "",
        )


def _duration(event: Event, changed: dict[str, NodeLive]) -> float:
    return changed[event.path].duration_s if isinstance(event, NodeExited) else 0.0
