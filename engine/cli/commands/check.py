"""`flexcell check`: checks documents statically and reports findings with file, line and column."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Literal, TextIO

import typer
from msgspec.structs import replace

from engine.cell.cell_names import cell_names
from engine.check import (
    CellContext,
    Finding,
    cell_context,
    check_behavior,
    check_cell,
    check_entries_document,
    check_module,
    check_rest,
    check_survey,
    check_targets,
    finding_sort_key,
    invalid_document_finding,
    page_text,
)
from engine.cli.exit_code import ExitCode
from engine.cli.output.findings import as_github, as_json, as_sarif
from engine.document import Behavior, survey_behavior
from engine.document.cell import Cell, load_cell
from engine.document.document_kind import kind_of
from engine.document.entries_document import load_entries
from engine.document.equipment.equipment_file import load_equipment
from engine.document.module_document import load_module
from engine.document.project_file import PROJECT_FILE, load_project
from engine.document.python_name import is_python_name
from engine.document.state_catalogue import Catalogue
from engine.document.text.text_recovery import load_recovering
from engine.errors import DocumentError, FlexcellError, Position
from engine.registry import load_states

TargetLevel = Literal["warning", "error", "off"]


def check(
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            help="Behavior, cell, module, equipment, entries, sweep, faults, substitutes or project documents, or"
            " FILE.py:NAME.",
            show_default=False,
        ),
    ] = None,
    format_: Annotated[
        Literal["text", "json", "github", "sarif"], typer.Option("--format", help="Output format of the findings.")
    ] = "text",
    json: Annotated[bool, typer.Option("--json", help="Same as --format json.")] = False,
    cell: Annotated[
        Path | None,
        typer.Option(help="Cell to check behaviors and entries against; by default the cell that they name."),
    ] = None,
    store: Annotated[
        str,
        typer.Option(
            help="Store in which named entries must exist: a file, mongodb://…, or `cell` for the store of the"
            " behavior's cell."
        ),
    ] = "",
    fix: Annotated[
        bool,
        typer.Option(
            "--fix",
            help="Apply to behavior documents the fixes that need no choice; print the choices for the others.",
        ),
    ] = False,
    fix_likely: Annotated[
        bool,
        typer.Option(
            "--fix-likely", help="As --fix, but also apply the first of several possible fixes. No node is deleted."
        ),
    ] = False,
    targets: Annotated[
        TargetLevel,
        typer.Option(
            help="Severity of targets that an arm of the cell cannot reach, or at which it would collide with itself"
            " or a fixture; `off` skips the check, and that of the bodies of a cell at rest."
        ),
    ] = "warning",
    explain: Annotated[
        str, typer.Option(help="Print what a finding code means and how to resolve it.", metavar="CODE")
    ] = "",
) -> None:
    """Check documents without executing them. Exit code 2 if any document has an error."""
    if explain:
        sys.stdout.write(page_text(explain))
        return
    if not files:
        raise typer.BadParameter("no documents given", param_hint="FILES")
    catalogues = {folder: load_states(folder) for folder in dict.fromkeys(file.parent for file in files)}
    cell_spec = load_cell(cell) if cell is not None else None
    output_format = "json" if json else format_
    fix_output = sys.stdout if output_format == "text" else sys.stderr
    is_written = not (fix or fix_likely) or _fix(files, catalogues, fix_output, likely=fix_likely)
    findings = [
        finding
        for file in files
        for finding in findings_of(file, catalogues[file.parent], store, cell_spec, targets=targets)
    ]
    if output_format == "json":
        sys.stdout.write(as_json(findings) + "\n")
    elif output_format == "sarif":
        sys.stdout.write(as_sarif(findings) + "\n")
    elif output_format == "github":
        sys.stdout.writelines(as_github(finding) + "\n" for finding in findings)
    else:
        sys.stdout.writelines(f"{finding}\n" for finding in findings)
        sys.stderr.write(_summary(len(files), findings))
    if not is_written or any(finding.severity == "error" for finding in findings):
        raise typer.Exit(ExitCode.BAD_INPUT)


def _fix(files: Sequence[Path], catalogues: Mapping[Path, Catalogue], output: TextIO, *, likely: bool) -> bool:
    """Fix documents and print what was fixed; False if one could not be written."""
    from engine.cli.check_fix import fix_file, fix_lines

    is_written = True
    for file in files:
        try:
            result = fix_file(file, catalogues[file.parent], likely=likely)
        except FlexcellError as error:
            sys.stderr.write(f"flexcell: {error}\n")
            is_written = False
            continue
        if result is not None:
            output.writelines(f"{line}\n" for line in fix_lines(file, result))
    return is_written


def findings_of(
    file: Path, catalogue: Catalogue, store: str = "", cell: Cell | None = None, *, targets: TargetLevel = "warning"
) -> tuple[Finding, ...]:
    """Return the findings of one document of any kind; each syntax or schema error is a finding.

    Args:
        file: The document.
        catalogue: The states by name.
        store: Store in which named entries must exist; by default those that the cell is seeded with.
        cell: Cell in which a behavior runs, or to which entries belong; by default the cell that is named.
        targets: Severity of targets that an arm cannot reach or hold without collision.
    """
    try:
        if is_python_name(str(file)):
            behavior = _load_python(file)
            known = _stored_names(behavior, store) if store else None
            context = cell_context(behavior, cell)
            findings = check_behavior(behavior, catalogue, known, cell=context)
            return findings + _target_findings(behavior, catalogue, context, targets)
        if file.name == PROJECT_FILE:
            load_project(file)
            return ()
        match document_kind(file):
            case "behavior":
                return _of_behavior(file, catalogue, store, cell, targets)
            case "cell":
                return _of_cell(load_cell(file), targets)
            case "entries":
                return check_entries_document(load_entries(file), cell_names(cell) if cell is not None else None)
            case "module":
                return check_module(load_module(file))
            case "equipment":
                load_equipment(file)
                return ()
            case kind:
                _load_of_runs(kind, file)
                return ()
    except DocumentError as error:
        return tuple(invalid_document_finding(each, file) for each in (error, *error.others))


def _of_cell(cell: Cell, targets: TargetLevel) -> tuple[Finding, ...]:
    at_rest = check_rest(cell) if targets != "off" else ()
    return tuple(sorted((*check_cell(cell), *at_rest), key=finding_sort_key))


def _of_behavior(
    file: Path, catalogue: Catalogue, store: str, cell: Cell | None, targets: TargetLevel
) -> tuple[Finding, ...]:
    survey = survey_behavior(file)
    behavior = survey.behavior
    known = _stored_names(behavior, store) if store and behavior is not None else None
    context = cell_context(behavior, cell) if behavior is not None else CellContext()
    findings = check_survey(survey, file, catalogue, known, cell=context)
    target_findings = _target_findings(behavior, catalogue, context, targets) if behavior is not None else ()
    return tuple(sorted((*findings, *target_findings), key=finding_sort_key)) if target_findings else findings


# Imported on use: for a small document, imports take most of the time of a check.


def _load_python(file: Path) -> Behavior:
    from engine.authoring.python_file import load_python_behavior

    return load_python_behavior(str(file))


def _load_of_runs(kind: str, file: Path) -> None:
    """Load a document that says how runs are executed; raises DocumentError at its first mistake."""
    if kind == "sweep":
        from engine.document.sweep import load_sweep
        from engine.sweep import SweepSubject

        SweepSubject.load(load_sweep(file))
    elif kind == "faults":
        from engine.document.faults import load_faults

        load_faults(file)
    else:
        from engine.document.substitutes import load_substitutes

        load_substitutes(file)


def _stored_names(behavior: Behavior, store: str) -> dict[str, set[str]]:
    from engine.cli.check_store import stored_names

    return stored_names(behavior, store)


def _target_findings(
    behavior: Behavior, catalogue: Catalogue, context: CellContext, level: TargetLevel
) -> tuple[Finding, ...]:
    if level == "off":
        return ()
    findings = check_targets(behavior, catalogue, cell=context)
    # A finding that prevents the check of all targets stays an error.
    return tuple(replace(each, severity=level) if each.severity == "warning" else each for each in findings)


def document_kind(file: Path) -> str:
    """Return the kind of a document, by its keys: behavior, cell, module, equipment, entries, and so on.

    Raises:
        DocumentError: the document cannot be read, or is of no known kind.
    """
    recovered = load_recovering(file)
    data = recovered.source.data if recovered.source is not None else None
    kind = kind_of(data)
    if kind is not None:
        return kind
    if recovered.mistakes:
        raise recovered.mistakes[0]
    raise DocumentError(
        "this is not a behavior, cell, module, equipment, entries, sweep, faults or substitutes document",
        where=Position(file=str(file), line=1, column=1),
        hint="a behavior has `root:`, a cell has `cell:`, a sweep has `behavior:`",
    )


def _summary(files: int, findings: list[Finding]) -> str:
    errors = sum(finding.severity == "error" for finding in findings)
    warnings = len(findings) - errors
    lines = [f"{files} checked: {_counted(errors, 'error')}, {_counted(warnings, 'warning')}"]
    if findings:
        lines.append(f"to explain a finding: flexcell check --explain {findings[0].code}")
    return "\n".join(lines) + "\n"


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
