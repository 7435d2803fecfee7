"""Accepts connections up to a limit, and handles a lack of file descriptors without log floods."""

from __future__ import annotations

import asyncio
import logging
import socket
import time
from collections.abc import Callable

from editor_web.transport.timed_connection import PendingConnections

_BACKLOG = 256
RETRY_S = 0.5
_LOG_PERIOD_S = 60.0
_log = logging.getLogger("flexcell.server")


class Acceptor:
    """Accepts the connections of a listening socket and assigns protocols to them until it is closed.

    At the limit, the connection that has waited longest for its peer is closed for the next one; if none waits, the
    next one is closed. asyncio's own server has no limit, and logs thousands of errors per second when the process has
    no file descriptor left.

    Args:
        listener: A bound socket; closed with the acceptor.
        new_protocol: Creates the protocol of a connection.
        limit: Maximum number of connections.
        count: Returns the current number of connections.
        waiting: The connections that wait for their peers and may be closed.
    """

    def __init__(
        self,
        listener: socket.socket,
        *,
        new_protocol: Callable[[], asyncio.Protocol],
        limit: int,
        count: Callable[[], int],
        waiting: PendingConnections,
    ) -> None:
        self._listener = listener
        self._new_protocol = new_protocol
        self._limit = limit
        self._count = count
        self._waiting = waiting
        self._task: asyncio.Task[None] | None = None
        self._logged_s: dict[str, float] = {}

    def open(self) -> None:
        """Start accepting connections."""
        self._listener.setblocking(False)
        self._listener.listen(_BACKLOG)
        self._task = asyncio.create_task(self._accept_all(), name="accept")

    def close(self) -> None:
        """Stop accepting connections."""
        if self._task is not None:
            self._task.cancel()

    async def wait_closed(self) -> None:
        """Wait until accepting has stopped."""
        if self._task is not None:
            await asyncio.wait({self._task})

    async def _accept_all(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            while True:
                try:
                    wire, _ = await loop.sock_accept(self._listener)
                except OSError as error:
                    await self._make_room(f"no connection can be accepted: {error.strerror}")
                    continue
                await self._take(wire)
        finally:
            self._listener.close()

    async def _take(self, wire: socket.socket) -> None:
        if self._count() >= self._limit and not self._waiting.close_longest():
            wire.close()
            self._warn(f"the limit of {self._limit} connections is reached; a new connection was closed")
            return
        try:
            await asyncio.get_running_loop().connect_accepted_socket(self._new_protocol, wire)
        except OSError as error:
            wire.close()
            self._warn(f"a connection failed while it was accepted: {error.strerror}")

    async def _make_room(self, problem: str) -> None:
        self._warn(problem)
        # Closing takes one loop iteration; if no connection can be closed, wait.
        await asyncio.sleep(0 if self._waiting.close_longest() else RETRY_S)

    def _warn(self, problem: str) -> None:
        now_s = time.monotonic()
        if now_s - self._logged_s.get(problem, -_LOG_PERIOD_S) >= _LOG_PERIOD_S:
            self._logged_s[problem] = now_s
            _log.warning("%s; logged at most once per %.0f s", problem, _LOG_PERIOD_S)
