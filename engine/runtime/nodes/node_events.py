"""Records the events of a node: entered, exited, diverted."""

from __future__ import annotations

from engine.errors import Cause
from engine.event import NodeDiverted, NodeEntered, NodeExited
from engine.runtime.nodes.execution import Execution


def record_entry(execution: Execution, path: str, kind: str, inputs: dict[str, object]) -> int:
    """Record the entry of a node, and return its visit number."""
    visit = execution.visits[path] = execution.visits.get(path, 0) + 1
    if (recorder := execution.recorder).heard:
        seq, time_s = recorder.stamp()
        recorder.record(NodeEntered(seq, time_s, path=path, visit=visit, kind=kind, inputs=inputs))
    else:
        recorder.count()
    execution.activity.nodes[path] = visit
    return visit


def record_exit(
    execution: Execution, path: str, visit: int, outcome: str, *, preempted: bool = False, cause: Cause | None = None
) -> None:
    """Record the exit of a node."""
    execution.activity.nodes.pop(path, None)
    if (recorder := execution.recorder).heard:
        seq, time_s = recorder.stamp()
        recorder.record(
            NodeExited(seq, time_s, path=path, visit=visit, outcome=outcome, preempted=preempted, cause=cause)
        )
    else:
        recorder.count()


def record_diverted(execution: Execution, path: str, by: str, target: str, cause: Cause | None) -> None:
    """Record that a node was diverted from the transition of its outcome."""
    visit = execution.visits.get(path, 0)
    execution.recorder.emit(NodeDiverted, path=path, visit=visit, by=by, target=target, cause=cause)
