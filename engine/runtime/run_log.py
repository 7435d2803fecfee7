"""The events that tell of a run as a whole: how it began, what was asked of it, how it ended."""

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
    """Writes them into the event log of one run."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder

    def started(
        self, plan: Plan, parameters: Mapping[str, object], inputs: Mapping[str, object], *, seed: int, virtual: bool
    ) -> None:
        """The run begins."""
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
        """It begins in the middle, with the data of a moment of another run."""
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
        """It goes on after a crash; states that took an outcome instead of being entered again are left."""
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
        """A new version of the behavior took over."""
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
        """Somebody wants it to stop."""
        self._recorder.emit(StopRequested, reason=reason)
