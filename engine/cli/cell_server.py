"""Serves a cell until a signal, and opens it anew each time that a person switches what is simulated."""

from __future__ import annotations

import asyncio
import sys
import webbrowser
from collections.abc import Callable, Coroutine, Mapping
from contextlib import AbstractAsyncContextManager, AsyncExitStack, ExitStack, suppress
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from engine.cli.terminal.end_signals import end_at_signals
from engine.document.cell import Cell
from engine.document.state_catalogue import Catalogue
from engine.errors import FlexcellError
from engine.host.garbage_collection import freeze_loaded_objects
from engine.host.thread_switch_interval import short_switch_interval
from engine.journal import Journal
from engine.project.cell_reopening import CellReopening
from engine.project.cell_runner import open_cell
from engine.project.server_state_folder import ServerStateFolder
from engine.project.session import Session
from engine.project.session_recordings import SessionRecordings
from engine.registry import SERVERS, load_factory
from engine.runtime.watchdog import LoopWatchdog
from engine.stop import StopRelay
from engine.teaching import HelpingHand, guidable_robots

ServeDashboard = Callable[..., Coroutine[Any, Any, None]]
NewDatagramServer = Callable[..., AbstractAsyncContextManager[Any]]


@dataclass(frozen=True, kw_only=True)
class ServerPorts:
    """TCP ports of the page, of STOP and of the 3D view; 0 for a free one."""

    page: int
    stop: int
    view: int


@dataclass(kw_only=True)
class CellServer:
    """One server; the ports that it has found free stay the same while the cell is opened anew."""

    catalogue: Catalogue
    host: str
    ports: ServerPorts
    project: Path
    folder: ServerStateFolder
    seed: int | None
    recordings: SessionRecordings | None
    datagrams: Mapping[str, str]
    """Arms that are also commanded by datagrams, with the loopback addresses on which they are."""
    open_page: bool
    capture: Path | None
    """Folder to which the bytes of all connections to real devices are captured."""
    _serving: asyncio.Task[None] | None = field(default=None, init=False)
    _has_served: bool = field(default=False, init=False)
    _ends: bool = field(default=False, init=False)

    async def serve(self, cell: Cell | None) -> None:
        """Serve until SIGINT or SIGTERM.

        A cell that cannot be opened as a person has switched it is opened as it was before, and says why.

        Raises:
            FlexcellError: the cell cannot be opened, or a port is taken.
        """
        # Otherwise the first plan with a tree imports it, which would block the loop during another run.
        import_module("engine.runtime.tree")
        before: Cell | None = None
        problem = ""
        with self.folder.open_journal() as journal, short_switch_interval():
            while True:
                try:
                    following = await self._serve(cell, journal, CellReopening(cell, problem=problem))
                except _NotOpened as failure:
                    if before is None:
                        raise failure.error from None
                    problem = str(failure.error)
                    sys.stderr.write(f"flexcell: {problem}; the cell is opened as it was before\n")
                    cell, before = before, None
                    continue
                if following is None or self._ends:
                    return
                before, cell, problem = cell, following, ""

    async def _serve(self, cell: Cell | None, journal: Journal, reopening: CellReopening) -> Cell | None:
        """Serve a cell; returns the one that a person wants opened next, None after a signal."""
        new_dashboard: ServeDashboard = load_factory(SERVERS, "dashboard")
        state = self.folder.path
        if cell is not None:
            note = "the first start compiles its code, which takes longer"
            simulated = f" Simulated: {', '.join(cell.simulated)}." if cell.simulated else ""
            sys.stderr.write(f"Opening {cell.name} ({cell.file}); {note}.{simulated}\n")
        relay = StopRelay(host=self.host, port=self.ports.stop)
        async with AsyncExitStack() as stack:
            try:
                opened = await stack.enter_async_context(
                    open_cell(cell, seed=self.seed, relay=relay, capture=self.capture)
                )
            except FlexcellError as error:
                raise _NotOpened(error) from error
            robots = guidable_robots(opened.bus)
            hand = HelpingHand(opened.bus, robots=robots, folder=state / "captures", file=state / "triggers.yaml")
            await stack.enter_async_context(hand)
            session = Session(
                opened,
                project=self.project,
                catalogue=self.catalogue,
                journal=journal,
                recordings=self.recordings,
                reopening=reopening,
            )
            await stack.enter_async_context(session)
            for robot, address in self.datagrams.items():
                new_server: NewDatagramServer = load_factory(SERVERS, "reconcell")
                server = new_server(
                    opened.bus,
                    robot,
                    address=address,
                    capture=str(self.capture or ""),
                    is_stopped=lambda: session.recovery.is_latched,
                )
                await stack.enter_async_context(server)
            watched = stack.enter_context(ExitStack())
            serving = asyncio.create_task(
                new_dashboard(
                    session,
                    token_file=state / "tokens",
                    host=self.host,
                    port=self.ports.page,
                    view_port=self.ports.view,
                    relay=relay,
                    on_ready=partial(self._ready, relay, watched),
                ),
                name="serve",
            )
            requested = asyncio.create_task(reopening.requested(), name="opened anew")
            requested.add_done_callback(lambda _: serving.cancel())
            self._serving = serving
            end_at_signals(self._end)
            try:
                with suppress(asyncio.CancelledError), relay.watched_signals(at_once=True):
                    if self._ends:
                        serving.cancel()
                    await serving
            finally:
                requested.cancel()
            return requested.result() if requested.done() and not requested.cancelled() and not self._ends else None

    def _end(self) -> None:
        """End the server; the relay has already stopped the robots. A cell that is being opened is closed again."""
        self._ends = True
        sys.stderr.write("stopping: bringing the robots to rest\n")
        if self._serving is not None:
            self._serving.cancel()

    def _ready(self, relay: StopRelay, watched: ExitStack, dashboard: Any) -> None:
        self.folder.announce(url=dashboard.url, token=dashboard.token, stop=relay.endpoint)
        # The loaded objects stay alive: a collection that scanned them would block the loop while arms move.
        freeze_loaded_objects()
        # Delays before this point affect no run.
        watched.enter_context(LoopWatchdog())
        is_first = not self._has_served
        self._has_served = True
        # An open page allows itself these addresses only.
        stop = urlsplit(relay.endpoint.url).port if relay.endpoint is not None else None
        self.ports = ServerPorts(page=dashboard.port, view=dashboard.view_port or 0, stop=stop or 0)
        if not is_first:
            sys.stdout.write("The cell is open again.\n")
            sys.stdout.flush()
            return
        sys.stdout.write(f"Dashboard: {dashboard.new_login_url()}\n")
        sys.stdout.write(
            "The address is valid for one login; `flexcell login` prints another. Press Ctrl-C to stop the server.\n"
        )
        sys.stdout.flush()
        if self.open_page:
            webbrowser.open(dashboard.new_login_url())


class _NotOpened(Exception):
    """The cell was not opened."""

    def __init__(self, error: FlexcellError) -> None:
        super().__init__(str(error))
        self.error = error
