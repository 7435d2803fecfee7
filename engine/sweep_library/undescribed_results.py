"""Saved results that no sweep document of a project asks for."""

from __future__ import annotations

from collections.abc import Container
from pathlib import Path

from engine.document import load_behavior
from engine.errors import DocumentError
from engine.sweep.results import SweepResults
from engine.sweep_library.sweep_files import Stamps
from engine.sweep_library.sweep_view import UndescribedResults


def undescribed_results(
    project: Path, stamps: Stamps, results: SweepResults, asked: Container[str]
) -> list[UndescribedResults]:
    """Return what is saved of versions that are not asked for, with their behavior where the project still has it."""
    meanings: dict[str, str] | None = None
    found: list[UndescribedResults] = []
    for subject, versions in results.subjects().items():
        ended = results.all_of(subject) if subject not in asked else []
        if ended:
            meanings = _meanings(project, stamps) if meanings is None else meanings
            behavior = meanings.get(versions.get("behavior", ""), "")
            good = sum(each.success for each in ended)
            found.append(UndescribedResults(subject=subject, behavior=behavior, runs=len(ended), successes=good))
    return found


def _meanings(project: Path, stamps: Stamps) -> dict[str, str]:
    """Return the behaviors of the project by their semantic hash."""
    found: dict[str, str] = {}
    for name in stamps:
        if name.startswith("behaviors/") and not name.endswith((".py", ".csv", ".db")):
            try:
                found[load_behavior(project / name).meaning] = name
            except DocumentError:
                # No behavior, or one with mistakes: it cannot be what was executed.
                continue
    return found
