"""The 3D view of one cell: viser's server, the thread that draws, and the topics that it draws from."""

from __future__ import annotations

import asyncio
import io
import logging
import secrets
import threading
import time
from contextlib import redirect_stdout

import viser

from editor_web.cell_view.bodies import Bodies
from editor_web.cell_view.cameras import Cameras
from editor_web.cell_view.follow import Follower, Topics
from editor_web.cell_view.groups import ClientGroups, Group
from editor_web.cell_view.lock import new_server
from editor_web.cell_view.newest import Newest
from editor_web.cell_view.obstacles import Obstacles
from editor_web.cell_view.occupancy import Voxels
from editor_web.cell_view.ways import Ways
from engine.errors import FlexcellError

PERIOD_S = 1.0 / 30.0
_log = logging.getLogger("flexcell.cell_view")


class CellView:
    """Draws the bodies, planned ways, obstacles, voxels and cameras of the backend's cell.

    Meshes are sent once; afterwards only what has changed is written, at most 30 times a second.

    Args:
        backend: Where the topics are.
        shadows: Whether lights cast shadows; slow without a graphics card.
    """

    def __init__(self, backend: Topics, *, shadows: bool = True) -> None:
        self._shadows = shadows
        self.key = secrets.token_urlsafe(32)
        self._server: viser.ViserServer | None = None
        self._groups: ClientGroups | None = None
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ending = threading.Event()
        self._newest = Newest()
        self._follower = Follower(backend, self._newest, shown=lambda: self.shown)

    @property
    def port(self) -> int:
        """viser's loopback port; the view must be open."""
        if self._server is None:
            raise FlexcellError("the cell view is not open", hint="open it first")
        return self._server.get_port()

    @property
    def shown(self) -> frozenset[Group]:
        """What at least one connected page shows now."""
        return self._groups.shown if self._groups is not None else frozenset()

    def open(self) -> None:
        """Start viser and the thread that draws; takes some 20 ms, call it off the event loop."""
        server = self._server = new_server(self.key)
        server.scene.set_up_direction("+z")
        server.scene.configure_default_lights(cast_shadow=self._shadows)
        self._groups = ClientGroups(server, changed=self._on_shown)
        self._thread = threading.Thread(target=self._write, args=(server,), name="cell-view", daemon=True)
        self._thread.start()

    def request_tunnel(self) -> str | None:
        """Return what viser answers to a page that asks to be published: always None."""
        return self._server.request_share_url() if self._server else None

    def show(self, page: str, groups: frozenset[Group]) -> None:
        """Let a page show these groups and no others; the page's name is in the path that it loads the view from."""
        if self._groups is not None:
            self._groups.show(page, groups)

    async def subscribe(self) -> None:
        """Follow the cell's topics, on the event loop's thread."""
        self._loop = asyncio.get_running_loop()
        await self._follower.open()

    async def unsubscribe(self) -> None:
        """Stop following, on the event loop's thread."""
        self._loop = None
        await self._follower.close()

    def close(self) -> None:
        """End the threads; may take a second, call it off the event loop."""
        self._ending.set()
        self._newest.arrived.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        if self._server is not None:
            with redirect_stdout(io.StringIO()):
                self._server.stop()
            self._server = None

    def _on_shown(self) -> None:
        """On whatever thread: somebody looks at something else now."""
        self._newest.arrived.set()
        loop = self._loop
        if loop is not None:
            try:
                loop.call_soon_threadsafe(self._follower.ask)
            except RuntimeError:
                # The loop has just been closed: nothing is followed any more.
                _log.debug("the last page left after the event loop had ended")

    def _write(self, server: viser.ViserServer) -> None:
        draw = _Drawing(server)
        wait_s: float | None = None
        while not self._ending.is_set():
            self._newest.arrived.wait(wait_s)
            self._newest.arrived.clear()
            next_s = draw.all(self._newest, self.shown)
            self._ending.wait(PERIOD_S)
            wait_s = None if next_s is None else max(0.0, next_s - time.monotonic())


class _Drawing:
    """Everything that is drawn, each kind by itself."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._bodies = Bodies(server)
        self._ways = Ways(server)
        self._obstacles = Obstacles(server)
        self._voxels = Voxels(server)
        self._cameras = Cameras(server)

    def all(self, newest: Newest, shown: frozenset[Group]) -> float | None:
        """Draw what has changed; returns when, on the steady clock, to draw again without a new message."""
        now_s = time.monotonic()
        self._bodies.draw(newest)
        self._obstacles.draw(newest)
        due = (
            self._ways.draw(newest, now_s, is_shown="ways" in shown),
            self._voxels.draw(newest, now_s),
            self._cameras.draw(newest, now_s),
        )
        return min((each for each in due if each is not None), default=None)
