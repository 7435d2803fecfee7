"""Reads the sweeps of a project and what is saved of them; also executes them, and a run of one again."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import msgspec

from engine.document import load_behavior, load_cell
from engine.document.duration import seconds
from engine.document.sweep import PointsFile, Sweep, SweepDocument, load_sweep, parse_sweep
from engine.editing.versions import write_atomically
from engine.errors import ControlError, DocumentError, FlexcellError
from engine.host.state_folder_names import STATE_FOLDER
from engine.sweep.case_file import case_document
from engine.sweep.design.configuration import Configuration
from engine.sweep.design.designs import configurations
from engine.sweep.execution.trial import Trials
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.execution.worker_pool import WorkerOptions
from engine.sweep.results import SweepResults
from engine.sweep.search import SearchProgress, execute_search, saved_search
from engine.sweep.shrinking import SameAs, ShrinkProgress
from engine.sweep.statistics import rate_interval
from engine.sweep.subject.sweep_subject import SweepSubject
from engine.sweep.summary import summarize
from engine.sweep.sweep_execution import SweepEnd, SweepProgress, execute_sweep, saved_sweep
from engine.sweep.sweep_table import DEFAULT_RESULTS, available_processors
from engine.sweep.trial_shrinking import shrink_trial
from engine.sweep_library.baselines import Baseline, SweepComparison, baselines, compared
from engine.sweep_library.factor_choices import factor_choices
from engine.sweep_library.search_view import search_live_of, search_view_of, searching
from engine.sweep_library.shrink_view import ShrunkTrial
from engine.sweep_library.sweep_files import (
    NoSuchSweep,
    Stamps,
    new_document_file,
    new_sweep_text,
    project_stamps,
    sweep_file,
    sweep_ids,
)
from engine.sweep_library.sweep_view import (
    CurvePoint,
    FactorChoice,
    RecordedTrial,
    SweepHead,
    SweepLine,
    SweepList,
    SweepLive,
    SweepRuns,
    live_of,
    view_of,
)
from engine.sweep_library.undescribed_results import undescribed_results

MOST_RUNS = 2000
"""Runs that are listed at once."""
RECORDINGS = Path(STATE_FOLDER) / "sweep-runs"
_RECORDINGS_KEPT = 20
_POINTS = 120
_PERIOD_S = 0.2
"""Time between two reports of how far a sweep is."""


@dataclass(frozen=True, kw_only=True)
class _Loaded:
    subject: SweepSubject
    configurations: Sequence[Configuration]
    """Those of its design; a search has none before it is executed."""

    @property
    def is_search(self) -> bool:
        return self.subject.sweep.document.search is not None


class SweepReader:
    """The sweeps of one project; belongs to one thread.

    Args:
        project: The folder of the project.
    """

    def __init__(self, project: Path) -> None:
        self.project = project.resolve()
        self._stamps: Stamps = {}
        self._loaded: dict[str, _Loaded] = {}

    @property
    def results(self) -> Path:
        """The file of all results."""
        return self.project / DEFAULT_RESULTS

    def list(self) -> SweepList:
        """Return all sweeps, and the results of none of them."""
        stamps = self._refresh()
        with SweepResults.open(self.results) as results:
            lines = tuple(self._line(each, results) for each in sweep_ids(self.project, stamps))
            asked = {each.subject.hash for each in self._loaded.values()}
            others = tuple(undescribed_results(self.project, stamps, results, asked))
        return SweepList(sweeps=lines, others=others)

    def view(self, sweep_id: str) -> msgspec.Struct:
        """Return everything that a sweep has shown, a `SweepView`."""
        loaded = self._load(sweep_id)
        if loaded.is_search:
            with SweepResults.open(self.results) as results:
                search = saved_search(loaded.subject, results)
            return search_view_of(self._line_of(sweep_id, loaded.subject.sweep, search_live_of(search)), search)
        end = self._saved(loaded)
        document = end.subject.sweep.document
        head = SweepHead(
            line=self._line_of(sweep_id, end.subject.sweep, live_of(end.count)),
            document=document,
            curve=rate_curve(end.results[: end.count.looked_at], document),
        )
        return view_of(head, summarize(end))

    def runs(self, sweep_id: str, most: int = MOST_RUNS) -> SweepRuns:
        """Return its runs, failing ones first."""
        results = self._ended(self._load(sweep_id))
        alike: dict[tuple[str, str], list[int]] = {}
        for each in results:
            if not each.success:
                alike.setdefault(each.cause_key, []).append(each.configuration.number)
        shown = sorted(results, key=lambda each: each.success)[:most]
        return SweepRuns(
            runs=tuple(msgspec.structs.replace(each, nodes={}, covered="") for each in shown),
            total=len(results),
            alike=tuple(sorted(map(tuple, alike.values()), key=len, reverse=True)),
        )

    def trial(self, sweep_id: str, number: int) -> TrialResult:
        """Return one saved result.

        Raises:
            NoSuchSweep: there is none.
        """
        loaded = self._load(sweep_id)
        if loaded.is_search:
            ended = self._ended(loaded)[number : number + 1]
        else:
            with SweepResults.open(self.results) as results:
                ended = list(
                    results.of_design(loaded.subject.hash, loaded.configurations[number : number + 1]).values()
                )
        if ended:
            return ended[0]
        raise NoSuchSweep(f"run {number} has no result", where=sweep_id, hint="its documents may have changed since")

    def factors(self, behavior_id: str) -> list[FactorChoice]:
        """Return what a sweep of a behavior of the project can vary.

        Raises:
            DocumentError: the behavior or its cell cannot be read.
        """
        file = self.project / behavior_id
        if "\0" in behavior_id or not file.resolve().is_relative_to(self.project):
            raise DocumentError("this behavior is not in the project", where=behavior_id)
        behavior = load_behavior(file)
        cell = load_cell(behavior.cell_file) if behavior.cell_file is not None else None
        return factor_choices(behavior, cell)

    def create(self, sweep_id: str, document: SweepDocument) -> str:
        """Write a new sweep document if everything in it is as it must be, and return its path in the project.

        Raises:
            FlexcellError: it cannot be executed, or there is such a file already; nothing is written.
        """
        file, text = new_sweep_text(self.project, sweep_id, document)
        require_simulated(SweepSubject.load(parse_sweep(text, file=file)))
        return _written(file, text, sweep_id)

    def execute(self, sweep_id: str, *, again: bool, show: Callable[[SweepLive], None]) -> SweepLive:
        """Execute what is left of a sweep; an interrupt ends it, and keeps what has ended.

        Args:
            sweep_id: The sweep.
            again: Whether configurations whose process crashed or hung are executed again.
            show: Called at the beginning and a few times per second.
        """
        loaded = self._load(sweep_id)
        document = loaded.subject.sweep.document
        # One processor is left to the cell, whose control runs in real time.
        options = WorkerOptions(workers=max(1, available_processors() - 1), timeout_s=seconds(document.timeout))
        shown_s = -_PERIOD_S

        def is_due(elapsed_s: float) -> bool:
            nonlocal shown_s
            if elapsed_s - shown_s < _PERIOD_S:
                return False
            shown_s = elapsed_s
            return True

        def report_search(progress: SearchProgress) -> None:
            if is_due(progress.elapsed_s):
                show(searching(progress))

        def report(progress: SweepProgress) -> None:
            if is_due(progress.elapsed_s):
                show(
                    msgspec.structs.replace(
                        live_of(progress.count),
                        status="running",
                        rate_hz=progress.rate_hz,
                        remaining_s=progress.remaining_s,
                    )
                )

        with SweepResults.open(self.results) as results:
            if loaded.is_search:
                show(msgspec.structs.replace(search_live_of(saved_search(loaded.subject, results)), status="running"))
                return search_live_of(execute_search(loaded.subject, results, options, again=again, show=report_search))
            before = saved_sweep(loaded.subject, loaded.configurations, results)
            show(msgspec.structs.replace(live_of(before.count), status="running"))
            end = execute_sweep(loaded.subject, loaded.configurations, results, options, again=again, show=report)
        return live_of(end.count)

    def record(self, sweep_id: str, number: int) -> RecordedTrial:
        """Execute a run of a sweep again in this process, record it, and compare it with its saved result."""
        saved = self.trial(sweep_id, number)
        folder = self.project / RECORDINGS
        folder.mkdir(parents=True, exist_ok=True)
        _forget_oldest(folder)
        file = folder / f"{Path(sweep_id).stem}-{number}-{time.time_ns() // 1_000_000}.mcap"
        result = Trials(self._load(sweep_id).subject).run(saved.configuration, record=file)
        return RecordedTrial(
            recording=file.relative_to(self.project).as_posix() if file.is_file() else "",
            same=(result.label, result.events_sha256) == (saved.label, saved.events_sha256),
            result=result,
            saved=saved,
        )

    def shrink(
        self, sweep_id: str, number: int, *, same: SameAs, show: Callable[[ShrinkProgress], None]
    ) -> ShrunkTrial:
        """Shrink a failing run of a sweep in this process; an interrupt ends it with the smallest found so far.

        Args:
            sweep_id: The sweep.
            number: The number of the run.
            same: What must stay the same.
            show: Called after each run.

        Raises:
            ControlError: the run succeeded.
        """
        failing = self.trial(sweep_id, number)
        subject = self._load(sweep_id).subject
        shrunk = shrink_trial(subject, failing, same=same, show=show)
        return ShrunkTrial(subject=subject.hash, failing=failing.configuration, shrunk=shrunk)

    def save_case(self, sweep_id: str, case: str, found: ShrunkTrial) -> str:
        """Write a run that was shrunk as a sweep of one run that requires success, and return its path in the project.

        Raises:
            FlexcellError: the sweep is another one since, or there is such a file already; nothing is written.
        """
        subject = self._load(sweep_id).subject
        if subject.hash != found.subject:
            hint = "execute the sweep again, and shrink a run of it"
            raise ControlError("the behavior, its cell or a package has changed since", where=sweep_id, hint=hint)
        file = new_document_file(self.project, case)
        shrunk = found.shrunk
        text = case_document(subject.sweep, shrunk.result, file, placement_noise=shrunk.placement_noise)
        return _written(file, text.decode(), case)

    def baselines(self, sweep_id: str) -> Sequence[Baseline]:
        """Return the versions that a sweep can be compared with; none of a search."""
        loaded = self._load(sweep_id)
        return [] if loaded.is_search else baselines(self.project, self._stamps, self._saved(loaded))

    def compare(self, sweep_id: str, *, results: str, version: str, margin: float | None) -> SweepComparison:
        """Compare a sweep with a version in a file of results of the project.

        Raises:
            FlexcellError: there is none, or it is a search, whose runs were chosen to fail.
        """
        loaded = self._load(sweep_id)
        if loaded.is_search:
            raise ControlError("a search has no baseline: its runs were chosen to fail", where=sweep_id)
        end = self._saved(loaded)
        return compared(self.project, self._stamps, end, results=results, version=version, margin=margin)

    def _refresh(self) -> Stamps:
        """Forget what was loaded once any file of the project has changed: which ones a sweep reads is not known."""
        stamps = project_stamps(self.project)
        if stamps != self._stamps:
            self._stamps = stamps
            self._loaded.clear()
        return stamps

    def _load(self, sweep_id: str) -> _Loaded:
        self._refresh()
        known = self._loaded.get(sweep_id)
        if known is None:
            sweep = load_sweep(sweep_file(self.project, sweep_id))
            planned = configurations(sweep) if sweep.document.search is None else ()
            known = _Loaded(subject=SweepSubject.load(sweep), configurations=planned)
            require_simulated(known.subject)
            self._loaded[sweep_id] = known
        return known

    def _saved(self, loaded: _Loaded) -> SweepEnd:
        with SweepResults.open(self.results) as results:
            return saved_sweep(loaded.subject, loaded.configurations, results)

    def _ended(self, loaded: _Loaded) -> Sequence[TrialResult]:
        """Return the runs of a sweep or search that have ended, in the order of their numbers."""
        if not loaded.is_search:
            return self._saved(loaded).results
        with SweepResults.open(self.results) as results:
            return [step.result for step in saved_search(loaded.subject, results).steps]

    def _line(self, sweep_id: str, results: SweepResults) -> SweepLine:
        try:
            loaded = self._load(sweep_id)
            return self._line_of(sweep_id, loaded.subject.sweep, _live(loaded, results))
        except FlexcellError as error:
            # One sweep that cannot be executed does not hide the others.
            return SweepLine(id=sweep_id, problem=str(error).replace(f"{self.project}/", ""))

    def _line_of(self, sweep_id: str, sweep: Sweep, live: SweepLive) -> SweepLine:
        document = sweep.document
        behavior = Path(sweep.resolve(document.behavior))
        inside = behavior.is_relative_to(self.project)
        return SweepLine(
            id=sweep_id,
            description=document.description,
            behavior=behavior.relative_to(self.project).as_posix() if inside else document.behavior,
            design=document.design.csv if isinstance(document.design, PointsFile) else document.design,
            require="; ".join(each.text for each in document.requirements) if document.search is None else "",
            towards=document.search.towards if document.search is not None else "",
            factors=tuple(document.factors),
            live=live,
        )


def rate_curve(ordered: Sequence[TrialResult], document: SweepDocument) -> tuple[CurvePoint, ...]:
    """Return the success rate and its interval after at most 120 numbers of runs, the last one included.

    Args:
        ordered: The results without a gap before them.
        document: The sweep.
    """
    total = len(ordered)
    at = sorted({max(1, round(total * index / _POINTS)) for index in range(1, _POINTS + 1)}) if total else []
    successes, points, begin = 0, list[CurvePoint](), 0
    for runs in at:
        successes += sum(each.success for each in ordered[begin:runs])
        begin = runs
        random = document.design == "random"
        interval = rate_interval(successes, runs, confidence=document.confidence) if random else None
        points.append(CurvePoint(runs=runs, rate=successes / runs, interval=interval))
    return tuple(points)


def _live(loaded: _Loaded, results: SweepResults) -> SweepLive:
    if loaded.is_search:
        return search_live_of(saved_search(loaded.subject, results))
    return live_of(saved_sweep(loaded.subject, loaded.configurations, results).count)


def _written(file: Path, text: str, document_id: str) -> str:
    """Write a new document and return its path in the project."""
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(file, text)
    except OSError as error:
        raise FlexcellError(f"this document cannot be written: {error.strerror}", where=document_id) from error
    return document_id


def require_simulated(subject: SweepSubject) -> None:
    """Refuse a cell with real robots: a sweep executes in virtual time, and never asks anybody.

    Raises:
        ControlError: a robot is real.
    """
    cell = subject.cell
    for device, driver in cell.document.real_devices.items() if cell is not None else ():
        raise ControlError(
            f"{device} is real (driver {driver}): a sweep only simulates",
            where=cell.file if cell is not None else None,
            hint="give the sweep a `cell` whose robots and tools have `driver: sim`",
        )


def _forget_oldest(folder: Path) -> None:
    files = sorted(folder.glob("*.mcap"), key=lambda each: each.stat().st_mtime_ns)
    for file in files[: max(0, len(files) - _RECORDINGS_KEPT + 1)]:
        file.unlink(missing_ok=True)
