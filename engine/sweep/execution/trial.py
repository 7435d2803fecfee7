"""Executes configurations of a sweep in this process, one after the other."""

from __future__ import annotations

import resource
import tempfile
import time
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path

import msgspec

from engine.cause_chain import cause_of, describe_cause, links_from_root
from engine.coverage import CoverageRuns
from engine.document.duration import seconds
from engine.document.sweep import NO_FILE
from engine.errors import Cause, FlexcellError
from engine.journal import encode_event_log
from engine.project.cell_runner import CellSetup
from engine.project.headless_run import CompletedRun, run_headless
from engine.project.run_request import RunRequest
from engine.recording import RecordingOptions, collect_documents
from engine.runtime.history import RunStateChange
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import NodeTime, TrialResult, TrialStatus
from engine.sweep.subject.cell_variation import varied_cell
from engine.sweep.subject.store_copy import copied_store
from engine.sweep.subject.subject_files import PortableText, subject_root
from engine.sweep.subject.sweep_subject import SweepSubject

_KIBIBYTE = 1024


class Trials:
    """Executes configurations; belongs to one thread.

    Args:
        subject: What all of them have in common.
    """

    def __init__(self, subject: SweepSubject) -> None:
        self.subject = subject
        self._coverage = CoverageRuns(subject.behavior, subject.catalogue)
        self._texts = PortableText(subject_root(subject))

    def run(self, configuration: Configuration, *, record: Path | None = None) -> TrialResult:
        """Execute one configuration in virtual time.

        Args:
            configuration: The configuration.
            record: MCAP file to which the run is recorded.
        """
        started_s, cpu_started_s = time.perf_counter(), _cpu_s()
        with tempfile.TemporaryDirectory(prefix="flexcell-sweep-") as folder:
            try:
                setup, request = self._request(configuration, Path(folder), record)
            except FlexcellError as error:
                ended = _failed(configuration, "refused", cause_of(error))
            else:
                ended = self._executed(configuration, setup, request)
        return msgspec.structs.replace(
            ended,
            cause=self._texts.of(ended.cause),
            reason=self._texts.of(ended.reason),
            reason_at=self._texts.of(ended.reason_at),
            wall_s=time.perf_counter() - started_s,
            cpu_s=_cpu_s() - cpu_started_s,
            memory_bytes=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * _KIBIBYTE,
        )

    def _executed(self, configuration: Configuration, setup: CellSetup, request: RunRequest) -> TrialResult:
        times = _NodeTimes()
        covered = self._coverage.follow(watch=times.take)
        limit_s = seconds(self.subject.sweep.document.limit)
        try:
            run = run_headless(setup, request, watchers=(covered.take,), limit_s=limit_s)
        except (FlexcellError, MemoryError) as error:
            # A world that cannot be opened with these values, or a run in which everything waits.
            return _failed(configuration, "errored", cause_of(error))
        return _completed(configuration, run, covered=covered.bits, times=times.found, texts=self._texts)

    def _request(self, configuration: Configuration, folder: Path, record: Path | None) -> tuple[CellSetup, RunRequest]:
        subject, document, values = self.subject, self.subject.sweep.document, configuration.values
        plan = subject.plans[str(values.get("substitutes", "" if "" in subject.substitutes else NO_FILE))]
        cell = varied_cell(subject.cell, values) if subject.cell is not None else None
        name = values.get("faults", "")
        seed = configuration.seed
        documents = collect_documents(plan.source, cell) if record is not None and plan.source is not None else None
        setup = CellSetup(
            cell=cell,
            seed=seed if document.placement_noise else None,
            store=str(copied_store(subject.store_file, folder)) if cell is not None and cell.document.store else None,
            recording=RecordingOptions(path=record, documents=documents)
            if record is not None and documents is not None
            else None,
        )
        request = RunRequest(
            plan=plan,
            parameters={**document.parameters, **_given(values, "parameters")},
            inputs={**document.inputs, **_given(values, "inputs")},
            seed=seed,
            faults=subject.faults.get(str(name)),
            documents=documents,
            run_id=f"sweep-{configuration.key(subject.hash)}",
        )
        plan.checked_parameters(request.parameters)
        plan.checked_inputs(request.inputs)
        return setup, request


def ended_process(configuration: Configuration, status: TrialStatus, message: str, *, wall_s: float) -> TrialResult:
    """Return the result of a configuration whose process has ended, or was ended, before it could answer."""
    return msgspec.structs.replace(_failed(configuration, status, Cause(message=message)), wall_s=wall_s)


def _completed(
    configuration: Configuration,
    run: CompletedRun,
    *,
    covered: str,
    times: Mapping[str, NodeTime],
    texts: PortableText,
) -> TrialResult:
    result = run.result
    cause = result.cause if not result.success else None
    return TrialResult(
        configuration=configuration,
        status=_status(result.status),
        outcome=result.outcome,
        success=result.success,
        cause=describe_cause(cause) if cause is not None else "",
        reason=links_from_root(cause)[0].message if cause is not None else "",
        reason_at=links_from_root(cause)[0].where if cause is not None else "",
        duration_s=result.duration_s,
        events=len(run.events),
        events_sha256=sha256(texts.of_json(encode_event_log(list(run.events)))).hexdigest(),
        nodes=times,
        outputs=_numbers(result.userdata),
        measures={"run.duration_s": result.duration_s, **run.measures},
        covered=covered,
    )


def _failed(configuration: Configuration, status: TrialStatus, cause: Cause) -> TrialResult:
    root = links_from_root(cause)[0]
    return TrialResult(
        configuration=configuration,
        status=status,
        cause=describe_cause(cause),
        reason=root.message,
        reason_at=root.where,
    )


def _status(text: str) -> TrialStatus:
    match text:
        case "finished" | "stopped":
            return text
        case _:
            return "errored"


class _NodeTimes:
    """Sums up the activations of the nodes of one run."""

    def __init__(self) -> None:
        self.found: dict[str, NodeTime] = {}

    def take(self, change: RunStateChange) -> None:
        """Take a change of the state of the run."""
        if change.step is None or change.step.kind != "ended":
            return
        path = change.step.path
        before = self.found.get(path, NodeTime(visits=0, total_s=0.0))
        self.found[path] = NodeTime(visits=before.visits + 1, total_s=before.total_s + change.duration_s)


def _numbers(userdata: Mapping[str, object]) -> dict[str, float]:
    return {
        key: float(value)
        for key, value in userdata.items()
        if isinstance(value, int | float) and not isinstance(value, bool)
    }


def _given(values: Mapping[str, object], kind: str) -> dict[str, object]:
    """Return the values of the factors of a kind by their names without it."""
    return {
        address.removeprefix(f"{kind}."): value for address, value in values.items() if address.startswith(f"{kind}.")
    }


def _cpu_s() -> float:
    own, children = resource.getrusage(resource.RUSAGE_SELF), resource.getrusage(resource.RUSAGE_CHILDREN)
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime
