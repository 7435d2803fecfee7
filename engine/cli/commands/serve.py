"""`flexcell serve`: serves a cell, its runs and the dashboard on one local port."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path
from typing import Annotated

import typer

from engine.cli.capture_option import Capture, capture_folder
from engine.cli.cell_server import CellServer, ServerPorts
from engine.cli.exit_code import ExitCode
from engine.cli.inputs import Simulate, read_pairs
from engine.document.cell import load_cell
from engine.document.simulated_devices import with_simulated_devices
from engine.host.loopback import DASHBOARD_PORT
from engine.project.server_state_folder import lock_server_state_folder
from engine.project.session_recordings import KEPT, RECORDINGS, SIZE_MB, SessionRecordings
from engine.registry import load_states


def serve(
    cell: Annotated[
        Path | None, typer.Option(help="Cell to connect; without a cell, behaviors run without robots.")
    ] = None,
    simulate: Simulate = None,
    port: Annotated[
        int, typer.Option(help="TCP port of the server; 0 selects a free port.", min=0, max=65535)
    ] = DASHBOARD_PORT,
    host: Annotated[str, typer.Option(help="Loopback address to listen on.")] = "127.0.0.1",
    stop_port: Annotated[
        int,
        typer.Option(
            help="TCP port of the stop relay, which accepts STOP even while the server is blocked; 0 selects a free"
            " port.",
            min=0,
            max=65535,
        ),
    ] = 0,
    view_port: Annotated[
        int,
        typer.Option(
            help="TCP port of the 3D view, which is served from its own origin; 0 selects a free port.",
            min=0,
            max=65535,
        ),
    ] = 0,
    project: Annotated[Path, typer.Option(help="Project folder, which contains `behaviors/`.")] = Path(),
    state: Annotated[
        Path, typer.Option(help="Folder in which the server keeps its state: tokens, journal, recordings.")
    ] = Path(".flexcell"),
    seed: Annotated[
        int | None, typer.Option(help="Seed of the placement noise of parts; without a seed, no noise.", min=0)
    ] = None,
    record: Annotated[
        bool, typer.Option("--record/--no-record", help="Record every run to `recordings/` in the state folder.")
    ] = True,
    recordings_kept: Annotated[int, typer.Option(help="Maximum number of recordings kept.", min=1)] = KEPT,
    recordings_size: Annotated[
        float, typer.Option(help="Maximum total size of the recordings, in MB; the oldest are deleted first.", min=1)
    ] = SIZE_MB,
    reconcell: Annotated[
        list[str] | None,
        typer.Option(
            help="Arm that is also commanded by datagrams, ROBOT=LOOPBACK_ADDRESS, see `flexcell reconcell serve`;"
            " may be repeated."
        ),
    ] = None,
    capture: Capture = None,
    open_: Annotated[bool, typer.Option("--open", help="Open the dashboard in the browser.")] = False,
) -> None:
    """Connect a cell and serve its dashboard until Ctrl-C; robots are brought to rest before the server exits."""
    loaded = with_simulated_devices(load_cell(cell), simulate or ()) if cell is not None else None
    catalogue = load_states(project)
    sys.stderr.writelines(f"flexcell: {failure}\n" for failure in catalogue.broken.values())
    with lock_server_state_folder(state) as folder:
        recordings = (
            SessionRecordings(state / RECORDINGS, kept=recordings_kept, size_mb=recordings_size) if record else None
        )
        server = CellServer(
            catalogue=catalogue,
            host=host,
            ports=ServerPorts(page=port, stop=stop_port, view=view_port),
            project=project,
            folder=folder,
            seed=seed,
            recordings=recordings,
            datagrams=read_pairs(reconcell or (), "--reconcell"),
            open_page=open_,
            capture=capture_folder(capture),
        )
        asyncio.run(server.serve(loaded))
    raise typer.Exit(ExitCode.INTERRUPTED)
