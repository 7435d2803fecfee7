"""The `flexcell` command: assembles the commands and reports each error as one line."""

from __future__ import annotations

import os
import sys
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from engine.cli.command_group import Commands
from engine.cli.commands.stop import REASON, release_stop, stop_cell
from engine.cli.exit_code import ExitCode
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
    reason: Annotated[str, typer.Option(help="Reason, recorded in every run that is stopped.")] = REASON,
    release: Annotated[bool, typer.Option("--release", help="Release the last stop instead: runs may start.")] = False,
) -> None:
    """Stop every run and every motion of a running server, even while the server is blocked; or release that stop.

    Exit code 0: everything is at rest. 2: no server runs there. 3: a device or the server does not confirm.
    This is not a safety function: see docs/concepts/safety.md.
    """
    raise typer.Exit(release_stop(state) if release else stop_cell(state, reason))


def _print_version(requested: bool) -> None:
    if requested:
        typer.echo(f"flexcell {version('flexcell')}")
        raise typer.Exit


@app.callback()
def options(
    show_version: Annotated[
        bool, typer.Option("--version", help="Print the version and exit.", callback=_print_version, is_eager=True)
    ] = False,
) -> None:
    """Handle the options of the top-level command."""


def main() -> None:
    """Run the command line and exit with its code."""
    # Linear algebra libraries start a thread per core, which slows down work on small matrices.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        verify_packages()
        app()
    except FlexcellError as error:
        sys.stderr.write(f"flexcell: {error}{_others(error)}\n")
        sys.exit(ExitCode.BAD_INPUT)
    except BrokenPipeError:
        # The reader of the output, such as `head`, has closed the pipe; no one can read a message.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(ExitCode.SUCCESS)
    except OSError as error:
        if error.filename is None:
            raise
        sys.stderr.write(f"flexcell: {error.filename}: {error.strerror} (check the path and its permissions)\n")
        sys.exit(ExitCode.BAD_INPUT)


def _others(error: FlexcellError) -> str:
    """Return how many further errors a rejected document has; the error itself names the first."""
    if not isinstance(error, DocumentError) or not error.others or not isinstance(error.where, Position):
        return ""
    return f"; {len(error.others)} more: flexcell check {error.where.file}"


def verify_packages() -> None:
    """Check that no package on the import path shadows one of the five packages.

    Raises:
        FlexcellError: another package of the same name would be imported instead.
    """
    home = Path(__file__).resolve().parents[2]
    for name in ("states", "robots", "editor_web", "behaviors"):
        spec = find_spec(name)
        if spec is None or not spec.origin or Path(spec.origin).resolve().parents[1] != home:
            origin = spec.origin if spec is not None else None
            raise FlexcellError(
                f"the package `{name}` resolves to {origin or 'nothing'}, not to a folder in {home}",
                hint=f"rename your own `{name}` or remove its folder from PYTHONPATH",
            )
