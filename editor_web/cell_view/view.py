"""The 3D view of one cell: viser's server, the thread that draws, and the topics that it draws from."""

from __future__ import annotations

import asyncio
import logging
import secrets
import threading
import time

import viser

from editor_web.cell_view.handles import DragHandle, DragHandles
from editor_web.cell_view.layers.scene_layers import SceneLayers
from editor_web.cell_view.page_ghosts import PageGhosts
from editor_web.cell_view.past_view import PastViews, Tell
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import ClientLayerGroups, LayerGroup
from editor_web.cell_view.rendering.viser_gateway import new_viser_server
from editor_web.cell_view.topic_subscriptions import TopicSource, TopicSubscriptions
from engine.errors import FlexcellError
from engine.skills.planning import PathPreview

PERIOD_S = 1.0 / 30.0
_log = logging.getLogger("flexcell.cell_view")


class CellView:
    """Draws the bodies, planned ways, obstacles, voxels and cameras of the backend's cell.

    Meshes are sent once; afterwards only what has changed is written, at most 30 times a second.

    Args:
        backend: Where the topics are.
        shadows: Whether lights cast shadows; slow without a graphics card.
    """

    def __init__(self, backend: TopicSource, *, shadows: bool = True) -> None:
        self._shadows = shadows
        self.key = secrets.token_urlsafe(32)
        self._server: viser.ViserServer | None = None
        self._groups: ClientLayerGroups | None = None
        self._past: PastViews | None = None
        self._handles: DragHandles | None = None
        self._ghosts: PageGhosts | None = None
        self._backend = backend
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ending = threading.Event()
        self._newest = LatestMessages()
        self._follower = TopicSubscriptions(backend, self._newest, shown=lambda: self.shown)

    @property
    def port(self) -> int:
        """viser's loopback port; the view must be open."""
        if self._server is None:
            raise FlexcellError("the cell view is not open", hint="open it first")
        return self._server.get_port()

    @property
    def shown(self) -> frozenset[LayerGroup]:
        """What at least one connected page shows now."""
        return self._groups.shown if self._groups is not None else frozenset()

    def open(self) -> None:
        """Start viser and the thread that draws; takes some 20 ms, call it off the event loop."""
        server = self._server = new_viser_server(self.key)
        server.scene.set_up_direction("+z")
        server.scene.configure_default_lights(cast_shadow=self._shadows)
        self._groups = ClientLayerGroups(server, changed=self._on_shown)
        self._past = PastViews(server, self._groups, find=self._backend.recording_files)
        handles = self._handles = DragHandles(server, changed=self._newest.arrived.set)
        ghosts = self._ghosts = PageGhosts(server, changed=self._newest.arrived.set)
        self._thread = threading.Thread(
            target=self._write, args=(server, handles, ghosts), name="cell-view", daemon=True
        )
        self._thread.start()

    def request_tunnel(self) -> str | None:
        """Return what viser answers to a page that asks to be published: always None."""
        return self._server.request_share_url() if self._server else None

    def show(self, page: str, groups: frozenset[LayerGroup]) -> None:
        """Let a page show these groups and no others; the page's name is in the path that it loads the view from."""
        if self._groups is not None:
            self._groups.show(page, groups)

    def show_past(self, page: str, run: str, time_s: float, *, tell: Tell) -> None:
        """Let a page see a run as it was at a time of it; `tell` is called, on another thread, when it does."""
        if self._past is not None:
            self._past.show(page, run, time_s, tell=tell)

    def show_present(self, page: str) -> None:
        """Let a page see the cell as it is again."""
        if self._past is not None:
            self._past.leave(page)

    def give_handle(self, page: str, handle: DragHandle) -> None:
        """Give a page, where an operator looks at it, this handle to pull at."""
        if self._handles is not None:
            self._handles.give(page, handle)

    def take_handle(self, page: str, handle: DragHandle) -> None:
        """Take this handle away from a page, which may have got another one since."""
        if self._handles is not None:
            self._handles.take(page, handle)

    def show_ghost(self, page: str, preview: PathPreview, *, place: int = 0) -> None:
        """Show a page where an arm would be, until another is shown in its place; one in the state `none` hides it."""
        if self._ghosts is not None:
            self._ghosts.put(page, preview, place=place)

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
        if self._past is not None:
            self._past.close()
            self._past = None
        if self._server is not None:
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

    def _write(self, server: viser.ViserServer, handles: DragHandles, ghosts: PageGhosts) -> None:
        draw = SceneLayers(server)
        wait_s: float | None = None
        while not self._ending.is_set():
            self._newest.arrived.wait(wait_s)
            self._newest.arrived.clear()
            due = (draw.all(self._newest, self.shown), ghosts.draw(self._newest, time.monotonic()))
            handles.draw(self._newest)
            self._ending.wait(PERIOD_S)
            next_s = min((each for each in due if each is not None), default=None)
            wait_s = None if next_s is None else max(0.0, next_s - time.monotonic())
