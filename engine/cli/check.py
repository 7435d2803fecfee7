"""`flexcell check`: static findings with file, line and column."""

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
    check_survey,
    check_targets,
    finding_sort_key,
    invalid_document_finding,
    page_text,
)
from engine.cli.exit_code import ExitCode
from engine.cli.findings import as_github, as_json, as_sarif
from engine.document import Behavior, survey_behavior
from engine.document.cell import Cell, load_cell
from engine.document.entries_document import SECTIONS, load_entries
from engine.document.project import PROJECT_FILE, load_project
from engine.document.python_name import is_python_name
from engine.document.state_catalogue import Catalogue
from engine.document.text_recovery import load_recovering
from engine.errors import DocumentError, FlexcellError, Position
from engine.registry import load_states

TargetLevel = Literal["warning", "error", "off"]
_ENTRIES = tuple((key, "entries") for key in SECTIONS.values())


def check(
    files: Annotated[
        list[Path] | None,
        typer.Argument(help="Behavior, cell, entries or project documents, or FILE.py:NAME.", show_default=False),
    ] = None,
    format_: Annotated[
        Literal["text", "json", "github", "sarif"], typer.Option("--format", help="How findings are printed.")
    ] = "text",
    json: Annotated[bool, typer.Option("--json", help="The same as --format json.")] = False,
    cell: Annotated[
        Path | None, typer.Option(help="The cell to check behaviors and entries for; the one they name by default.")
    ] = None,
    store: Annotated[
        str,
        typer.Option(
            help="Look for named entries in this store: a file, mongodb://…, or `cell` for that of the behavior's cell."
        ),
    ] = "",
    fix: Annotated[
        bool,
        typer.Option(
            "--fix",
            help="Write those fixes of the editor into behavior documents that need no choice; name the others.",
        ),
    ] = False,
    fix_likely: Annotated[
        bool, typer.Option("--fix-likely", help="As --fix, and the first of several fixes. No node is deleted.")
    ] = False,
    targets: Annotated[
        TargetLevel,
        typer.Option(
            help="What targets count as that an arm of the cell cannot reach, or where it would be in itself or a"
            " fixture as drawn; `off` does not look."
        ),
    ] = "warning",
    explain: Annotated[
        str, typer.Option(help="Print what a kind of finding means and what to do about it.", metavar="CODE")
    ] = "",
) -> None:
    """Check documents without running anything. Exit code 2 when there is an error in any."""
    if explain:
        sys.stdout.write(page_text(explain))
        return
    if not files:
        raise typer.BadParameter("give the documents to check", param_hint="FILES")
    catalogues = {folder: load_states(folder) for folder in dict.fromkeys(file.parent for file in files)}
    around = load_cell(cell) if cell is not None else None
    chosen = "json" if json else format_
    told = sys.stdout if chosen == "text" else sys.stderr
    is_kept = not (fix or fix_likely) or _fix(files, catalogues, told, likely=fix_likely)
    findings = [
        finding
        for file in files
        for finding in findings_of(file, catalogues[file.parent], store, around, targets=targets)
    ]
    if chosen == "json":
        sys.stdout.write(as_json(findings) + "\n")
    elif chosen == "sarif":
        sys.stdout.write(as_sarif(findings) + "\n")
    elif chosen == "github":
        sys.stdout.writelines(as_github(finding) + "\n" for finding in findings)
    else:
        sys.stdout.writelines(f"{finding}\n" for finding in findings)
        sys.stderr.write(_summary(len(files), findings))
    if not is_kept or any(finding.severity == "error" for finding in findings):
        raise typer.Exit(ExitCode.BAD_INPUT)


def _fix(files: Sequence[Path], catalogues: Mapping[Path, Catalogue], told: TextIO, *, likely: bool) -> bool:
    """Fix documents and tell what was done; False where one could not be written."""
    from engine.cli.check_fix import fix_file, fix_lines

    is_kept = True
    for file in files:
        try:
            made = fix_file(file, catalogues[file.parent], likely=likely)
        except FlexcellError as error:
            sys.stderr.write(f"flexcell: {error}\n")
            is_kept = False
            continue
        if made is not None:
            told.writelines(f"{line}\n" for line in fix_lines(file, made))
    return is_kept


def findings_of(
    file: Path, catalogue: Catalogue, store: str = "", cell: Cell | None = None, *, targets: TargetLevel = "warning"
) -> tuple[Finding, ...]:
    """Return the findings of one document of any kind; each mistake in it is one.

    Args:
        file: The document.
        catalogue: The states by name.
        store: Where named entries are looked for; by default among those that the cell is seeded with.
        cell: The cell in which a behavior is to run, or of which entries are; by default the one that is named.
        targets: What targets count as that an arm cannot be at.
    """
    try:
        if is_python_name(str(file)):
            behavior = _made_in_python(file)
            known = _stored_names(behavior, store) if store else None
            context = cell_context(behavior, cell)
            findings = check_behavior(behavior, catalogue, known, cell=context)
            return findings + _at_targets(behavior, catalogue, context, targets)
        if file.name == PROJECT_FILE:
            load_project(file)
            return ()
        kind = document_kind(file)
        if kind == "behavior":
            return _of_behavior(file, catalogue, store, cell, targets)
        if kind == "cell":
            return check_cell(load_cell(file))
        return check_entries_document(load_entries(file), cell_names(cell) if cell is not None else None)
    except DocumentError as error:
        return tuple(invalid_document_finding(each, file) for each in (error, *error.others))


def _of_behavior(
    file: Path, catalogue: Catalogue, store: str, cell: Cell | None, targets: TargetLevel
) -> tuple[Finding, ...]:
    survey = survey_behavior(file)
    behavior = survey.behavior
    known = _stored_names(behavior, store) if store and behavior is not None else None
    context = cell_context(behavior, cell) if behavior is not None else CellContext()
    findings = check_survey(survey, file, catalogue, known, cell=context)
    more = _at_targets(behavior, catalogue, context, targets) if behavior is not None else ()
    return tuple(sorted((*findings, *more), key=finding_sort_key)) if more else findings


# Imported where they are wanted: a check of a small document takes mostly what is imported for it.


def _made_in_python(file: Path) -> Behavior:
    from engine.authoring.python_file import load_python_behavior

    return load_python_behavior(str(file))


def _stored_names(behavior: Behavior, store: str) -> dict[str, set[str]]:
    from engine.cli.check_store import stored_names

    return stored_names(behavior, store)


def _at_targets(
    behavior: Behavior, catalogue: Catalogue, context: CellContext, level: TargetLevel
) -> tuple[Finding, ...]:
    if level == "off":
        return ()
    found = check_targets(behavior, catalogue, cell=context)
    # What keeps the arms from being put anywhere stays an error.
    return tuple(replace(each, severity=level) if each.severity == "warning" else each for each in found)


def document_kind(file: Path) -> str:
    """Tell behavior, cell and entries documents apart by their keys.

    Raises:
        DocumentError: it cannot be read.
    """
    recovered = load_recovering(file)
    data = recovered.source.data if recovered.source is not None else None
    for key, kind in (("root", "behavior"), ("outcomes", "behavior"), ("cell", "cell"), *_ENTRIES):
        if isinstance(data, dict) and key in data:
            return kind
    if recovered.mistakes:
        raise recovered.mistakes[0]
    raise DocumentError(
        "this is no behavior, cell or entries document",
        where=Position(file=str(file), line=1, column=1),
        hint="a behavior has `root:`, a cell has `cell:`",
    )


def _summary(files: int, findings: list[Finding]) -> str:
    errors = sum(finding.severity == "error" for finding in findings)
    lines = [f"{files} checked: {errors} errors, {len(findings) - errors} warnings"]
    if findings:
        lines.append(f"what a finding means: flexcell check --explain {findings[0].code}")
    return "\n".join(lines) + "\n"
