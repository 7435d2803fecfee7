"""The `flexcell` command: puts the commands together and turns errors into one line."""

from __future__ import annotations

import os
import sys
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from engine.cli.commands import Commands
from engine.cli.exit_code import ExitCode
from engine.cli.stop import REASON, stop_cell
from engine.errors import DocumentError, FlexcellError, Position
from engine.host.state_folder_names import STATE_FOLDER

app = typer.Typer(
    cls=Commands,
    help="Run, check and serve behaviors of robot work cells.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def stop(
    state: Annotated[Path, typer.Option(help="Folder in which the server keeps its state.")] = Path(STATE_FOLDER),
    reason: Annotated[str, typer.Option(help="Why; runs that end by it say so.")] = REASON,
) -> None:
    """Stop every run and every motion of a running server, whatever the server does.

    Exit code 0: everything is at rest. 2: no server runs there. 3: somebody does not confirm it.
    This is no safety function: see docs/concepts/safety.md.
    """
    raise typer.Exit(stop_cell(state, reason))


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"flexcell {version('flexcell')}")
        raise typer.Exit


@app.callback()
def options(
    show_version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Take the options that hold for every command."""


def main() -> None:
    """Run the command line; the console script."""
    # Linear algebra libraries start a thread per core; small matrices only lose by it.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        verify_packages()
        app()
    except FlexcellError as error:
        sys.stderr.write(f"flexcell: {error}{_others(error)}\n")
        sys.exit(ExitCode.BAD_INPUT)
    except BrokenPipeError:
        # The reader of our output, such as `head`, has left; there is nobody to tell.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(ExitCode.SUCCESS)


def _others(error: FlexcellError) -> str:
    """Say how many other mistakes a document has that was refused with its first."""
    if not isinstance(error, DocumentError) or not error.others or not isinstance(error.where, Position):
        return ""
    return f"; {len(error.others)} more: flexcell check {error.where.file}"


def verify_packages() -> None:
    """Check that nothing on the import path shadows one of the five packages.

    Raises:
        FlexcellError: a package of the same name elsewhere would be imported instead of ours.
    """
    home = Path(__file__).resolve().parents[2]
    for name in ("states", "robots", "editor_web", "behaviors"):
        spec = find_spec(name)
        if spec is None or not spec.origin or Path(spec.origin).resolve().parents[1] != home:
            found = spec.origin if spec is not None else "nowhere"
            raise FlexcellError(
                f"the package `{name}` was found at {found}, not in {home}",
                hint=f"rename your own `{name}` or take its folder off PYTHONPATH",
            )
