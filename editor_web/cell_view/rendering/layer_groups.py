"""Layer groups that each page shows or hides in its 3D view.

A group is one scene node with all objects of its kind below it. A client's own node replaces the server's node of the
same name in viser, so each client has its own visible or hidden groups.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Literal

import viser

from editor_web.cell_view.rendering.canvas import CELL, PAST, TAUGHT
from editor_web.cell_view.rendering.viser_gateway import PAGE

LayerGroup = Literal["voxels", "paths", "obstacles", "cameras", "detections", "people", "frames", "commanded"]
LAYER_GROUPS: tuple[LayerGroup, ...] = (
    "voxels", "paths", "obstacles", "cameras", "detections", "people", "frames", "commanded",
)  # fmt: skip
SHOWN_AT_FIRST: frozenset[LayerGroup] = frozenset({"voxels", "paths", "obstacles", "detections", "people"})
_KEPT_PAGES = 200


def root_of(group: LayerGroup, *, under: str = "") -> str:
    """Return the name of the root node of a group, below the node `under`."""
    return f"{under}/{group}"


class ClientLayerGroups:
    """The groups that each connected client shows, of the live scene or of a past one.

    Args:
        server: The viser server of the clients.
        changed: Called, on any thread, when the set of all shown groups may have changed.
    """

    def __init__(self, server: viser.ViserServer, *, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._lock = threading.Lock()
        self._choices: dict[str, frozenset[LayerGroup]] = {}
        self._past: frozenset[str] = frozenset()
        self._roots: dict[int, _Roots] = {}
        # Coroutines, because these run in the context of the connection, where `PAGE` is.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    @property
    def shown(self) -> frozenset[LayerGroup]:
        """The live groups that at least one client shows now."""
        with self._lock:
            pages = {roots.page for roots in self._roots.values()} - self._past
            return frozenset[LayerGroup]().union(*(self._choice(page) for page in pages))

    def show(self, page: str, groups: frozenset[LayerGroup]) -> None:
        """Show exactly these groups in the current and future clients of a page."""
        with self._lock:
            self._choices.pop(page, None)
            self._choices[page] = groups
            while len(self._choices) > _KEPT_PAGES:
                del self._choices[next(iter(self._choices))]
            self._update(page)
        self._changed()

    @property
    def past(self) -> frozenset[str]:
        """The pages that show a past scene."""
        with self._lock:
            return self._past

    def clear_past(self, client_id: int) -> None:
        """Remove all nodes of a client below `/past`."""
        with self._lock:
            roots = self._roots.get(client_id)
            if roots is not None:
                roots.clear_past()
                self._update(roots.page)

    def show_past(self, pages: frozenset[str]) -> None:
        """Show the nodes below `/past` in the clients of these pages, and the live nodes in all others."""
        with self._lock:
            changed, self._past = self._past ^ pages, pages
            for page in changed:
                self._update(page)
        if changed:
            self._changed()

    def _choice(self, page: str) -> frozenset[LayerGroup]:
        return self._choices.get(page, SHOWN_AT_FIRST)

    def _update(self, page: str) -> None:
        for roots in self._roots.values():
            if roots.page == page:
                roots.show(self._choice(page), is_past=page in self._past)

    async def _connected(self, client: viser.ClientHandle) -> None:
        page = PAGE.get()
        with self._lock:
            self._roots[client.client_id] = _Roots(client, page)
            self._update(page)
        self._changed()

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._roots.pop(client.client_id, None)
        self._changed()


class _Roots:
    """One client's own root nodes of everything that it can show or hide."""

    def __init__(self, client: viser.ClientHandle, page: str) -> None:
        self.page = page
        self._live = tuple(client.scene.add_frame(node, show_axes=False) for node in (CELL, TAUGHT))
        self._groups = {group: client.scene.add_frame(root_of(group), show_axes=False) for group in LAYER_GROUPS}
        self._scene = client.scene
        self._past, self._past_groups = _past_roots(client.scene)

    def clear_past(self) -> None:
        """Remove all nodes below `/past`."""
        self._past.remove()
        self._past, self._past_groups = _past_roots(self._scene)

    def show(self, groups: frozenset[LayerGroup], *, is_past: bool) -> None:
        """Show these groups, the bodies of the cell, and the previews."""
        for node in self._live:
            _set_visible(node, is_visible=not is_past)
        _set_visible(self._past, is_visible=is_past)
        for group in LAYER_GROUPS:
            _set_visible(self._groups[group], is_visible=group in groups and not is_past)
            _set_visible(self._past_groups[group], is_visible=group in groups)


def _past_roots(scene: viser.SceneApi) -> tuple[viser.FrameHandle, dict[LayerGroup, viser.FrameHandle]]:
    root = scene.add_frame(PAST, show_axes=False, visible=False)
    return root, {group: scene.add_frame(root_of(group, under=PAST), show_axes=False) for group in LAYER_GROUPS}


def _set_visible(frame: viser.FrameHandle, *, is_visible: bool) -> None:
    if frame.visible != is_visible:
        frame.visible = is_visible
