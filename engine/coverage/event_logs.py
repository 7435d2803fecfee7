"""Reads the event logs of runs from `--events` files, recordings and journals."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from engine.errors import FlexcellError
from engine.event import AnyEvent, RunStarted
from engine.journal import decode_event, list_runs, read_events
from engine.recording import load_recording

MAX_BYTES = 2**30
"""Maximum size in bytes of an `--events` file, which is read completely."""


@dataclass(frozen=True, kw_only=True)
class RunEventLog:
    """The events of one run, and its name in messages."""

    name: str
    events: tuple[AnyEvent, ...]

    @property
    def document(self) -> str:
        """The hash of the behavior at its start; empty if the log has no start."""
        return next((event.document for event in self.events if isinstance(event, RunStarted)), "")


def read_logs(place: Path) -> tuple[RunEventLog, ...]:
    """Return the runs in a journal (a directory or `*.db`), a recording (`*.mcap`) or an event log (`*.jsonl`).

    Raises:
        FlexcellError: the file cannot be read, or is of another kind.
    """
    if place.is_dir() or place.suffix == ".db":
        runs = list_runs(place)
        return tuple(RunEventLog(name=f"run {run.id} in {place}", events=read_events(place, run.id)) for run in runs)
    if place.suffix == ".mcap":
        events = tuple(recorded.event for recorded in load_recording(place).events)
        return (RunEventLog(name=str(place), events=events),)
    return (RunEventLog(name=str(place), events=_read_lines(place)),)


def _read_lines(file: Path) -> tuple[AnyEvent, ...]:
    try:
        if file.stat().st_size > MAX_BYTES:
            raise FlexcellError(
                f"this event log has more than {MAX_BYTES} bytes", where=file, hint="give the journal instead"
            )
        lines = file.read_bytes().splitlines()
    except OSError as error:
        raise FlexcellError(f"cannot read this file: {error.strerror}", where=file, hint="check its path") from error
    events: list[AnyEvent] = []
    for number, line in enumerate(lines, start=1):
        try:
            events.append(decode_event(line))
        except FlexcellError as error:
            hint = "give a file that --events, --record or --journal wrote"
            raise FlexcellError(error.message, where=f"{file}:{number}", hint=hint) from error
    return tuple(events)
