"""What `flexcell sweep` writes: progress on a terminal, JUnit, and the summary of a GitHub job."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn

from engine.cli.output.junit import JunitCase, JunitProblem, JunitSuite, class_name, write_junit
from engine.errors import FlexcellError
from engine.sweep import Comparison, SweepProgress, SweepSummary
from engine.sweep.report import markdown
from engine.sweep.report.words import difference_text, interval_text, kept_text, percent

_EVERY = 0.05
"""Without a terminal, a line is printed after each such share of the runs."""
_MINUTE_S, _HOUR_S = 60.0, 3600.0


class SweepPrinter:
    """Shows the progress of a sweep on stderr: a bar on a terminal, else some twenty lines.

    Args:
        quiet: Whether nothing is shown.
    """

    def __init__(self, *, quiet: bool) -> None:
        self._quiet = quiet
        self._console = Console(stderr=True)
        self._bar = Progress(BarColumn(), MofNCompleteColumn(), TextColumn("{task.description}"), console=self._console)
        self._task: TaskID | None = None
        self._next = 0.0

    def __enter__(self) -> Self:
        if not self._quiet and self._console.is_terminal:
            self._task = self._bar.add_task("starting", total=None)
            self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._task is not None:
            self._bar.stop()

    def show(self, progress: SweepProgress) -> None:
        """Show how far the sweep is."""
        if self._quiet:
            return
        text = progress_text(progress)
        done, total = progress.count.done, progress.count.done + progress.due
        if self._task is not None:
            self._bar.update(self._task, completed=done, total=total, description=text)
        elif done >= self._next or not progress.due:
            self._next = done + max(_EVERY * total, 1.0)
            sys.stderr.write(f"{done} of {total}: {text}\n")
            sys.stderr.flush()


def progress_text(progress: SweepProgress) -> str:
    """Return the rate of success, its interval, the speed and the remaining time."""
    count, parts = progress.count, list[str]()
    if count.rate is not None:
        interval = f" ({interval_text(count.interval)})" if count.interval is not None else ""
        parts.append(f"{percent(count.rate)} succeeded{interval}")
    parts.append(f"{progress.rate_hz * _MINUTE_S:.1f} runs/min")
    if progress.remaining_s is not None and progress.due:
        parts.append(f"{_duration(progress.remaining_s)} left")
    return ", ".join(parts)


def write_sweep_junit(path: Path, file: Path, summary: SweepSummary, comparison: Comparison | None) -> None:
    """Write the verdicts as JUnit: a case for each requirement, and one for the comparison with the baseline.

    Raises:
        FlexcellError: the file cannot be written.
    """
    name, text = class_name(file), markdown(summary, comparison)
    # All are of the same runs: their time is told once.
    cases = [
        JunitCase(
            name=each.text,
            classname=name,
            time_s=0.0 if number else summary.cpu_s,
            problem=_problem(each.verdict, kept_text(each), text),
        )
        for number, each in enumerate(summary.requirements)
    ] or [JunitCase(name="success rate", classname=name, time_s=summary.cpu_s)]
    if comparison is not None:
        problem = _problem(comparison.verdict, difference_text(comparison), text)
        cases.append(JunitCase(name="not worse than the baseline", classname=name, time_s=0.0, problem=problem))
    properties = {
        "subject": summary.subject,
        "runs": str(summary.looked_at),
        "successes": str(summary.successes),
        "interval": interval_text(summary.interval) if summary.interval is not None else "",
    }
    write_junit(path, [JunitSuite(name=f"sweep {file.name}", file=str(file), cases=cases, properties=properties)])


def write_github_summary(summary: SweepSummary, comparison: Comparison | None, environment: Mapping[str, str]) -> None:
    """In a GitHub job, append the report to its summary, and annotate each requirement that is not reached.

    Raises:
        FlexcellError: the file of the summary cannot be written.
    """
    if append_github_summary(markdown(summary, comparison), environment):
        for each in summary.requirements:
            if each.verdict != "passed":
                level = "error" if each.verdict == "failed" else "warning"
                sys.stderr.write(f"::{level} title={each.text}: {each.verdict}::{kept_text(each)}\n")


def append_github_summary(text: str, environment: Mapping[str, str]) -> bool:
    """Append Markdown to the summary of a GitHub job; returns whether this is one.

    Raises:
        FlexcellError: the file of the summary cannot be written.
    """
    file = environment.get("GITHUB_STEP_SUMMARY")
    if not file:
        return False
    try:
        with Path(file).open("a", encoding="utf-8") as stream:
            stream.write(text)
    except OSError as error:
        hint = "unset GITHUB_STEP_SUMMARY"
        raise FlexcellError(f"the summary cannot be written: {error.strerror}", where=file, hint=hint) from error
    return True


def _problem(verdict: str | None, message: str, text: str) -> JunitProblem | None:
    if verdict in (None, "passed"):
        return None
    return JunitProblem(kind="failure" if verdict == "failed" else "error", type=verdict, message=message, text=text)


def _duration(seconds_: float) -> str:
    if seconds_ < _MINUTE_S:
        return f"{seconds_:.0f} s"
    if seconds_ < _HOUR_S:
        return f"{seconds_ / _MINUTE_S:.0f} min"
    return f"{seconds_ / _HOUR_S:.1f} h"
