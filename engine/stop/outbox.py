"""What waits to be sent on a socket that may be full, because whoever reads it is suspended."""

from __future__ import annotations

import asyncio
import socket


class Outbox:
    """Sends bytes in order without ever waiting; what the socket does not take follows when it does.

    Belongs to the running event loop. That the other end has gone is left to whoever reads the socket.
    """

    def __init__(self, connection: socket.socket) -> None:
        self._loop = asyncio.get_running_loop()
        self._connection = connection
        self._unsent = bytearray()

    @property
    def empty(self) -> bool:
        """Whether everything is sent."""
        return not self._unsent

    def send(self, data: bytes = b"") -> None:
        """Send what waits, then `data`, as far as the socket takes it."""
        self._unsent += data
        try:
            del self._unsent[: self._connection.send(self._unsent)]
        except BlockingIOError:
            # The writer below goes on.
            pass
        except OSError:
            self._unsent.clear()
        if self._unsent:
            self._loop.add_writer(self._connection.fileno(), self.send)
        else:
            self._loop.remove_writer(self._connection.fileno())

    def close(self) -> None:
        """Send no more."""
        self._loop.remove_writer(self._connection.fileno())
        self._unsent.clear()
