"""`flexcell cell`: connection of the devices of a running server's cell."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.cell.cell_connection import CellConnection
from engine.cell.remote_cell import connect_remote_cell, remote_cell_connection
from engine.cli.exit_code import ExitCode
from engine.host.state_folder_names import STATE_FOLDER

app = typer.Typer(
    help="Show or restore the connection to the devices of a running server's cell.", no_args_is_help=True
)

Folder = Annotated[Path, typer.Option("--server", help="Folder in which `flexcell serve` keeps its state.")]
_STATE = Path(STATE_FOLDER)


@app.command("status")
def status(server: Folder = _STATE) -> None:
    """Show whether every device is connected; exit code 1 if the connection to one is lost."""
    _print_connection(asyncio.run(remote_cell_connection(server)))


@app.command("connect")
def connect(server: Folder = _STATE) -> None:
    """Reconnect lost devices without restarting the server; rejected while a run is active.

    `flexcell cell connect`
    """
    _print_connection(asyncio.run(connect_remote_cell(server)))


def _print_connection(connection: CellConnection) -> None:
    sys.stdout.write(("connected" if connection.connected else "lost") + "\n")
    if connection.reason:
        sys.stderr.write(f"{connection.reason}\n")
    if not connection.connected:
        raise typer.Exit(ExitCode.OTHER_OUTCOME)
