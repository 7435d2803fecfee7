"""Starts the installed `flexcell` command, waits for what its journal tells, and kills it."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from pathlib import Path

from engine.errors import JournalError
from engine.event import AnyEvent, NodeEntered
from engine.journal import RunRecord, list_runs, read_events
from tests.engine.awaited import wait_until
from tests.engine.cli.command import FLEXCELL

JOURNAL = ".flexcell"


@contextmanager
def started(*arguments: str | Path, cwd: Path) -> Generator[subprocess.Popen[str]]:
    """A command that is killed at the end if it still goes on."""
    command = [FLEXCELL, *map(str, arguments)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, cwd=cwd, stdin=pipe, stdout=pipe, stderr=pipe, text=True) as process:
        try:
            yield process
        finally:
            process.kill()


def runs_in(folder: Path) -> tuple[RunRecord, ...]:
    """Return the runs in the journal of a folder; none while it is being made."""
    try:
        return list_runs(folder / JOURNAL)
    except JournalError:
        return ()


def events_in(folder: Path) -> tuple[AnyEvent, ...]:
    """Return the durable events of the newest run."""
    runs = runs_in(folder)
    return read_events(folder / JOURNAL, runs[-1].id) if runs else ()


def until(
    process: subprocess.Popen[str], folder: Path, true: Callable[[Sequence[AnyEvent]], bool]
) -> tuple[AnyEvent, ...]:
    """Wait until the durable events of the newest run say so, and return them."""
    events: tuple[AnyEvent, ...] = ()

    def holds() -> bool:
        nonlocal events
        if true(events := events_in(folder)):
            return True
        assert process.poll() is None, f"it ended with {process.returncode}: {process.communicate()}"
        return False

    wait_until(holds)
    return events


def entered(path: str, visit: int = 1) -> Callable[[Sequence[AnyEvent]], bool]:
    """Tell whether a node was entered for the n-th time."""
    return lambda events: any(isinstance(e, NodeEntered) and e.path == path and e.visit >= visit for e in events)


def run_id_in(folder: Path) -> str:
    """Return the newest run."""
    return runs_in(folder)[-1].id
