"""The cameras of single pages, which the server turns to a place that a page asks for."""

from __future__ import annotations

import threading

import numpy as np
import viser

from editor_web.cell_view.rendering.viser_gateway import PAGE
from engine.messages import Vector3

DISTANCE_M = 1.1
"""Distance of the camera from the place that it is turned to; it is seen with what is around it."""
_FROM_ABOVE = np.array((0.6, -0.6, 0.5))


class PageCameras:
    """The cameras of all connected pages; thread-safe.

    Args:
        server: The viser server of the pages.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._lock = threading.Lock()
        self._clients: dict[int, tuple[str, viser.ClientHandle]] = {}
        # Coroutines, because these run in the context of the connection, where `PAGE` is.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    def look_at(self, page: str, xyz: Vector3) -> None:
        """Bring the camera of a page near a point of the world, from the side on which it is."""
        with self._lock:
            clients = [client for name, client in self._clients.values() if name == page]
        for client in clients:
            position = camera_position(client.camera.position, xyz)
            with client.atomic():
                client.camera.position = position
                client.camera.look_at = xyz

    async def _connected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients[client.client_id] = (PAGE.get(), client)

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients.pop(client.client_id, None)


def camera_position(before: np.ndarray, xyz: Vector3) -> Vector3:
    """Return the position at `DISTANCE_M` from a point, in the direction of `before`, but never from below."""
    direction = np.asarray(before, dtype=np.float64) - np.asarray(xyz)
    length = float(np.linalg.norm(direction))
    if not np.isfinite(length) or length < 1e-6 or direction[2] < 0.2 * length:
        direction = _FROM_ABOVE
    x_m, y_m, z_m = np.asarray(xyz) + direction / np.linalg.norm(direction) * DISTANCE_M
    return (float(x_m), float(y_m), float(z_m))
