"""`flexcell adapt`: writes a behavior of another cell anew for a given one."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_pairs, read_text
from engine.document.cell import load_cell
from engine.editing.adaptation.adaptation import AdaptedBehavior, adapt, proposed_file
from engine.editing.adaptation.name_mapping import MappedName
from engine.editing.project_context import ProjectContext
from engine.editing.versions import write_atomically
from engine.errors import DocumentError
from engine.registry import load_states


def adapt_behavior(
    behavior: Annotated[Path, typer.Argument(help="The behavior document.", show_default=False)],
    cell: Annotated[Path, typer.Option(help="The cell document to adapt it to.", show_default=False)],
    map_: Annotated[
        list[str] | None,
        typer.Option(
            "--map",
            metavar="OLD=NEW",
            help="What a name becomes, such as `left=arm`; `pose:pick=grasp` where two kinds share a name, `pick=` to "
            "keep it. May be repeated; other names are proposed.",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="Write the new document to this file, and copies of behaviors inside it that name things of the old "
            "cell next to their originals; default: only print what would become of each name.",
        ),
    ] = None,
    name: Annotated[str, typer.Option(help="Name of the new behavior; default: the old one and the cell.")] = "",
) -> None:
    """Adapt a behavior of another cell: map robots, parts, cameras, frames, outputs and entries to those of the cell.

    Prints what each name becomes, then the findings of the adapted behavior; exit code 2 if it has errors.
    """
    if output is not None and output.exists():
        raise DocumentError("there is a file of this name", where=str(output), hint="choose another one")
    text = read_text(behavior)
    target = load_cell(cell)
    context = ProjectContext(load_states(behavior), behavior.parent, Path(behavior.absolute().anchor))
    choices = read_pairs(map_ or (), "--map")
    planned = output or proposed_file(behavior, target)
    made = adapt(text, file=behavior, output=planned, name=name, cell=target, context=context, choices=choices)
    sys.stdout.writelines(f"{_line(each)}\n" for each in made.plan.names)
    sys.stdout.writelines(
        f"? {each.expression} in {each.path}: a run decides the name\n" for each in made.plan.undecided
    )
    sys.stderr.writelines(
        f"{planned}:{each.line}:{each.column}: {each.severity}: {each.message} [{each.code}]\n"
        for each in made.plan.findings
    )
    if output is not None:
        _write(made)
    if any(each.severity == "error" for each in made.plan.findings):
        raise typer.Exit(ExitCode.BAD_INPUT)


def _line(each: MappedName) -> str:
    if not each.target:
        return f"- {each.kind} {each.name}: stays" + (f", {each.reason}" if each.reason else "")
    return f"+ {each.kind} {each.name} -> {each.target}" + (f" ({each.reason})" if each.reason else "")


def _write(made: AdaptedBehavior) -> None:
    for each in reversed(made.documents):
        try:
            each.file.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(each.file, each.text)
        except OSError as error:
            raise DocumentError(f"the file cannot be written: {error.strerror}", where=str(each.file)) from error
        sys.stderr.write(f"wrote {each.file}\n")
