"""Accepts connections, never more than a number at once, and calmly where the system has no room for more."""

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
    """Hands the connections of a listening socket to protocols until it is closed.

    When there are `limit`, the one whose peer keeps us waiting longest makes room for the next; where none
    does, the next is closed. asyncio's own server knows no limit, and logs thousands of errors a second once
    the process has no file descriptor left.

    Args:
        listener: A bound socket; closed with this.
        new_protocol: Makes the protocol of a connection.
        limit: Connections at once.
        count: Tells how many there are.
        waiting: Those that can make room.
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
        """Begin to accept."""
        self._listener.setblocking(False)
        self._listener.listen(_BACKLOG)
        self._task = asyncio.create_task(self._accept_all(), name="accept")

    def close(self) -> None:
        """Accept nothing any more."""
        if self._task is not None:
            self._task.cancel()

    async def wait_closed(self) -> None:
        """Wait until nothing is accepted any more."""
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
            self._tell(f"there are {self._limit} connections already; another was closed")
            return
        try:
            await asyncio.get_running_loop().connect_accepted_socket(self._new_protocol, wire)
        except OSError as error:
            wire.close()
            self._tell(f"a connection was lost while it was accepted: {error.strerror}")

    async def _make_room(self, problem: str) -> None:
        self._tell(problem)
        # Closing takes a round of the loop; where nobody makes room, only time does.
        await asyncio.sleep(0 if self._waiting.close_longest() else RETRY_S)

    def _tell(self, problem: str) -> None:
        now_s = time.monotonic()
        if now_s - self._logged_s.get(problem, -_LOG_PERIOD_S) >= _LOG_PERIOD_S:
            self._logged_s[problem] = now_s
            _log.warning("%s; told again after %.0f s at the earliest", problem, _LOG_PERIOD_S)
