"""A run of a session: its task, its state and its result."""

from __future__ import annotations

import asyncio
from collections.abc import Collection, Iterable, Iterator, Mapping

import msgspec

from engine.cause_chain import describe_cause
from engine.errors import FlexcellError
from engine.event import Event
from engine.journal import RunRecord
from engine.project.cell_runner import PreparedRun
from engine.runtime.history.live_run import LiveRun
from engine.runtime.history.run_view import RunView, run_duration_s
from engine.runtime.nodes.leaf import Leaf
from engine.runtime.nodes.node import NodeWork
from engine.runtime.run_result import RunResult
from engine.wording.suggestions import did_you_mean

_KEPT_RUNS = 200


class InterruptedRun(msgspec.Struct, frozen=True, kw_only=True):
    """A run of the journal whose process died after event `last_seq`; it can be resumed."""

    id: str
    behavior: str
    started_unix_s: float
    last_seq: int


class SessionRun:
    """One run, active or ended; used on the session's event loop.

    Args:
        behavior_id: The behavior that it executes.
        prepared: The run.
        events: The events before this session, if the run was resumed.
    """

    def __init__(self, behavior_id: str, prepared: PreparedRun, *, events: Iterable[Event] = ()) -> None:
        self.behavior_id = behavior_id
        self.run = prepared.run
        self._prepared = prepared
        self.live = LiveRun(prepared.run.id, events)
        self.stopping = False
        self.result: RunResult | None = None
        self.task: asyncio.Task[None] | None = None

    async def execute(self) -> None:
        """Execute the run to its end and keep its result."""
        self.result = await self._prepared.execute()

    def stop(self, reason: str) -> None:
        """Request the run to stop and return immediately; has no effect on a run that has ended."""
        if self.result is None:
            self.stopping = True
            self.run.stop(reason)

    def executes_classes_of(self, modules: Collection[str]) -> bool:
        """Return whether it has not ended and has states or py_trees behaviours of these modules."""
        nodes = self.run.plan.nodes.values() if self.result is None and modules else ()
        return any(kind.__module__ in modules for node in nodes for kind in _classes(node.work))

    def view(self) -> RunView:
        """Return the status of the run now."""
        result = self.result
        control = self.run.control.view() if result is None and not self.run.ended else None
        # The time of a paused run stands.
        advances = control is not None and not control.time_stands
        return RunView(
            id=self.run.id,
            behavior=self.behavior_id,
            status=result.status if result else ("stopping" if self.stopping else "running"),
            outcome=result.outcome if result else None,
            success=result.success if result else False,
            cause=describe_cause(result.cause) if result and result.cause and not result.success else "",
            started_at_s=self._prepared.started_unix_s,
            duration_s=self.run.recorder.now_s() if advances else run_duration_s(self.live.last),
            waits=control.waits if control is not None else "",
            ticking=advances and self.live.state.real_time,
        )


def _classes(work: NodeWork) -> Iterator[type]:
    """Yield the classes that a node executes itself."""
    if isinstance(work, Leaf):
        yield work.state
    elif work.kind == "tree":
        # Imported on demand: py_trees loads slowly, and most behaviors have no tree.
        from engine.runtime.tree.tree import Tree

        parts = work.root.walk() if isinstance(work, Tree) else ()
        yield from (part.foreign.kind for part in parts if part.foreign is not None)


def interrupted_run(record: RunRecord) -> InterruptedRun:
    """Return what a person has to know of an interrupted run; the journal knows more."""
    return InterruptedRun(
        id=record.id, behavior=record.behavior, started_unix_s=record.started_unix_s, last_seq=record.last_seq
    )


def known_run(runs: Mapping[str, SessionRun], run_id: str) -> SessionRun:
    """Return a run; raises FlexcellError with similar ids if there is no such run."""
    if run_id not in runs:
        raise FlexcellError(f"there is no run {run_id!r}", hint=did_you_mean(run_id, runs))
    return runs[run_id]


def forget_oldest(runs: dict[str, SessionRun]) -> None:
    """Limit the number of ended runs in memory; the journal keeps every run."""
    ended = [run_id for run_id, started in runs.items() if started.result is not None]
    for run_id in ended[: max(0, len(runs) - _KEPT_RUNS)]:
        del runs[run_id]
