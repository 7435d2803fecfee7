"""Opens a past run from the journal or a recording, with its version of the behavior."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import msgspec

from engine.archive.past_runs import PastRun, PastRuns, is_success
from engine.archive.recording_files import RecordingFile, is_recording, recording_files, recording_path
from engine.cause_chain import describe_cause
from engine.document import Behavior
from engine.errors import FlexcellError, JournalError
from engine.event import AnyEvent, RunEnded
from engine.journal import journal_path, read_events, read_origin
from engine.library.behavior_graph import new_graph
from engine.library.behavior_library import BehaviorView
from engine.recording import RecordedDocuments, load_recording, recorded_behavior
from engine.runtime.history.run_view import run_duration_s
from engine.runtime.plan import Catalogue, Plan, new_plan


@dataclass(frozen=True, kw_only=True)
class ArchivedRun:
    """One past run: its description, its events, and the behavior at its start with the texts of its documents.

    Without information on the executed behavior, `behavior` has no graph, and there are no plan and no documents.
    """

    summary: PastRun
    events: tuple[AnyEvent, ...]
    behavior: BehaviorView
    plan: Plan | None
    documents: Mapping[str, str]


@dataclass(frozen=True, kw_only=True)
class _Executed:
    """The behavior that a run executed, as far as it is known."""

    view: BehaviorView
    plan: Plan | None = None
    documents: Mapping[str, str] = field(default_factory=dict[str, str])


class Archive:
    """The past runs and recordings of one project; thread-safe.

    Args:
        project: The folder of the project.
        catalogue: The known states, for the outcomes of nodes.
        journal: The folder or file of the journal; it may be missing.
    """

    def __init__(self, project: Path, catalogue: Catalogue, journal: Path) -> None:
        self.project = project.resolve()
        self.journal = journal_path(journal)
        self._catalogue = catalogue
        self._lock = threading.Lock()
        self._executed: dict[str, _Executed] = {}
        self._runs = PastRuns(self.journal, success=lambda run, document: self._of_run(run, document).view.success)

    def runs(self) -> tuple[PastRun, ...]:
        """Return the runs of the journal, newest first; empty without a journal.

        Raises:
            JournalError: the journal cannot be read.
        """
        return self._runs.all()

    def run(self, run_id: str) -> ArchivedRun:
        """Open a run of the journal.

        Raises:
            JournalError: there is no such run, or an event of it is damaged.
        """
        found = next((run for run in self.runs() if run.id == run_id), None)
        if found is None:
            raise JournalError(f"there is no run {run_id!r}", hint="see the list of past runs")
        executed = self._of_run(run_id, found.document)
        return ArchivedRun(
            summary=found,
            events=read_events(self.journal, run_id),
            behavior=executed.view,
            plan=executed.plan,
            documents=executed.documents,
        )

    def open(self, name: str) -> ArchivedRun:
        """Open a run of the journal by its id, or a recording by its path in the project, which ends with `.mcap`.

        Raises:
            JournalError: there is no such run, or an event of it is damaged.
            RecordingError: there is no such recording, or it cannot be read.
        """
        return self.recording(name) if is_recording(name) else self.run(name)

    def last_good_run(self, run: PastRun) -> PastRun | None:
        """Return the latest run of the same behavior that succeeded and started before a run; None if there is none.

        Raises:
            JournalError: the journal cannot be read.
        """
        return next(
            (
                each
                for each in self.runs()
                if each.success and each.behavior == run.behavior and each.started_at_s < run.started_at_s
            ),
            None,
        )

    def recordings(self) -> tuple[RecordingFile, ...]:
        """Return the recordings in the project, newest first."""
        return recording_files(self.project)

    def recording_file(self, path: str) -> Path:
        """Return the file of a recording, by its path in the project.

        Raises:
            RecordingError: there is no such recording in the project.
        """
        return recording_path(self.project, path)

    def recording_of(self, run_id: str) -> str:
        """Return the path in the project of the server's recording of a run; empty if there is none."""
        file = self.journal.parent / "recordings" / f"{Path(run_id).name}.mcap"
        inside = file.is_file() and file.resolve().is_relative_to(self.project)
        return file.resolve().relative_to(self.project).as_posix() if inside else ""

    def recording(self, path: str) -> ArchivedRun:
        """Open a recording by its path in the project.

        Raises:
            RecordingError: it is not in the project, cannot be read, is damaged, or is not a recording of a run.
        """
        recording = load_recording(recording_path(self.project, path))
        description = recording.description
        executed = self._read(recording.documents, description.behavior)
        events = tuple(recorded.event for recorded in recording.events)
        last = events[-1] if events else None
        ended = last if isinstance(last, RunEnded) else None
        success = ended is not None and is_success(ended, executed.view.success)
        return ArchivedRun(
            summary=PastRun(
                id=description.run,
                behavior=description.behavior,
                document=description.document,
                status=ended.status if ended is not None else "running",
                outcome=ended.outcome if ended is not None else None,
                success=success,
                cause=describe_cause(ended.cause)
                if ended is not None and ended.cause is not None and not success
                else "",
                started_at_s=description.started_unix_s,
                duration_s=run_duration_s(last),
                events=last.seq if last is not None else 0,
            ),
            events=events,
            behavior=executed.view,
            plan=executed.plan,
            documents=executed.documents,
        )

    def _of_run(self, run_id: str, document: str) -> _Executed:
        """Return the behavior that a run executed, read once for all runs with the same semantic hash."""
        with self._lock:
            known = self._executed.get(document)
        if known is not None:
            return known
        try:
            origin = read_origin(self.journal, run_id)
        except JournalError:
            # If the behavior cannot be read, only the graph is missing.
            origin = None
        if origin is None or not origin.documents:
            return _Executed(view=_unknown(""))
        texts = {name: text.encode() for name, text in origin.documents.items()}
        executed = self._read(RecordedDocuments(behavior=origin.document, texts=texts), origin.behavior)
        file = Path(origin.behavior)
        if file.is_relative_to(self.project):
            view = msgspec.structs.replace(executed.view, id=file.relative_to(self.project).as_posix())
            executed = replace(executed, view=view)
        with self._lock:
            self._executed[document] = executed
        return executed

    def _read(self, documents: RecordedDocuments, name: str) -> _Executed:
        try:
            behavior = recorded_behavior(documents)
            view = self._drawn(behavior, documents.behavior)
        except FlexcellError:
            # Its events can still be shown.
            return _Executed(view=_unknown(name))
        texts = {name: text.decode(errors="replace") for name, text in documents.texts.items()}
        try:
            return _Executed(view=view, plan=new_plan(behavior, self._catalogue), documents=texts)
        except FlexcellError:
            # A state that is no longer installed: only the initial values of userdata are then unknown.
            return _Executed(view=view, documents=texts)

    def _drawn(self, behavior: Behavior, behavior_id: str) -> BehaviorView:
        return BehaviorView(
            id=behavior_id,
            name=behavior.name,
            description=behavior.document.description,
            graph=new_graph(behavior, self._catalogue),
            view=behavior.document.view,
            success=behavior.success,
        )


def _unknown(name: str) -> BehaviorView:
    return BehaviorView(id=name, name=name, description="")
