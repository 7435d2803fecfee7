"""Runs all checks over a behavior and the behaviors it refers to; `flexcell check` and the editor call this."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from engine.cell.cell_names import cell_names
from engine.check.analyzed_behavior import AnalyzedBehavior, Catalogue, analyze_behaviors, note_settled
from engine.check.cell.cell_context import CellContext, cell_context
from engine.check.cell.cell_name_checks import CellNameCheck
from engine.check.cell.entry_references import Entries, add_written_entries, check_entries
from engine.check.cell.parameter_names import check_declared_entries
from engine.check.disabled_nodes import check_disabled
from engine.check.finding import Finding, finding_sort_key, invalid_document_finding, new_finding
from engine.check.flow.definition_sites import DefinitionSites
from engine.check.flow.key_reads import KeyRead, key_reads
from engine.check.flow.type_inference import BehaviorDataFlows, TypeInference
from engine.check.flow.userdata_flow import DataFlow
from engine.check.structure.conditions import check_conditions
from engine.check.structure.declaration import check_declarations, check_unused
from engine.check.structure.instant_loops import check_loops
from engine.check.structure.policy_checks import check_policies
from engine.check.structure.reachability import check_reachability
from engine.check.structure.resources import check_resources
from engine.check.structure.transition_checks import check_transitions
from engine.check.structure.tree_checks import check_trees
from engine.check.values.magnitude import check_magnitudes
from engine.check.values.parameter_checks import check_parameters
from engine.check.values.type_checks import check_types
from engine.check.values.units import check_units
from engine.check.values.userdata_checks import check_userdata
from engine.document.behavior import Behavior
from engine.document.cell import Cell, load_cell
from engine.document.expression.expression_cost import MAX_STEPS
from engine.document.expression.step_meter import METER
from engine.document.loader import BehaviorSurvey, CircularReference, survey_behavior
from engine.errors import DocumentError

MAX_CHECK_STEPS = 200 * MAX_STEPS
"""Maximum total cost of the constant expressions of a behavior in one check: 2 s."""


def check_behavior(
    behavior: Behavior,
    catalogue: Catalogue,
    entries: Entries | None = None,
    *,
    cell: Cell | CellContext | None = None,
    parameters: Mapping[str, object] | None = None,
) -> tuple[Finding, ...]:
    """Return the findings of a behavior and those it refers to, in document order.

    Args:
        behavior: The behavior as loaded.
        catalogue: The states by name, and the modules that the project allows; nothing is imported.
        entries: Names, by kind, of the entries that the store will have; by default the seed of the
            cell. Without a cell they are not checked.
        cell: The cell that it runs in, or its context; by default the cell that it names.
        parameters: The parameters of a run, for checks of values and of names in the cell; others have their defaults.
    """
    context = cell if isinstance(cell, CellContext) else cell_context(behavior, cell)
    findings = [_invalid_cell(behavior, context.mistake)] if context.mistake is not None else []
    seeded = context.seed.names_by_kind() if context.seed is not None and context.mistake is None else None
    known = seeded if entries is None else entries
    subjects = analyze_behaviors(behavior, catalogue)
    known = add_written_entries(known, subjects) if known is not None else None
    use = CellNameCheck(context.names, subjects, parameters or {}) if context.names is not None else None
    read = {id(subject): tuple(key_reads(subject)) for subject in subjects}
    flows: dict[int, DataFlow] = {}
    passed_on = _passed_on(subjects)
    for subject in subjects:
        keys = [*(each.key for each in read[id(subject)]), *passed_on.get(id(subject), ())]
        flows[id(subject)] = DataFlow(subject, DefinitionSites(dict.fromkeys(keys)))
    with METER.limited(MAX_CHECK_STEPS, "this check"):
        for subject in subjects:
            given = parameters if subject is subjects[0] else None
            findings += _check_one(subject, known, use, read[id(subject)], BehaviorDataFlows(flows), given)
    return tuple(findings)


def check_given(
    behavior: Behavior, catalogue: Catalogue, cell: Cell, parameters: Mapping[str, object]
) -> tuple[Finding, ...]:
    """Return findings for values and for names that are not in the cell of a run, with the parameters of the run.

    Args:
        behavior: The behavior to run.
        catalogue: The states by name.
        cell: The cell of the run.
        parameters: Values by name; others have their defaults.
    """
    subjects = analyze_behaviors(behavior, catalogue)
    use = CellNameCheck(cell_names(cell), subjects, parameters)
    with METER.limited(MAX_CHECK_STEPS, "this check"):
        values = check_parameters(subjects[0], parameters) if parameters else ()
        wrong = [finding for finding in values if finding.code == "bad-parameter"]
        return (*wrong, *(finding for subject in subjects for finding in use.check(subject, None)))


def check_file(
    path: Path | str, catalogue: Catalogue, entries: Entries | None = None, *, cell: Cell | None = None
) -> tuple[Finding, ...]:
    """Return the findings of the behavior in a file: its document errors, and the findings in the rest."""
    return check_survey(survey_behavior(path), path, catalogue, entries, cell=cell)


def check_survey(
    survey: BehaviorSurvey,
    path: Path | str,
    catalogue: Catalogue,
    entries: Entries | None = None,
    *,
    cell: Cell | CellContext | None = None,
) -> tuple[Finding, ...]:
    """Return the document errors of a survey and the findings in the rest of the document."""
    read = [invalid_document_finding(error, path) for error in survey.mistakes]
    read += [_circular(circle) for circle in survey.circles]
    if survey.behavior is None:
        return tuple(read)
    found = [*read, *check_behavior(survey.behavior, catalogue, entries, cell=cell)]
    return tuple(sorted(found, key=finding_sort_key) if survey.mistakes else found)


def _check_one(
    subject: AnalyzedBehavior,
    entries: Entries | None,
    use: CellNameCheck | None,
    read: Sequence[KeyRead],
    flows: BehaviorDataFlows,
    run_parameters: Mapping[str, object] | None,
) -> list[Finding]:
    flow = flows.of(subject)
    resolver = TypeInference(flow, flows)
    findings = [
        *check_declarations(subject),
        *check_transitions(subject),
        *check_disabled(subject),
        *check_reachability(subject),
        *check_trees(subject),
        *check_conditions(subject),
        *check_parameters(subject, run_parameters),
        *check_policies(subject),
        *check_units(subject),
        *check_magnitudes(subject),
        *check_userdata(subject, flow, read),
        *check_types(subject, resolver),
        *check_loops(subject, read),
        *check_resources(subject),
        *(check_entries(subject, entries) if entries is not None else ()),
        *(check_declared_entries(subject, entries) if entries is not None else ()),
        *(use.check(subject, resolver) if use is not None else ()),
    ]
    note_settled(subject, findings)
    gaps = subject.gaps
    if subject.behavior.gaps:
        findings = [each for each in findings if not gaps.follows(each, "root" + each.path.removeprefix(subject.base))]
    elif not any(finding.severity == "error" for finding in findings):
        # A mistyped name, for example, hides which parameters are used.
        findings += check_unused(subject, {each.key for each in read})
    mismatched = {finding.position for finding in findings if finding.code == "type-mismatch"}
    findings = [f for f in findings if f.code != "bad-parameter" or f.position not in mismatched]
    return sorted(findings, key=lambda finding: (finding.position.line, finding.position.column, finding.code))


def _passed_on(subjects: Sequence[AnalyzedBehavior]) -> dict[int, set[str]]:
    """Return the keys of each behavior that its references read at its end."""
    found: dict[int, set[str]] = {}
    for subject in subjects:
        for placed in subject.nodes.values() if subject.references else ():
            referred = subject.referred(placed.node)
            if referred is not None:
                found.setdefault(id(referred), set()).update(placed.node.outputs)
    return found


def read_beside(behavior: Behavior) -> tuple[Path, ...]:
    """Return the additional files that a check of a behavior reads: its cell and the seed entries."""
    if behavior.cell_file is None:
        return ()
    try:
        seed = load_cell(behavior.cell_file).seed_file
    except DocumentError:
        return (behavior.cell_file,)
    return (behavior.cell_file, seed) if seed is not None else (behavior.cell_file,)


def _invalid_cell(behavior: Behavior, mistake: DocumentError) -> Finding:
    return new_finding("invalid-cell", str(mistake), path="root", position=behavior.source.position(("cell",)))


def _circular(circle: CircularReference) -> Finding:
    message = f"circular behavior reference: {circle}"
    hint = "a behavior cannot contain itself"
    return new_finding("circular-behavior", message, path="", position=circle.position, hint=hint)
