"""What single pages look at before an arm goes there: ghosts that no other page sees."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

import viser

from editor_web.cell_view.layers.path_view import GhostLayer, GhostPreviews
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.viser_gateway import PAGE
from engine.skills.planning import PathPreview

_NOTHING: GhostPreviews = {}


@dataclass(frozen=True, kw_only=True)
class _Client:
    """One connected page, with a drawing of its own."""

    page: str
    ghosts: GhostLayer


class PageGhosts:
    """The ghosts of all pages; they are put on the event loop's thread and drawn on the one that draws.

    Args:
        server: Of the pages.
        changed: Called, on any thread, when there is something to draw.
    """

    def __init__(self, server: viser.ViserServer, *, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._lock = threading.Lock()
        self._shown: dict[str, GhostPreviews] = {}
        self._clients: dict[int, _Client] = {}
        # Coroutines, because these run in the context of the connection, where `PAGE` is.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    def put(self, page: str, preview: PathPreview, *, place: int) -> None:
        """Let a page see where an arm would be; several of an arm each have their place."""
        with self._lock:
            self._shown[page] = {**self._shown.get(page, _NOTHING), (preview.robot, place): preview}
            self._forget(page)
        self._changed()

    def draw(self, newest: LatestMessages, now_s: float) -> float | None:
        """Draw what has changed; returns when to call again where a ghost moves."""
        with self._lock:
            due = [(client.ghosts, self._shown.get(client.page, _NOTHING)) for client in self._clients.values()]
        # Without the lock: whoever puts a ghost waits for no meshes.
        next_s = (ghosts.draw(shown, newest, now_s) for ghosts, shown in due)
        return min((each for each in next_s if each is not None), default=None)

    def _forget(self, page: str) -> None:
        """Keep nothing of a page that has gone and looks at nothing."""
        if any(client.page == page for client in self._clients.values()):
            return
        if all(preview.state == "none" for preview in self._shown.get(page, _NOTHING).values()):
            self._shown.pop(page, None)

    async def _connected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients[client.client_id] = _Client(page=PAGE.get(), ghosts=GhostLayer(client))
        self._changed()

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            gone = self._clients.pop(client.client_id, None)
            if gone is not None:
                self._forget(gone.page)
