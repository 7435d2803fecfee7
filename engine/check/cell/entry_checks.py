"""Checks a behavior against the actual entries of a store."""

from __future__ import annotations

from collections.abc import Iterable

from engine.check.analyzed_behavior import Catalogue, analyze_behaviors
from engine.check.cell.entry_references import add_written_entries, check_entries
from engine.check.finding import Finding
from engine.document.behavior import Behavior


def check_stored(behavior: Behavior, catalogue: Catalogue, entries: Iterable[tuple[str, str]]) -> tuple[Finding, ...]:
    """Return findings for entries that a behavior uses, and that are neither in `entries` nor written.

    Args:
        behavior: The behavior to run, with its references.
        catalogue: The states by name.
        entries: Kind and name of each existing entry.
    """
    subjects = analyze_behaviors(behavior, catalogue)
    known = add_written_entries(names_by_kind(entries), subjects)
    return tuple(found for subject in subjects for found in check_entries(subject, known))


def names_by_kind(entries: Iterable[tuple[str, str]]) -> dict[str, set[str]]:
    """Return the names of the entries of each kind."""
    names: dict[str, set[str]] = {}
    for kind, name in entries:
        names.setdefault(kind, set()).add(name)
    return names
