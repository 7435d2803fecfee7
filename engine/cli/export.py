"""`flexcell export`: writes a behavior made in Python as a YAML document."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.authoring.yaml_export import to_yaml, write_behavior
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import read_behavior
from engine.document.python_name import is_python_name
from engine.errors import DocumentError
from engine.registry import load_states


def export(
    behavior: Annotated[
        Path, typer.Argument(help="FILE.py:NAME, or FILE.py where it makes one behavior only.", show_default=False)
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", help="Write it here, and the behaviors it refers to beside it; else on stdout."),
    ] = None,
) -> None:
    """Write a behavior made in Python as YAML. Exit code 2, and nothing written, when it has errors."""
    if not is_python_name(str(behavior)):
        raise DocumentError("this is no Python file", where=str(behavior), hint="give FILE.py:NAME")
    made, findings = read_behavior(behavior, load_states(behavior))
    sys.stderr.writelines(f"{finding}\n" for finding in findings)
    if any(finding.severity == "error" for finding in findings):
        raise typer.Exit(ExitCode.BAD_INPUT)
    if output is None:
        sys.stdout.write(to_yaml(made))
        return
    for file in write_behavior(made, output):
        sys.stderr.write(f"wrote {file}\n")
