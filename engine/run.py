"""A run: one execution of one behavior, from start to a reported outcome, stoppable at any moment."""

from __future__ import annotations

import asyncio
import random
from collections.abc import Mapping
from dataclasses import dataclass

import msgspec

from engine.bus import SkillBus
from engine.cause import cause_of, under
from engine.errors import FlexcellError, JournalError
from engine.event import Cause, RunEnded, RunStarted, StopRequested
from engine.execution import Execution
from engine.node import Left, explain, log
from engine.plan import Plan
from engine.recorder import EventSink, MemorySink, Recorder, Watcher
from engine.skill_port import BusPort, SkillPort
from engine.userdata import Scope


@dataclass(frozen=True, kw_only=True)
class RunResult:
    """How a run ended: `status` is finished, stopped or errored; `success` only for a declared outcome."""

    run: str
    behavior: str
    status: str
    outcome: str | None
    success: bool
    cause: Cause | None
    duration_s: float
    userdata: Mapping[str, object]


class Run:
    """One execution of one plan on a bus; made and used on the loop thread."""

    def __init__(
        self,
        plan: Plan,
        *,
        run: str,
        bus: SkillBus,
        parameters: Mapping[str, object] | None = None,
        inputs: Mapping[str, object] | None = None,
        seed: int = 0,
        journal: EventSink | None = None,
        skills: SkillPort | None = None,
        instant_limit: int = 10_000,
    ) -> None:
        self.id = run
        self.plan = plan
        self.seed = seed
        self.parameters = plan.checked_parameters(parameters or {})
        self._inputs = plan.checked_inputs(inputs or {})
        self._recorder = Recorder(bus.clock, journal or MemorySink())
        self._execution = Execution(
            run=run,
            bus=bus,
            clock=bus.clock,
            recorder=self._recorder,
            random=random.Random(seed),
            skills=skills or BusPort(bus),
            instant_limit=instant_limit,
        )
        self._task: asyncio.Task[Left] | None = None
        self._stop_reason: str | None = None
        self._ended = False
        self._cancelled = False

    def watch(self, watcher: Watcher) -> None:
        """Call `watcher` with every event of this run, on the loop thread."""
        self._recorder.watch(watcher)

    def stop(self, reason: str) -> None:
        """Preempt everything; `execute` returns when all clean-up is done and the robots rest.

        Before the start it prevents the start; later calls and calls after the end do nothing.
        """
        if self._stop_reason is not None or self._ended:
            return
        self._stop_reason = reason
        if self._task is not None:
            self._record_stop(reason)
            self._task.cancel()

    async def execute(self) -> RunResult:
        """Run to the end and report it; never raises for what happens inside the behavior.

        Cancelling this call stops the run and waits for its clean-up before CancelledError goes on.
        """
        started_s = self._execution.clock.now_s()
        scope = Scope("", {**self.plan.userdata, **self._inputs}, Scope("parameters", self.parameters))
        self._record_start()
        status, left, cause = await self._perform(scope)
        await self._execution.bus.cancel_goals(self.id)
        self._execution.bus.leases.release_run(self.id)
        outcome = (left.target or left.outcome) if left is not None else None
        success = outcome in self.plan.success
        if left is not None and not success:
            cause = explain(self.plan.root, left)
        self._ended = True
        cause = await self._record_end(status, outcome, cause)
        if self._cancelled:
            raise asyncio.CancelledError
        return RunResult(
            run=self.id,
            behavior=self.plan.name,
            status="errored" if cause is not None and cause.kind == "JournalError" else status,
            outcome=outcome,
            success=success and status == "finished",
            cause=cause,
            duration_s=round(self._execution.clock.now_s() - started_s, 6),
            userdata=scope.own_values(),
        )

    async def _perform(self, scope: Scope) -> tuple[str, Left | None, Cause | None]:
        if self._stop_reason is not None:
            self._record_stop(self._stop_reason)
            return "stopped", None, self._stopped()
        self._task = asyncio.create_task(self.plan.root.perform(scope, self._execution), name=f"run {self.id}")
        while True:
            try:
                await asyncio.wait({self._task})
            except asyncio.CancelledError:
                self._cancelled = True
                self.stop("the process that ran it was stopped")
                continue
            try:
                return "finished", self._task.result(), None
            except asyncio.CancelledError:
                return "stopped", None, self._stopped()
            except FlexcellError as error:
                if self._stop_reason is not None:
                    return "stopped", None, under(self._stopped().message, cause_of(error), kind="Stopped")
                return "errored", None, cause_of(error)
            except Exception as error:
                # A custom state may raise anything; it ends the run with its cause, not the engine.
                log(self._execution, self.plan.root.path, f"{type(error).__name__}: {error}", level="error")
                return "errored", None, cause_of(error)

    def _stopped(self) -> Cause:
        return Cause(message=f"stopped: {self._stop_reason or 'cancelled'}", where=self.plan.root.path, kind="Stopped")

    def _record_start(self) -> None:
        self._recorder.record(
            RunStarted(
                seq=self._recorder.next_seq(),
                time_s=self._recorder.now_s(),
                behavior=self.plan.name,
                document=self.plan.document_hash,
                parameters=msgspec.to_builtins(dict(self.parameters)),
                seed=self.seed,
                clock="virtual" if self._execution.clock.virtual else "real",
            )
        )

    def _record_stop(self, reason: str) -> None:
        self._recorder.record(
            StopRequested(seq=self._recorder.next_seq(), time_s=self._recorder.now_s(), reason=reason)
        )

    async def _record_end(self, status: str, outcome: str | None, cause: Cause | None) -> Cause | None:
        self._recorder.record(
            RunEnded(
                seq=self._recorder.next_seq(),
                time_s=self._recorder.now_s(),
                status=status,
                outcome=outcome,
                cause=cause,
            )
        )
        try:
            await self._recorder.commit()
        except JournalError as error:
            return cause_of(error)
        return cause
