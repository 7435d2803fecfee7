"""`flexcell new` and `flexcell examples`: begin a project, or copy an example."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.new_project.examples import EXAMPLES, example_files
from engine.new_project.project_template import project_files, require_project_name, write_project


def new(
    name: Annotated[
        str, typer.Argument(help="Name of the project, its folder and its Python package.", show_default=False)
    ],
    example: Annotated[
        str,
        typer.Option("--example", help="Copy this example instead: see `flexcell examples`.", show_default=False),
    ] = "",
) -> None:
    """Begin a project: a folder with a cell, a behavior, a state of your own, a test and CI, which runs at once.

    `flexcell new press_cell`
    """
    folder = Path(name)
    if example:
        write_project(folder, example_files(example))
        behavior = f"behaviors/{EXAMPLES[example].behavior}"
    else:
        require_project_name(name)
        write_project(folder, project_files(name))
        behavior = "behaviors/move_block.yaml"
    sys.stdout.write(
        f"{folder}/\nRun it: cd {folder} && flexcell run {behavior} --clock virtual\n"
        + ("" if example else "Then read README.md there.\n")
    )


def examples() -> None:
    """List the examples that `flexcell new NAME --example EXAMPLE` copies."""
    width = max(map(len, EXAMPLES))
    for name, example in EXAMPLES.items():
        sys.stdout.write(f"{name:<{width}}  {example.shows}\n")
