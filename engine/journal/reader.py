"""Reads a journal without writing to it: for timelines, run reports, replay and resuming."""

from __future__ import annotations

from pathlib import Path

from engine.event import AnyEvent
from engine.journal.batch import WorldState
from engine.journal.journal import journal_path
from engine.journal.journal_port import RunOrigin, RunRecord
from engine.journal.snapshot import open_snapshot


def list_runs(place: Path | str) -> tuple[RunRecord, ...]:
    """Return the runs of a journal directory or file, oldest first; `damage` describes a damaged one.

    Raises:
        JournalError: there is no journal, or it cannot be read.
    """
    with open_snapshot(journal_path(place)) as journal:
        return journal.runs()


def find_run(place: Path | str, run_id: str) -> RunRecord:
    """Return one run.

    Raises:
        JournalError: there is no such journal or run, or it is damaged.
    """
    with open_snapshot(journal_path(place)) as journal:
        return journal.run(run_id)


def read_events(place: Path | str, run_id: str) -> tuple[AnyEvent, ...]:
    """Return the durable events of a run by `seq`; empty when none is stored yet.

    Raises:
        JournalError: there is no such journal or run, or a stored event is damaged or missing.
    """
    with open_snapshot(journal_path(place)) as journal:
        return tuple(journal.events(run_id))


def read_origin(place: Path | str, run_id: str) -> RunOrigin | None:
    """Return the start parameters of a run; None when the journal has none.

    Raises:
        JournalError: there is no such journal or run, it cannot be read, or the entry is damaged.
    """
    with open_snapshot(journal_path(place)) as journal:
        return journal.origin(run_id)


def read_world(place: Path | str, run_id: str) -> WorldState | None:
    """Return the state of the simulated world at the last commit of a run; None when there is none.

    Raises:
        JournalError: there is no such journal or run, it cannot be read, or the state is damaged.
    """
    with open_snapshot(journal_path(place)) as journal:
        return journal.world(run_id)
