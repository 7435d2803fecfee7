"""Checks a behavior against the entries that a store really holds."""

from __future__ import annotations

from collections.abc import Iterable

from engine.check.entries import check_entries, with_written
from engine.check.finding import Finding
from engine.check.subject import Catalogue, new_subjects
from engine.document.behavior import Behavior


def check_stored(behavior: Behavior, catalogue: Catalogue, entries: Iterable[tuple[str, str]]) -> tuple[Finding, ...]:
    """Return the entries that a behavior and those it refers to use, and that neither are among `entries` nor written.

    Args:
        behavior: What is to run.
        catalogue: The states by name.
        entries: Kind and name of each entry that there is.
    """
    subjects = new_subjects(behavior, catalogue)
    known = with_written(names_by_kind(entries), subjects)
    return tuple(found for subject in subjects for found in check_entries(subject, known))


def names_by_kind(entries: Iterable[tuple[str, str]]) -> dict[str, set[str]]:
    """Return the names of the entries of each kind."""
    names: dict[str, set[str]] = {}
    for kind, name in entries:
        names.setdefault(kind, set()).add(name)
    return names
