"""A TCP server of an emulated device: it can be cut and opened again at the same address."""

from __future__ import annotations

import asyncio
from abc import ABC, abstractmethod


class TcpServer(ABC):
    """Listens at one address and knows its connections; a subclass serves each of them.

    Args:
        host: Where to listen.
        port: 0 for a free one, which stays the same when it is opened again.
    """

    def __init__(self, *, host: str, port: int) -> None:
        self.host = host
        self.port = port
        self._server: asyncio.Server | None = None
        self._writers: set[asyncio.StreamWriter] = set()

    @property
    def clients(self) -> int:
        """Number of open connections, with those that wait."""
        return len(self._writers)

    async def open(self) -> dict[str, object]:
        """Listen, if it does not; returns where."""
        if self._server is None:
            self._server = await asyncio.start_server(self._connect, self.host, self.port, reuse_address=True)
            self.port = int(self._server.sockets[0].getsockname()[1])
        return {"host": self.host, "port": self.port}

    async def close(self) -> None:
        """Stop listening and drop all connections."""
        if self._server is not None:
            self._server.close()
            self._server = None
        self.drop_clients()

    def drop_clients(self) -> None:
        """Drop all connections, and go on listening."""
        for writer in tuple(self._writers):
            writer.transport.abort()

    async def _connect(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._writers.add(writer)
        try:
            await self.serve(reader, writer)
        except ConnectionError:
            pass  # the client, or a fault that we emulate, has dropped the connection
        finally:
            self._writers.discard(writer)
            writer.close()

    @abstractmethod
    async def serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Serve one connection until its end; a `ConnectionError` ends it."""
