"""`flexcell serve`: serves a cell, its runs and the dashboard on one local port."""

from __future__ import annotations

import asyncio
import signal
import sys
import webbrowser
from collections.abc import Callable, Coroutine
from contextlib import ExitStack, suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from types import FrameType
from typing import Annotated, Any

import typer

from engine.cli.exit_code import ExitCode
from engine.document.cell import Cell, load_cell
from engine.document.state_catalogue import Catalogue
from engine.host.garbage_collection import freeze_loaded_objects
from engine.host.thread_switch_interval import short_switch_interval
from engine.project.cell_runner import open_cell
from engine.project.server_state_folder import ServerStateFolder, lock_server_state_folder
from engine.project.session import Session
from engine.project.session_recordings import KEPT, RECORDINGS, SIZE_MB, SessionRecordings
from engine.registry import SERVERS, load_factory, load_states
from engine.runtime.watchdog import LoopWatchdog
from engine.stop import StopRelay
from engine.teaching import HelpingHand, guidable_robots

ServeDashboard = Callable[..., Coroutine[Any, Any, None]]


def serve(
    cell: Annotated[
        Path | None, typer.Option(help="Cell to connect; without a cell, behaviors run without robots.")
    ] = None,
    port: Annotated[int, typer.Option(help="TCP port of the server; 0 selects a free port.", min=0, max=65535)] = 8642,
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
    open_: Annotated[bool, typer.Option("--open", help="Open the dashboard in the browser.")] = False,
) -> None:
    """Connect a cell and serve its dashboard until Ctrl-C; robots are brought to rest before the server exits."""
    loaded = load_cell(cell) if cell is not None else None
    catalogue = load_states(project)
    sys.stderr.writelines(f"flexcell: {failure}\n" for failure in catalogue.broken.values())
    with lock_server_state_folder(state) as folder:
        recordings = (
            SessionRecordings(state / RECORDINGS, kept=recordings_kept, size_mb=recordings_size) if record else None
        )
        asyncio.run(
            _serve(
                loaded,
                catalogue,
                port=port,
                host=host,
                stop_port=stop_port,
                view_port=view_port,
                project=project,
                folder=folder,
                seed=seed,
                recordings=recordings,
                open_page=open_,
            )
        )
    raise typer.Exit(ExitCode.INTERRUPTED)


async def _serve(
    cell: Cell | None,
    catalogue: Catalogue,
    *,
    port: int,
    host: str,
    stop_port: int,
    view_port: int,
    project: Path,
    folder: ServerStateFolder,
    seed: int | None,
    recordings: SessionRecordings | None,
    open_page: bool,
) -> None:
    new_dashboard: ServeDashboard = load_factory(SERVERS, "dashboard")
    # Otherwise the first plan with a tree imports it, which would block the loop during another run.
    import_module("engine.runtime.tree")
    state = folder.path

    def ready(dashboard: Any) -> None:
        folder.announce(url=dashboard.url, token=dashboard.token, stop=relay.endpoint)
        # The loaded objects stay alive: a collection that scanned them would block the loop while arms move.
        freeze_loaded_objects()
        # Delays before this point affect no run.
        watched.enter_context(LoopWatchdog())
        sys.stdout.write(f"Dashboard: {dashboard.new_login_url()}\n")
        sys.stdout.write(
            "The address is valid for one login; `flexcell login` prints another. Press Ctrl-C to stop the server.\n"
        )
        sys.stdout.flush()
        if open_page:
            webbrowser.open(dashboard.new_login_url())

    if cell is not None:
        sys.stderr.write(f"Opening {cell.name} ({cell.file}); the first start compiles its code, which takes longer.\n")
    relay = StopRelay(host=host, port=stop_port)
    with folder.open_journal() as journal, short_switch_interval(), ExitStack() as watched:
        async with (
            open_cell(cell, seed=seed, relay=relay) as opened,
            HelpingHand(
                opened.bus, robots=guidable_robots(opened.bus), folder=state / "captures", file=state / "triggers.yaml"
            ),
            Session(opened, project=project, catalogue=catalogue, journal=journal, recordings=recordings) as session,
        ):
            serving = asyncio.create_task(
                new_dashboard(
                    session,
                    token_file=state / "tokens",
                    host=host,
                    port=port,
                    view_port=view_port,
                    relay=relay,
                    on_ready=ready,
                ),
                name="serve",
            )
            _on_signals(asyncio.get_running_loop(), partial(_end, serving))
            with suppress(asyncio.CancelledError), relay.watched_signals(at_once=True):
                await serving


def _end(serving: asyncio.Task[None]) -> None:
    """End the server; the relay has already stopped the robots."""
    sys.stderr.write("stopping: bringing the robots to rest\n")
    serving.cancel()


def _on_signals(loop: asyncio.AbstractEventLoop, end: Callable[[], object]) -> None:
    """Call `end` on the loop at SIGINT and SIGTERM; asyncio's own handlers would hide the signals from the relay."""

    def on_signal(_number: int, _frame: FrameType | None) -> None:
        loop.call_soon_threadsafe(end)

    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, on_signal)
