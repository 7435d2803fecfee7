"""A process's end of the socket to the process that has started it: whole messages in, whole messages out."""

from __future__ import annotations

import socket

from robots.io.framing import FrameReader, frame_message

_READ_BYTES = 1 << 16


class PeerGone(Exception):
    """The other end was closed, or what it held when it died was lost: nothing can come or go any more.

    A process that dies with messages that it has not read resets the connection, which is no ordinary end.
    """


class FramedSocket:
    """Raises PeerGone from every call once the other end is gone.

    Args:
        connection: Blocks or does not; where it does not, `receive` gives nothing while nothing has come, and `post`
            keeps what the socket does not take.
    """

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._reader = FrameReader()
        self._unsent = bytearray()

    def receive(self) -> list[bytes]:
        """Return the messages that have become whole, waiting for a piece of one where the socket blocks.

        Raises:
            RobotError: what comes is no stream of messages.
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
        """Send a message, waiting for the socket to take it."""
        try:
            self._connection.sendall(frame_message(payload))
        except ConnectionError as error:
            raise PeerGone from error

    def post(self, payload: bytes) -> None:
        """Send a message as far as the socket takes it without a wait; `flush` sends the rest."""
        self._unsent += frame_message(payload)
        self.flush()

    def flush(self) -> None:
        """Send what waits, as far as the socket takes it."""
        if not self._unsent:
            return
        try:
            sent = self._connection.send(self._unsent)
        except BlockingIOError:
            return
        except ConnectionError as error:
            raise PeerGone from error
        del self._unsent[:sent]
