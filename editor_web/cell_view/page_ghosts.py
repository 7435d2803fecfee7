"""Ghosts and marks of single pages, which preview a motion or a value and are visible to no other page."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

import viser

from editor_web.cell_view.layers.marks import NO_MARKS, MarkLayer, Marks
from editor_web.cell_view.layers.path_view import GhostLayer, GhostPreviews
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.viser_gateway import PAGE
from engine.skills.planning import PathPreview

_NOTHING: GhostPreviews = {}


@dataclass(frozen=True, kw_only=True)
class _Client:
    """One connected page, with its own layers."""

    page: str
    ghosts: GhostLayer
    marks: MarkLayer


class PageGhosts:
    """The ghosts and marks of all pages; set on the event loop's thread and drawn on the drawing thread.

    Args:
        server: The viser server of the pages.
        changed: Called, on any thread, when there is something to draw.
    """

    def __init__(self, server: viser.ViserServer, *, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._lock = threading.Lock()
        self._shown: dict[str, GhostPreviews] = {}
        self._marked: dict[str, Marks] = {}
        self._clients: dict[int, _Client] = {}
        # Coroutines, because these run in the context of the connection, where `PAGE` is.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    def put(self, page: str, preview: PathPreview, *, place: int) -> None:
        """Show a preview of an arm to a page; several previews of an arm have different places."""
        with self._lock:
            self._shown[page] = {**self._shown.get(page, _NOTHING), (preview.robot, place): preview}
            self._forget(page)
        self._changed()

    def mark(self, page: str, marks: Marks) -> None:
        """Show marks to a page in the place of those before."""
        with self._lock:
            self._marked[page] = marks
            self._forget(page)
        self._changed()

    def draw(self, latest: LatestMessages, now_s: float) -> float | None:
        """Draw the changes; return the time of the next call if a ghost moves."""
        with self._lock:
            due = [(client.ghosts, self._shown.get(client.page, _NOTHING)) for client in self._clients.values()]
            marked = [(client.marks, self._marked.get(client.page, NO_MARKS)) for client in self._clients.values()]
        # Without the lock, so that `put` does not wait for meshes.
        for layer, marks in marked:
            layer.draw(marks)
        next_s = (ghosts.draw(shown, latest, now_s) for ghosts, shown in due)
        return min((each for each in next_s if each is not None), default=None)

    def _forget(self, page: str) -> None:
        """Remove the state of a disconnected page without previews."""
        if any(client.page == page for client in self._clients.values()):
            return
        if all(preview.state == "none" for preview in self._shown.get(page, _NOTHING).values()):
            self._shown.pop(page, None)
        if self._marked.get(page, NO_MARKS).is_empty:
            self._marked.pop(page, None)

    async def _connected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients[client.client_id] = _Client(
                page=PAGE.get(), ghosts=GhostLayer(client), marks=MarkLayer(client)
            )
        self._changed()

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            gone = self._clients.pop(client.client_id, None)
            if gone is not None:
                self._forget(gone.page)
