"""Executes one run for the command line: its clock, signals, terminal and shutdown."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Awaitable, Callable, Coroutine, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, field
from functools import partial
from typing import Any, TypeVar

from rich.console import Console

from engine.cli.exit_code import ExitCode
from engine.cli.output.progress_printer import ProgressPrinter
from engine.cli.terminal.interrupt_handling import InterruptHandler
from engine.cli.terminal.operator_console import OperatorConsole
from engine.clock import VirtualLoop, VirtualTimeDeadlock, run_virtual
from engine.document.cell import Cell
from engine.errors import FlexcellError
from engine.event import Event
from engine.host.garbage_collection import freeze_loaded_objects
from engine.host.thread_switch_interval import short_switch_interval
from engine.project.cell_runner import CellRunner, CellSetup, PreparedRun, execute_within, open_cell_runner
from engine.runtime.plan import Plan
from engine.runtime.record.recorder import Watcher
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from engine.runtime.run_result import RunResult
from engine.runtime.watchdog import LoopWatchdog
from engine.stop import StopNotice, StopRelay

T = TypeVar("T")
NO_JOURNAL = "none"
"""The value of `--journal` with which no event is kept."""
StartRun = Callable[[CellRunner], Awaitable[PreparedRun]]
"""Starts the run, new or resumed, in its open cell; if it raises, no run was started."""


@dataclass(frozen=True, kw_only=True)
class RunSetup:
    """How the command line executes a run: what is opened for it, what starts it, what watches it."""

    opened: CellSetup
    start: StartRun
    timeout_s: float | None
    virtual: bool
    quiet: bool
    supervision: RunOptions = field(default_factory=RunOptions)
    watchers: tuple[Watcher, ...] = ()
    reload: Callable[[], Plan] | None = None
    """With an operator on the terminal: reloads the behavior for a hot change."""


@dataclass(kw_only=True)
class ExecutionResult:
    """The result of a run, with its events."""

    result: RunResult
    log: list[Event]
    interrupted: bool
    measures: Mapping[str, float]
    """What the devices have summed up until its end, by name as in `engine.messages.measures`."""

    @property
    def exit_code(self) -> ExitCode:
        """The exit code of the process."""
        if self.interrupted and not self.result.abandoned:
            return ExitCode.INTERRUPTED
        return exit_code(self.result)


def exit_code(result: RunResult) -> ExitCode:
    """Return the exit code for a run that was not interrupted."""
    if result.status == "errored":
        return ExitCode.ERRORED
    return ExitCode.SUCCESS if result.success else ExitCode.OTHER_OUTCOME


def execute_run(setup: RunSetup, *, report: Callable[[ExecutionResult], None]) -> ExitCode:
    """Execute a run to its end, report it, and return the exit code.

    An abandoned state may never end and keeps the event loop alive: the process then exits right
    after the report, with the cell at rest and the journal closed.

    Raises:
        FlexcellError: the run was not started.
    """

    async def main() -> ExecutionResult:
        ended = await _execute(setup)
        if ended.result.abandoned:
            code = _report_run(ended, report)
            _print_message(f"abandoned: {', '.join(ended.result.abandoned)}; the process exits without waiting for it")
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(code)
        return ended

    ended = _on_clock(main(), virtual=setup.virtual)
    return _report_run(ended, report)


def _report_run(ended: ExecutionResult, report: Callable[[ExecutionResult], None]) -> ExitCode:
    """Report a run and return the exit code; a failed report changes success to an error."""
    try:
        report(ended)
    except FlexcellError as error:
        _print_message(str(error))
        return ended.exit_code or ExitCode.ERRORED
    return ended.exit_code


def _on_clock(main: Coroutine[Any, Any, T], *, virtual: bool) -> T:
    return run_virtual(main) if virtual else asyncio.run(main)


async def _execute(setup: RunSetup) -> ExecutionResult:
    log: list[Event] = []
    over = asyncio.Event()
    with ExitStack() as stack:
        interruption = stack.enter_context(InterruptHandler(_print_message))
        async with open_cell_runner(setup.opened) as runner:
            relay = setup.opened.relay
            if relay is not None:
                stack.enter_context(relay.watched_signals())
            prepared = await setup.start(runner)
            run = prepared.run
            for watcher in (log.append, *setup.watchers):
                run.watch(watcher)
            if not setup.quiet:
                run.watch(ProgressPrinter(Console(stderr=True)).show)
            interruption.watch_over(run)
            if relay is not None:
                relay.on_stop(partial(_stop_run, run, over))
            _watch_for_deadlock(run)
            if setup.reload is not None:
                stack.enter_context(
                    OperatorConsole(run, say=_print_line, reload=setup.reload, policy=setup.supervision)
                )
            # A collection that scanned what is loaded would block the loop while arms move.
            freeze_loaded_objects(collect=not setup.virtual)
            with short_switch_interval(), LoopWatchdog():
                result = await execute_within(setup.timeout_s, prepared)
            measures = runner.cell.measures()
            over.set()
    if prepared.faults is not None and setup.quiet:
        # The progress output shows these lines already.
        for line in prepared.faults.unapplied():
            _print_message(line)
    return ExecutionResult(result=result, log=log, interrupted=bool(interruption.reason), measures=measures)


async def _stop_run(run: Run, over: asyncio.Event, notice: StopNotice) -> None:
    """Stop the run; the devices stay latched until it has ended."""
    run.stop(notice.reason)
    await over.wait()


def _watch_for_deadlock(run: Run) -> None:
    """End the run as errored, with all its events kept, when virtual time deadlocks."""
    loop = asyncio.get_running_loop()
    if isinstance(loop, VirtualLoop):
        loop.when_stuck = lambda error: run.fail(_deadlock(run, error))


def _deadlock(run: Run, error: VirtualTimeDeadlock) -> VirtualTimeDeadlock:
    waiting = [f"{each.path} ({', '.join(each.reasons)})" for each in run.control.view().waiting]
    names = ", ".join([*run.active_states, *waiting]) or error.hint
    return VirtualTimeDeadlock(error.message, where=run.plan.root.path, hint=f"waiting forever: {names}")


def new_relay(cell: Cell | None, *, virtual: bool) -> StopRelay | None:
    """Return the relay that stops the robots if a signal arrives while the event loop is blocked."""
    return StopRelay() if cell is not None and not virtual else None


def _print_message(line: str) -> None:
    sys.stderr.write(f"flexcell: {line}\n")
    sys.stderr.flush()


def _print_line(line: str) -> None:
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()
