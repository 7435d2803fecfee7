"""What the event log of a run hears of a node: entered, left, led elsewhere."""

from __future__ import annotations

from engine.event import Cause, NodeDiverted, NodeEntered, NodeExited
from engine.runtime.nodes.execution import Execution


def record_entry(execution: Execution, path: str, kind: str, inputs: dict[str, object]) -> int:
    """Record that a node is entered now, and return which activation of it this is."""
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
    """Record that it was left."""
    execution.activity.nodes.pop(path, None)
    if (recorder := execution.recorder).heard:
        seq, time_s = recorder.stamp()
        recorder.record(
            NodeExited(seq, time_s, path=path, visit=visit, outcome=outcome, preempted=preempted, cause=cause)
        )
    else:
        recorder.count()


def record_diverted(execution: Execution, path: str, by: str, target: str, cause: Cause | None) -> None:
    """Record that it led elsewhere than its outcome says."""
    visit = execution.visits.get(path, 0)
    execution.recorder.emit(NodeDiverted, path=path, visit=visit, by=by, target=target, cause=cause)
