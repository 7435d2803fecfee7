"""`flexcell check`: static findings with file, line and column."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Literal

import typer

from engine.authoring.python_file import is_python_name, load_python_behavior
from engine.check import Finding, check_behavior, check_file, page_text
from engine.check.finding import new_finding
from engine.cli.check_store import stored_names
from engine.cli.exit_code import ExitCode
from engine.cli.findings import as_github, as_json, as_sarif
from engine.document import load_behavior, load_source
from engine.document.cell import load_cell
from engine.document.entries import SECTIONS, load_entries
from engine.document.project import PROJECT_FILE, load_project
from engine.errors import DocumentError, Position
from engine.plan import Catalogue
from engine.registry import load_states

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
    store: Annotated[
        str,
        typer.Option(
            help="Look for named entries in this store: a file, mongodb://…, or `cell` for that of the behavior's cell."
        ),
    ] = "",
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
    findings = [finding for file in files for finding in findings_of(file, catalogues[file.parent], store)]
    chosen = "json" if json else format_
    if chosen == "json":
        sys.stdout.write(as_json(findings) + "\n")
    elif chosen == "sarif":
        sys.stdout.write(as_sarif(findings) + "\n")
    elif chosen == "github":
        sys.stdout.writelines(as_github(finding) + "\n" for finding in findings)
    else:
        sys.stdout.writelines(f"{finding}\n" for finding in findings)
        sys.stderr.write(_summary(len(files), findings))
    if any(finding.severity == "error" for finding in findings):
        raise typer.Exit(ExitCode.BAD_INPUT)


def findings_of(file: Path, catalogue: Catalogue, store: str = "") -> tuple[Finding, ...]:
    """Return the findings of one document of any kind; one that cannot be read is one finding.

    Named entries are looked for in `store`, by default among those that the cell is seeded with.
    """
    try:
        if is_python_name(str(file)):
            behavior = load_python_behavior(str(file))
            return check_behavior(behavior, catalogue, stored_names(behavior, store) if store else None)
        if file.name == PROJECT_FILE:
            load_project(file)
            return ()
        kind = document_kind(file)
        if kind == "behavior":
            return check_file(file, catalogue, stored_names(load_behavior(file), store) if store else None)
        if kind == "cell":
            seed = load_cell(file).seed_file
            if seed is not None:
                load_entries(seed)
        else:
            load_entries(file)
    except DocumentError as error:
        where = error.where if isinstance(error.where, Position) else Position(file=str(file), line=1, column=1)
        return (new_finding("invalid-document", error.message, path="", position=where, hint=error.hint or ""),)
    return ()


def document_kind(file: Path) -> str:
    """Tell behavior, cell and entries documents apart by their keys.

    Raises:
        DocumentError: it cannot be read.
    """
    data = load_source(file).data
    for key, kind in (("root", "behavior"), ("outcomes", "behavior"), ("cell", "cell"), *_ENTRIES):
        if isinstance(data, dict) and key in data:
            return kind
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
