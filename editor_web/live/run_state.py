"""What the page shows of one run, folded from its events: node states, taken transitions, log lines."""

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
# The others change no node.
_FOLDED = (RunStarted, NodeEntered, NodeExited, TransitionTaken, GoalFinished, StatusChanged, NodeDiverted, RunEnded)
# After these the list of runs may have another word on what the run waits for.
_TURNS = (
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
    """A way that a node has planned: for which arm, how long it takes and is, who found it, and in what time."""

    robot: str
    duration_s: float
    length_m: float
    found_by: str
    planning_s: float


class NodeLive(msgspec.Struct, frozen=True, kw_only=True, gc=False):
    """One node: idle, active, done, failed or stopped.

    `visits` counts activations, so a visit shorter than a frame is still seen. Times are on the
    run's clock; `duration_s` is of the last finished visit. `followed` is the arrow that a machine
    took last, as `source|outcome`. `plan` is the way that this visit has planned last.
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
    """What one event changed."""

    nodes: dict[str, NodeLive]
    line: LogLine
    run_changed: bool


class LiveRun:
    """The folded state of one run; `apply` is the only way it changes."""

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
        """Fold one event in; None when it was already."""
        changed = self.advance(event)
        if changed is None:
            return None
        line = log_line(event, duration_s=_duration(event, changed))
        self.log.append(line)
        return RunStateChange(nodes=changed, line=line, run_changed=isinstance(event, _TURNS))

    def advance(self, event: Event) -> dict[str, NodeLive] | None:
        """Fold one event in, without a line in the log; the nodes that it changed, None when it was already."""
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
        """Return one that goes on from here by itself, its log empty."""
        made = LiveRun(self.run_id)
        made.seq, made.time_s, made.real_time, made.ended = self.seq, self.time_s, self.real_time, self.ended
        made.lock_reasons, made.nodes = dict(self.lock_reasons), dict(self.nodes)
        made._containers = self._containers
        return made

    def _note_containers(self, path: str) -> None:
        above = path.rpartition("/")[0]
        # Never changed in place: copies share it.
        while above and above not in self._containers:
            self._containers = self._containers | {above}
            above = above.rpartition("/")[0]

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
        """A node that is being undone is active; one that was taken back is as if it had never been entered."""
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
                return self._taken_back(event)
            case _:
                return {}

    def _taken_back(self, event: RunSteppedBack) -> dict[str, NodeLive]:
        changed = {
            path: NodeLive(visits=node.visits)
            for path, node in self.nodes.items()
            if is_inside(event.path, path) or is_inside(event.source, path)
        }
        above = event.path.rpartition("/")[0]
        if above in self.nodes:
            # The arrow that was taken last leads into what was taken back.
            changed[above] = msgspec.structs.replace(self.nodes[above], followed="")
        return changed

    def _entered(self, event: NodeEntered) -> dict[str, NodeLive]:
        changed: dict[str, NodeLive] = {}
        if event.path in self._containers:
            inside = f"{event.path}/"
            # What lies inside starts afresh with its container; the counters go on.
            changed = {
                path: NodeLive(visits=node.visits)
                for path, node in self.nodes.items()
                if path.startswith(inside) and node.status != "idle"
            }
        changed[event.path] = NodeLive(status="active", visits=event.visit, entered_s=event.time_s)
        return changed

    def _planned(self, event: GoalFinished) -> dict[str, NodeLive]:
        """A finished goal matters to its node only where its result is a way."""
        if event.result is None or "tool_path" not in event.result:
            return {}
        try:
            plan = msgspec.convert(event.result, PlannedMotion)
        except msgspec.ValidationError:
            return {}
        line = PlanLive(
            robot=plan.robot,
            duration_s=plan.duration_s,
            length_m=sum(math.dist(here, there) for here, there in pairwise(plan.tool_path)),
            found_by=plan.found_by,
            planning_s=plan.planning_s,
        )
        return {event.path: msgspec.structs.replace(self.nodes.get(event.path, NodeLive()), plan=line)}

    def _status_changed(self, event: StatusChanged) -> NodeLive:
        """A composite or decorator of a behavior tree has no visits of its own; how a leaf has ended is known."""
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
