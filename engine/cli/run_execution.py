"""Carries out one run for the command line: its clock, cell, journal, recording, signals, and its end."""

from __future__ import annotations

import asyncio
import gc
import os
import sys
import time
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import AbstractAsyncContextManager, ExitStack, nullcontext
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeVar

from rich.console import Console

from engine.cell.open_cell import OpenCell
from engine.cli.exit_code import ExitCode
from engine.cli.interrupt_handling import InterruptHandler
from engine.cli.operator_console import OperatorConsole
from engine.cli.progress_printer import ProgressPrinter
from engine.clock import VirtualLoop, VirtualTimeDeadlock, run_virtual
from engine.document.cell import Cell
from engine.document.faults import Faults
from engine.errors import FlexcellError
from engine.event import Event
from engine.faults import FaultPort
from engine.host.gc_pause import gc_paused
from engine.host.thread_switch_interval import short_switch_interval
from engine.journal import Journal, NullJournal
from engine.recording import RecordingOptions, RunRecording
from engine.runtime.plan import Plan
from engine.runtime.record.recorder import Watcher
from engine.runtime.record.skill_port import BusPort, SkillPort
from engine.runtime.run import Run, RunResult
from engine.runtime.run_options import RunOptions
from engine.runtime.watchdog import LoopWatchdog
from engine.stop import StopNotice, StopRelay

T = TypeVar("T")
MakeRun = Callable[[OpenCell, Journal | NullJournal, SkillPort | None], Awaitable[Run]]
"""Makes the run, new or resumed, in an open cell and journal; what it refuses was not started."""


@dataclass(frozen=True, kw_only=True)
class RunSetup:
    """Everything around a run, read and checked before anything starts."""

    make: MakeRun
    cell: Cell | None
    seed: int | None
    journal: str
    store: str | None
    timeout_s: float | None
    virtual: bool
    quiet: bool
    supervision: RunOptions = field(default_factory=RunOptions)
    inputs: dict[str, object] = field(default_factory=dict[str, object])
    recording: RecordingOptions | None = None
    faults: Faults | None = None
    watchers: tuple[Watcher, ...] = ()
    reload: Callable[[], Plan] | None = None
    """With an operator on the terminal: reads the behavior anew for a hot change."""


@dataclass(kw_only=True)
class ExecutionResult:
    """How a run ended, with its events."""

    result: RunResult
    log: list[Event]
    interrupted: bool

    @property
    def exit_code(self) -> ExitCode:
        """What the process says of it."""
        if self.interrupted and not self.result.abandoned:
            return ExitCode.INTERRUPTED
        return exit_code(self.result)


def exit_code(result: RunResult) -> ExitCode:
    """Return what the process says of a run that was not interrupted."""
    if result.status == "errored":
        return ExitCode.ERRORED
    return ExitCode.SUCCESS if result.success else ExitCode.OTHER_OUTCOME


def execute_run(order: RunSetup, *, report: Callable[[ExecutionResult], None]) -> ExitCode:
    """Execute a run to its end, report it, and return the exit code.

    A state that was abandoned may never end, and with it the loop: such a process ends right after
    the report, with the cell at rest and the journal closed.

    Raises:
        FlexcellError: nothing was started.
    """

    async def main() -> ExecutionResult:
        ended = await _execute(order)
        if ended.result.abandoned:
            code = _reported(ended, report)
            _say(f"abandoned: {', '.join(ended.result.abandoned)}; the process ends without waiting for it")
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
        return ended

    ended = _on_clock(main(), virtual=order.virtual)
    return _reported(ended, report)


def _reported(ended: ExecutionResult, report: Callable[[ExecutionResult], None]) -> ExitCode:
    """Report a run and return the exit code; it has been, whatever becomes of the report."""
    try:
        report(ended)
    except FlexcellError as error:
        _say(str(error))
        return ended.exit_code or ExitCode.ERRORED
    return ended.exit_code


def _on_clock(main: Coroutine[Any, Any, T], *, virtual: bool) -> T:
    return run_virtual(main) if virtual else asyncio.run(main)


async def _execute(order: RunSetup) -> ExecutionResult:
    log: list[Event] = []
    over = asyncio.Event()
    with ExitStack() as stack:
        opening = stack.enter_context(ExitStack())
        opening.enter_context(gc_paused())
        interruption = stack.enter_context(InterruptHandler(_say))
        journal = _journal(order, stack)
        async with (
            _recording(order) as recording,
            _relay(order) as relay,
            OpenCell(order.cell, seed=order.seed, store_path=order.store, relay=relay) as cell,
        ):
            if relay is not None:
                stack.enter_context(relay.watched_signals())
            started_unix_s = time.time()
            faults = _faults(order, cell)
            run = await order.make(cell, journal, faults)
            if recording is not None:
                recording.attach(
                    run, cell.bus, started_unix_s=started_unix_s, inputs=order.inputs, supervision=order.supervision
                )
            for watcher in (log.append, *order.watchers):
                run.watch(watcher)
            if not order.quiet:
                run.watch(ProgressPrinter(Console(stderr=True)).show)
            interruption.watch_over(run)
            if relay is not None:
                relay.on_stop(partial(_stop_run, run, over))
            _watch_for_standstill(run)
            if order.reload is not None:
                stack.enter_context(OperatorConsole(run, say=_tell, reload=order.reload, policy=order.supervision))
            _keep_loaded(order)
            opening.close()
            with short_switch_interval(), LoopWatchdog():
                result = await _within(order.timeout_s, run)
            over.set()
    if faults is not None and order.quiet:
        # With progress on the terminal these lines stand in it already.
        for line in faults.unapplied():
            _say(line)
    return ExecutionResult(result=result, log=log, interrupted=bool(interruption.reason))


def _keep_loaded(order: RunSetup) -> None:
    """Have the collector leave out what is there now: going through all of it would hold the loop while arms move."""
    if not order.virtual:
        gc.collect()
    gc.freeze()


async def _within(timeout_s: float | None, execution: Run) -> RunResult:
    if timeout_s is None:
        return await execution.execute()
    loop = asyncio.get_running_loop()
    timer = loop.call_later(timeout_s, execution.stop, f"it took longer than {timeout_s:g} s")
    try:
        return await execution.execute()
    finally:
        timer.cancel()


def _relay(order: RunSetup) -> AbstractAsyncContextManager[StopRelay | None]:
    """Return what brings the robots to rest when a signal finds the event loop blocked."""
    return StopRelay() if order.cell is not None and not order.virtual else nullcontext()


async def _stop_run(run: Run, over: asyncio.Event, notice: StopNotice) -> None:
    """End the run; the devices stay latched until it is over."""
    run.stop(notice.reason)
    await over.wait()


def _watch_for_standstill(run: Run) -> None:
    """End the run errored, with all that it has told, when virtual time cannot pass any more."""
    loop = asyncio.get_running_loop()
    if isinstance(loop, VirtualLoop):
        loop.when_stuck = lambda error: run.fail(_standstill(run, error))


def _standstill(run: Run, error: VirtualTimeDeadlock) -> VirtualTimeDeadlock:
    waiting = [f"{each.path} ({', '.join(each.reasons)})" for each in run.control.view().waiting]
    names = ", ".join([*run.active_states, *waiting]) or error.hint
    return VirtualTimeDeadlock(error.message, where=run.plan.root.path, hint=f"waiting for ever: {names}")


def _faults(order: RunSetup, cell: OpenCell) -> FaultPort | None:
    if order.faults is None:
        return None
    return FaultPort(BusPort(cell.bus), order.faults, clock=cell.bus.clock, seed=order.seed or 0)


def _recording(order: RunSetup) -> AbstractAsyncContextManager[RunRecording | None]:
    if order.recording is None:
        return nullcontext()
    return RunRecording.open(order.recording, inline=order.virtual)


def _journal(order: RunSetup, stack: ExitStack) -> Journal | NullJournal:
    if order.journal == "none":
        return NullJournal()
    return stack.enter_context(Journal.open(order.journal, inline=order.virtual))


def _say(line: str) -> None:
    sys.stderr.write(f"flexcell: {line}\n")
    sys.stderr.flush()


def _tell(line: str) -> None:
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()
