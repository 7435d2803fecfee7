"""Runs all checks over a behavior and the behaviors it refers to; `flexcell check` and the editor call this."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path

from engine.check.conditions import check_conditions
from engine.check.declaration import check_declarations
from engine.check.finding import Finding, new_finding
from engine.check.reachability import check_reachability
from engine.check.resources import check_resources
from engine.check.subject import Catalogue, new_subject
from engine.check.values import check_values
from engine.check.wiring import check_wiring
from engine.document.behavior import Behavior
from engine.document.loader import CircularReference, read_behavior
from engine.errors import DocumentError, Position


def check_behavior(
    behavior: Behavior, catalogue: Catalogue, entries: Collection[str] | None = None
) -> tuple[Finding, ...]:
    """Return everything that is wrong with a behavior and those it refers to, in document order.

    Args:
        behavior: The behavior as loaded.
        catalogue: The states by name; `module:Class` names are imported.
        entries: Names of the entries that the store will have; None leaves them unchecked.
    """
    findings: list[Finding] = []
    seen: set[Path] = set()
    due = [(behavior, "root")]
    while due:
        current, base = due.pop(0)
        identity = current.file.resolve()
        if identity in seen:
            continue
        seen.add(identity)
        findings += _check_one(current, catalogue, entries, base)
        for path, node in current.nodes():
            if node.behavior is not None and node.behavior in current.references:
                below = f"{base}{path.removeprefix('root')}/root"
                due.append((current.references[node.behavior], below))
    return tuple(findings)


def check_file(path: Path | str, catalogue: Catalogue, entries: Collection[str] | None = None) -> tuple[Finding, ...]:
    """Return everything that is wrong with the behavior in a file, be it that it cannot be read."""
    try:
        behavior, circles = read_behavior(path)
    except DocumentError as error:
        position = error.where if isinstance(error.where, Position) else Position(file=str(path), line=1, column=1)
        hint = error.hint or ""
        return (new_finding("invalid-document", error.message, path="", position=position, hint=hint),)
    return (*(_circular(circle) for circle in circles), *check_behavior(behavior, catalogue, entries))


def _check_one(behavior: Behavior, catalogue: Catalogue, entries: Collection[str] | None, base: str) -> list[Finding]:
    subject = new_subject(behavior, catalogue, base=base)
    findings = [
        *check_declarations(subject),
        *check_wiring(subject),
        *check_reachability(subject),
        *check_conditions(subject),
        *check_values(subject, entries),
        *check_resources(subject),
    ]
    return sorted(findings, key=lambda finding: (finding.position.line, finding.position.column, finding.code))


def _circular(circle: CircularReference) -> Finding:
    message = f"circular behavior reference: {circle}"
    hint = "a behavior cannot contain itself"
    return new_finding("circular-behavior", message, path="", position=circle.position, hint=hint)
