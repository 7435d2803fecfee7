"""`flexcell export`: writes a behavior defined in Python as a YAML document."""

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
        Path, typer.Argument(help="FILE.py:NAME, or FILE.py if it defines only one behavior.", show_default=False)
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o",
            "--output",
            help="Write the document to this file, and the behaviors that it references next to it; default: stdout.",
        ),
    ] = None,
) -> None:
    """Write a behavior defined in Python as YAML. If it has errors, write nothing; exit code 2."""
    if not is_python_name(str(behavior)):
        raise DocumentError("this is not a Python file", where=str(behavior), hint="give FILE.py:NAME")
    made, findings = read_behavior(behavior, load_states(behavior))
    sys.stderr.writelines(f"{finding}\n" for finding in findings)
    if any(finding.severity == "error" for finding in findings):
        raise typer.Exit(ExitCode.BAD_INPUT)
    if output is None:
        sys.stdout.write(to_yaml(made))
        return
    for file in write_behavior(made, output):
        sys.stderr.write(f"wrote {file}\n")
