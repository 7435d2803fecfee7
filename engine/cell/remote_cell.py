"""The cell of a running server, accessed over HTTP with the operator's token."""

from __future__ import annotations

from pathlib import Path

import msgspec

from engine.bus.remote_bus import server_client, verify_response
from engine.cell.cell_connection import CellConnection

_CONNECT_S = 60.0


async def connect_remote_cell(folder: Path) -> CellConnection:
    """Have the server with the state folder `folder` reconnect the lost devices of its cell; return the connection.

    Raises:
        BusError: no server runs there, or it refuses with a reason.
    """
    async with server_client(folder) as client:
        verify_response(await client.post("/api/v1/cell/connect", json={}, timeout=_CONNECT_S))
    return await remote_cell_connection(folder)


async def remote_cell_connection(folder: Path) -> CellConnection:
    """Return the connection of the server's cell. Raises as `connect_remote_cell` does."""
    async with server_client(folder) as client:
        response = verify_response(await client.get("/api/v1/cell/connection"))
    return msgspec.json.decode(response.content, type=CellConnection)
