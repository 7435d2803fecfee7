"""A send buffer for a socket that may be full because its reader is suspended."""

from __future__ import annotations

import asyncio
import socket


class Outbox:
    """Sends bytes in order without blocking; bytes that the socket does not accept are sent when it is writable.

    Belongs to the running event loop. The reader of the socket detects that the other end is closed.
    """

    def __init__(self, connection: socket.socket) -> None:
        self._loop = asyncio.get_running_loop()
        self._connection = connection
        self._unsent = bytearray()

    @property
    def empty(self) -> bool:
        """Whether all bytes are sent."""
        return not self._unsent

    def send(self, data: bytes = b"") -> None:
        """Send the buffered bytes, then `data`, as far as the socket accepts them."""
        self._unsent += data
        try:
            del self._unsent[: self._connection.send(self._unsent)]
        except BlockingIOError:
            # The writer below sends the rest.
            pass
        except OSError:
            self._unsent.clear()
        if self._unsent:
            self._loop.add_writer(self._connection.fileno(), self.send)
        else:
            self._loop.remove_writer(self._connection.fileno())

    def close(self) -> None:
        """Stop sending and discard the buffered bytes."""
        self._loop.remove_writer(self._connection.fileno())
        self._unsent.clear()
