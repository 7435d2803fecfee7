"""Records the events of a run as a whole: start, resume, hot change and stop request."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from engine.event import (
    BehaviorChanged,
    NodeExited,
    OperatorCommanded,
    RunResumed,
    RunStarted,
    StopRequested,
    UserdataWritten,
)
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.hot_change import ChangeReport, VersionSnapshot
from engine.runtime.plan import Plan
from engine.runtime.record.recorder import Recorder


class RunLog:
    """Writes these events into the event log of one run."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder

    def started(
        self, plan: Plan, parameters: Mapping[str, object], inputs: Mapping[str, object], *, seed: int, virtual: bool
    ) -> None:
        """Record the start of the run."""
        self._recorder.emit(
            RunStarted,
            behavior=plan.name,
            document=plan.document_hash,
            parameters=msgspec.to_builtins(dict(parameters)),
            inputs=msgspec.to_builtins(dict(inputs)),
            seed=seed,
            clock="virtual" if virtual else "real",
        )

    def started_from(self, checkpoint: Checkpoint) -> None:
        """Record a start from a checkpoint of another run."""
        self._recorder.emit(
            OperatorCommanded,
            command="start_from",
            path=", ".join(checkpoint.rerun),
            arguments={"run": checkpoint.run, "seq": checkpoint.seq},
        )
        for key, value in checkpoint.userdata.items():
            written = msgspec.to_builtins(value)
            self._recorder.emit(UserdataWritten, path="", scope="", key=key, value=written)

    def resumed(self, checkpoint: Checkpoint) -> None:
        """Record the resume after a crash; states with a decided outcome are exited instead of entered again."""
        self._recorder.emit(RunResumed, after_seq=checkpoint.read_seq, epoch=checkpoint.epoch, rerun=checkpoint.rerun)
        for path, outcome in checkpoint.taken.items():
            self._recorder.emit(
                NodeExited,
                path=path,
                visit=checkpoint.visits.get(path, 0),
                outcome=outcome,
                cause=checkpoint.points[path].cause,
            )

    def changed(self, document: str, report: ChangeReport, *, preempt: bool, kept: VersionSnapshot) -> None:
        """Record a hot change to a new version of the behavior."""
        self._recorder.emit(
            BehaviorChanged,
            document=document,
            report=report.changes,
            preempt=preempt,
            restarted=report.restarted,
            removed=report.removed,
            replaced=report.replaced,
            behavior=kept.behavior,
            documents=dict(kept.documents),
        )

    def stop_requested(self, reason: str) -> None:
        """Record a stop request."""
        self._recorder.emit(StopRequested, reason=reason)
