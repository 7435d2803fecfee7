"""The versions that a sweep of a project can be compared with, in its files of results, and the comparison."""

from __future__ import annotations

from pathlib import Path

import msgspec

from engine.errors import FlexcellError
from engine.host.state_folder_names import STATE_FOLDER
from engine.sweep.report.words import difference_text
from engine.sweep.results import SweepResults
from engine.sweep.sweep_execution import SweepEnd
from engine.sweep.verdict.comparison import BaselineVersion, Comparison, baseline_versions, compare_with_baseline
from engine.sweep.verdict.success_count import Verdict
from engine.sweep_library.sweep_files import NoSuchSweep, Stamps

_SUFFIX = ".db"


class Baseline(msgspec.Struct, frozen=True, kw_only=True):
    """A version to compare with; `results` is the path of its file in the project."""

    results: str
    version: BaselineVersion


class SweepComparison(msgspec.Struct, frozen=True, kw_only=True):
    """A sweep compared with a baseline."""

    comparison: Comparison
    verdict: Verdict | None
    words: str
    """How the success rate has changed, as in reports."""


def baselines(project: Path, stamps: Stamps, end: SweepEnd) -> list[Baseline]:
    """Return the other versions with results of the configurations of a sweep, the newest first."""
    found: list[Baseline] = []
    for name in _files(project, stamps):
        try:
            with SweepResults.read(project / name) as results:
                known = baseline_versions(end.results, end.subject.hash, end.subject.versions, results)
        except FlexcellError:
            # Another file of SQLite: a store, a journal.
            continue
        found += [Baseline(results=name, version=each) for each in known]
    return sorted(found, key=lambda each: -each.version.saved_unix_s)


def compared(
    project: Path, stamps: Stamps, end: SweepEnd, *, results: str, version: str, margin: float | None
) -> SweepComparison:
    """Compare a sweep with one of its baselines.

    Raises:
        FlexcellError: there is no such baseline.
    """
    if results not in _files(project, stamps):
        raise NoSuchSweep(f"there is no file of results {results[:120]!r}", hint="see the baselines of this sweep")
    with SweepResults.read(project / results) as baseline:
        comparison = compare_with_baseline(
            end.results,
            end.subject.hash,
            end.subject.versions,
            baseline,
            confidence=end.subject.sweep.document.confidence,
            margin=margin,
            version=version,
        )
    return SweepComparison(comparison=comparison, verdict=comparison.verdict, words=difference_text(comparison))


def _files(project: Path, stamps: Stamps) -> list[str]:
    """Return the paths of files that may have results, in the project and in its state folder."""
    states = sorted((project / STATE_FOLDER).glob(f"*{_SUFFIX}"))
    inside = [each.relative_to(project).as_posix() for each in states if each.is_file()]
    return inside + sorted(name for name in stamps if name.endswith(_SUFFIX))
