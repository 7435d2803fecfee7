"""Runs all checks over a behavior and the behaviors it refers to; `flexcell check` and the editor call this."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from engine.check.conditions import check_conditions
from engine.check.conduct import check_conduct
from engine.check.declaration import check_declarations, check_unused
from engine.check.entries import Entries, check_entries
from engine.check.finding import Finding, new_finding
from engine.check.flow.flow import Flow
from engine.check.flow.read import Read, reads
from engine.check.flow.resolve import Flows, Resolver
from engine.check.flow.site import Sites
from engine.check.instant import check_loops
from engine.check.keys import check_keys
from engine.check.kinds import check_kinds
from engine.check.parameters import check_parameters
from engine.check.reachability import check_reachability
from engine.check.resources import check_resources
from engine.check.subject import Catalogue, Subject, new_subjects
from engine.check.tree import check_trees
from engine.check.units import check_units
from engine.check.wiring import check_wiring
from engine.document.behavior import Behavior
from engine.document.cell import load_cell
from engine.document.collection_pause import without_collection
from engine.document.entries import load_entries
from engine.document.expression_cost import MAX_STEPS
from engine.document.loader import CircularReference, read_behavior
from engine.document.step_meter import METER
from engine.errors import DocumentError, Position

MAX_CHECK_STEPS = 200 * MAX_STEPS
"""What the constant expressions of a behavior may cost in a check together: 2 s."""


@without_collection
def check_behavior(behavior: Behavior, catalogue: Catalogue, entries: Entries | None = None) -> tuple[Finding, ...]:
    """Return everything that is wrong with a behavior and those it refers to, in document order.

    Args:
        behavior: The behavior as loaded.
        catalogue: The states by name, and what the project allows; nothing is imported.
        entries: Names, by kind, of the entries that the store will have; by default those that the
            behavior's own cell is seeded with. They are left unchecked where it names no cell.
    """
    findings: list[Finding] = []
    if entries is None:
        entries, trouble = _own_entries(behavior)
        findings += trouble
    subjects = new_subjects(behavior, catalogue)
    read = {id(subject): tuple(reads(subject)) for subject in subjects}
    flows: dict[int, Flow] = {}
    passed_on = _passed_on(subjects)
    for subject in subjects:
        keys = [*(each.key for each in read[id(subject)]), *passed_on.get(id(subject), ())]
        flows[id(subject)] = Flow(subject, Sites(dict.fromkeys(keys)))
    with METER.limited(MAX_CHECK_STEPS, "this check"):
        for subject in subjects:
            findings += _check_one(subject, entries, read[id(subject)], Flows(flows))
    return tuple(findings)


def check_file(path: Path | str, catalogue: Catalogue, entries: Entries | None = None) -> tuple[Finding, ...]:
    """Return everything that is wrong with the behavior in a file, be it that it cannot be read."""
    try:
        behavior, circles = read_behavior(path)
    except DocumentError as error:
        position = error.where if isinstance(error.where, Position) else Position(file=str(path), line=1, column=1)
        hint = error.hint or ""
        return (new_finding("invalid-document", error.message, path="", position=position, hint=hint),)
    return (*(_circular(circle) for circle in circles), *check_behavior(behavior, catalogue, entries))


def _check_one(subject: Subject, entries: Entries | None, read: Sequence[Read], flows: Flows) -> list[Finding]:
    flow = flows.of(subject)
    findings = [
        *check_declarations(subject),
        *check_wiring(subject),
        *check_reachability(subject),
        *check_trees(subject),
        *check_conditions(subject),
        *check_parameters(subject),
        *check_conduct(subject),
        *check_units(subject),
        *check_keys(subject, flow, read),
        *check_kinds(subject, Resolver(flow, flows)),
        *check_loops(subject, read),
        *check_resources(subject),
        *(check_entries(subject, entries) if entries is not None else ()),
    ]
    if not any(finding.severity == "error" for finding in findings):
        # With a mistyped name, say, nobody knows what else would be used.
        findings += check_unused(subject, {each.key for each in read})
    mismatched = {finding.position for finding in findings if finding.code == "type-mismatch"}
    findings = [f for f in findings if f.code != "bad-parameter" or f.position not in mismatched]
    return sorted(findings, key=lambda finding: (finding.position.line, finding.position.column, finding.code))


def _passed_on(subjects: Sequence[Subject]) -> dict[int, set[str]]:
    """Return the keys of each behavior that a reference to it reads when it has ended."""
    found: dict[int, set[str]] = {}
    for subject in subjects:
        for placed in subject.nodes.values() if subject.references else ():
            referred = subject.referred(placed.node)
            if referred is not None:
                found.setdefault(id(referred), set()).update(placed.node.outputs)
    return found


def read_beside(behavior: Behavior) -> tuple[Path, ...]:
    """Return the files that a check of a behavior reads beside it: its own cell, and the entries of that."""
    if behavior.cell_file is None:
        return ()
    try:
        seed = load_cell(behavior.cell_file).seed_file
    except DocumentError:
        return (behavior.cell_file,)
    return (behavior.cell_file, seed) if seed is not None else (behavior.cell_file,)


def _own_entries(behavior: Behavior) -> tuple[Entries | None, tuple[Finding, ...]]:
    """Return the entries that the behavior's own cell is seeded with; None where it names no cell, or a broken one."""
    if behavior.cell_file is None:
        return None, ()
    try:
        seed = load_cell(behavior.cell_file).seed_file
        return (load_entries(seed).names_by_kind(), ()) if seed is not None else (None, ())
    except DocumentError as error:
        position = behavior.source.position(("cell",))
        found = new_finding("invalid-cell", str(error), path="root", position=position)
        return None, (found,)


def _circular(circle: CircularReference) -> Finding:
    message = f"circular behavior reference: {circle}"
    hint = "a behavior cannot contain itself"
    return new_finding("circular-behavior", message, path="", position=circle.position, hint=hint)
