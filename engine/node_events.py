"""What the event log of a run hears of a node: entered, left, led elsewhere, run again, and what it says."""

from __future__ import annotations

from engine.cause import whole_text
from engine.entry import Entry
from engine.event import Cause, Diverted, Entered, Exited, Logged, Retried
from engine.execution import Execution


def record_entry(execution: Execution, path: str, kind: str, entry: Entry) -> int:
    """Record that a node is entered now, and return which activation of it this is."""
    visit = execution.visits[path] = execution.visits.get(path, 0) + 1
    recorder = execution.recorder
    if recorder.heard:
        recorder.record(
            Entered(
                seq=recorder.next_seq(),
                time_s=recorder.now_s(),
                path=path,
                visit=visit,
                kind=kind,
                inputs=entry.shown,
            )
        )
    else:
        recorder.count()
    execution.activity.nodes[path] = visit
    return visit


def record_exit(
    execution: Execution, path: str, visit: int, outcome: str, *, preempted: bool = False, cause: Cause | None = None
) -> None:
    """Record that it was left."""
    recorder = execution.recorder
    execution.activity.nodes.pop(path, None)
    if not recorder.heard:
        recorder.count()
        return
    recorder.record(
        Exited(
            seq=recorder.next_seq(),
            time_s=recorder.now_s(),
            path=path,
            visit=visit,
            outcome=outcome,
            preempted=preempted,
            cause=cause,
        )
    )


def record_diverted(execution: Execution, path: str, by: str, target: str, cause: Cause | None) -> None:
    """Record that it led elsewhere than its outcome says."""
    recorder = execution.recorder
    recorder.record(
        Diverted(
            seq=recorder.next_seq(),
            time_s=recorder.now_s(),
            path=path,
            visit=execution.visits.get(path, 0),
            by=by,
            target=target,
            cause=cause,
        )
    )


def record_retried(execution: Execution, path: str, attempt: int, wait_s: float, cause: Cause) -> None:
    """Record that it is run again, after a wait."""
    recorder = execution.recorder
    recorder.record(
        Retried(
            seq=recorder.next_seq(),
            time_s=recorder.now_s(),
            path=path,
            attempt=attempt,
            wait_s=wait_s,
            cause=cause,
        )
    )


def log(execution: Execution, path: str, message: str, *, level: str = "info") -> None:
    """Write a line into the event log of the run."""
    recorder = execution.recorder
    said = whole_text(message)
    recorder.record(Logged(seq=recorder.next_seq(), time_s=recorder.now_s(), path=path, level=level, message=said))
