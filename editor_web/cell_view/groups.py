"""What can be shown and hidden in the 3D view, by each page for itself.

A group is one node of the scene with everything of its kind below. viser shows a node that a client has of its
own in the place of the server's node of that name, so each client has its own groups, visible or not.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Literal

import viser

from editor_web.cell_view.lock import PAGE

Group = Literal["voxels", "ways", "obstacles", "cameras", "people", "frames"]
GROUPS: tuple[Group, ...] = ("voxels", "ways", "obstacles", "cameras", "people", "frames")
SHOWN_AT_FIRST: frozenset[Group] = frozenset({"voxels", "ways", "obstacles", "people"})
_KEPT_PAGES = 200


def root_of(group: Group) -> str:
    """Return the name of the node that everything of a group is below."""
    return f"/{group}"


class ClientGroups:
    """Which groups each connected client shows.

    Args:
        server: Of the clients.
        changed: Called, on any thread, when what the clients show together may be another now.
    """

    def __init__(self, server: viser.ViserServer, *, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._lock = threading.Lock()
        self._choices: dict[str, frozenset[Group]] = {}
        self._roots: dict[int, dict[Group, viser.FrameHandle]] = {}
        self._pages: dict[int, str] = {}
        # Coroutines, because these run in the context of the connection, where `PAGE` is.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    @property
    def shown(self) -> frozenset[Group]:
        """The groups that at least one client shows now."""
        with self._lock:
            return frozenset[Group]().union(*(self._choice(page) for page in self._pages.values()))

    def show(self, page: str, groups: frozenset[Group]) -> None:
        """Let the clients of a page, present and to come, show these groups and no others."""
        with self._lock:
            self._choices.pop(page, None)
            self._choices[page] = groups
            while len(self._choices) > _KEPT_PAGES:
                del self._choices[next(iter(self._choices))]
            for client, of_page in self._pages.items():
                if of_page == page:
                    for group, root in self._roots[client].items():
                        root.visible = group in groups
        self._changed()

    def _choice(self, page: str) -> frozenset[Group]:
        return self._choices.get(page, SHOWN_AT_FIRST)

    async def _connected(self, client: viser.ClientHandle) -> None:
        page = PAGE.get()
        with self._lock:
            shown = self._choice(page)
            self._pages[client.client_id] = page
            self._roots[client.client_id] = {
                group: client.scene.add_frame(root_of(group), show_axes=False, visible=group in shown)
                for group in GROUPS
            }
        self._changed()

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._pages.pop(client.client_id, None)
            self._roots.pop(client.client_id, None)
        self._changed()
