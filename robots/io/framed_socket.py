"""The socket between a child process and its parent, child side: sends and receives whole messages."""

from __future__ import annotations

import socket

from robots.io.framing import FrameReader, frame_message

_READ_BYTES = 1 << 16


class PeerGone(Exception):
    """The other end was closed or reset: the connection is unusable.

    A process that dies with unread messages resets the connection instead of closing it.
    """


class FramedSocket:
    """Raises PeerGone from every call once the other end is gone.

    Args:
        connection: Blocking or non-blocking; if non-blocking, `receive` returns nothing without data, and `post`
            buffers what the socket does not accept.
    """

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._reader = FrameReader()
        self._unsent = bytearray()

    def receive(self) -> list[bytes]:
        """Return the messages completed by the next read; a blocking socket waits for data.

        Raises:
            RobotError: the data is not a stream of messages.
        """
        try:
            data = self._connection.recv(_READ_BYTES)
        except BlockingIOError:
            return []
        except ConnectionError as error:
            raise PeerGone from error
        if not data:
            raise PeerGone
        return self._reader.feed(data)

    def send(self, payload: bytes) -> None:
        """Send a message, waiting until the socket accepts it."""
        try:
            self._connection.sendall(frame_message(payload))
        except ConnectionError as error:
            raise PeerGone from error

    def post(self, payload: bytes) -> None:
        """Send as much of a message as the socket accepts without waiting; `flush` sends the rest."""
        self._unsent += frame_message(payload)
        self.flush()

    def flush(self) -> None:
        """Send buffered data, as far as the socket accepts it."""
        if not self._unsent:
            return
        try:
            sent = self._connection.send(self._unsent)
        except BlockingIOError:
            return
        except ConnectionError as error:
            raise PeerGone from error
        del self._unsent[:sent]
