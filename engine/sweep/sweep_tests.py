"""Sweep documents as pytest tests: each executes its runs, and fails unless it reaches what it requires.

They are meant for the cases that `flexcell sweep shrink --case` writes: few runs, executed in the process of the test.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from os import PathLike
from pathlib import Path

import pytest

from engine.document.sweep import SweepDocument, load_sweep
from engine.errors import DocumentError, FlexcellError
from engine.sweep import SweepSubject, TrialResult, Trials, configurations
from engine.sweep.verdict.judged_requirement import require_known_numbers
from engine.sweep.verdict.success_count import SuccessCount

MARKER = "flexcell_sweep"
_SWEEP = re.compile(rb"^behavior:", re.MULTILINE)


def is_sweep_file(file: Path) -> bool:
    """Return whether a file is a sweep, and not a document that sweeps name."""
    return _SWEEP.search(file.read_bytes()) is not None


class SweepTestFile(pytest.File):
    """The pytest collector of a sweep document."""

    def collect(self) -> Iterator[pytest.Item]:
        """Yield its only test."""
        item: SweepTestItem = SweepTestItem.from_parent(self, name=self.path.stem)  # pyright: ignore[reportUnknownMemberType]
        item.add_marker(MARKER)
        yield item


class SweepTestItem(pytest.Item):
    """Executes one sweep."""

    def runtest(self) -> None:
        """Execute it until what is required is decided; raises errors that `repr_failure` formats."""
        sweep = load_sweep(self.path)
        document = sweep.document
        if document.require is None or document.search is not None:
            raise DocumentError(
                "a sweep that is a test requires something, and is no search",
                where=self.path,
                hint="`require: success >= 1`, or move the file to another folder",
            )
        planned = configurations(sweep)
        trials, count = Trials(SweepSubject.load(sweep)), SuccessCount(document, len(planned))
        results: list[TrialResult] = []
        failing: list[TrialResult] = []
        for configuration in planned:
            result = trials.run(configuration)
            count.add(result)
            results.append(result)
            if not result.success or _broken(result, document):
                failing.append(result)
            if count.is_decided:
                break
        if count.verdict != "passed":
            require_known_numbers(sweep, results)
            reached = "; ".join(f"{each.text}: {each.verdict}" for each in count.requirements)
            runs = [f"{_described(each)}{_broken(each, document)}" for each in failing]
            raise SweepFails(f"{reached} after {count.done} runs", runs)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: object = None) -> str:
        """Return the runs that failed, or why the sweep cannot be executed; no traceback of the engine."""
        error = excinfo.value
        if isinstance(error, SweepFails):
            runs = "".join(f"\n  {each}" for each in error.runs)
            return f"{self.path}: {error}{runs}"
        if isinstance(error, FlexcellError):
            return str(error) if str(self.path) in str(error) else f"{self.path}: {error}"
        return str(super().repr_failure(excinfo))

    def reportinfo(self) -> tuple[PathLike[str], int | None, str]:
        """Return its path, and its name in the summary."""
        return Path(self.path), None, f"sweep {self.name}"


class SweepFails(AssertionError):
    """A sweep does not reach what it requires; `runs` has a line for each run that failed or does not keep a limit."""

    def __init__(self, message: str, runs: list[str]) -> None:
        super().__init__(message)
        self.runs = runs


def _described(result: TrialResult) -> str:
    configuration = result.configuration
    values = ", ".join(f"{name}={value}" for name, value in configuration.values.items() if name != "seed")
    return f"#{configuration.number} ended with {result.label} (seed {configuration.seed}, {values}): {result.cause}"


def _broken(result: TrialResult, document: SweepDocument) -> str:
    """Return the limits that a run does not keep, each with its number; empty where it keeps all."""
    numbers = result.numbers
    limits = [each.limit for each in document.requirements if each.limit is not None]
    return "".join(
        f"; {each.name} is {numbers.get(each.name, 'missing')}, not {each.side} {each.limit:g}"
        for each in limits
        if not each.is_kept(numbers)
    )
