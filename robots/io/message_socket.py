"""The socket between a worker process and its parent, worker side: whole messages with the numbers of requests."""

from __future__ import annotations

import socket
from collections import deque
from collections.abc import Callable
from types import UnionType
from typing import Generic, TypeVar

from robots.io.framing import FrameReader, frame_payload
from robots.io.message_codec import encode_payload, payload_decoder

_READ_BYTES = 1 << 16

Received = TypeVar("Received")
Sent = TypeVar("Sent")


class PeerGone(Exception):
    """The other end was closed or reset: the connection is unusable.

    A process that dies with unread messages resets the connection instead of closing it.
    """


class MessageSocket(Generic[Received, Sent]):
    """Raises PeerGone from every call once the other end is gone.

    A message comes with the number of its request, 0 if it wants no answer; the answer has the same number.

    Args:
        connection: Blocking or non-blocking; if non-blocking, `receive` returns nothing without data, and `post`
            buffers what the socket does not accept.
        received: The union of the types of received messages.
    """

    def __init__(self, connection: socket.socket, received: type[Received] | UnionType) -> None:
        self._connection = connection
        self._reader = FrameReader()
        self._decode: Callable[[bytes], Received] = payload_decoder(received)
        self._arrived: deque[tuple[int, Received]] = deque()
        self._unsent = bytearray()

    def wait(self) -> tuple[int, Received]:
        """Wait for the next message of a blocking socket and return it with its number.

        Raises:
            RobotError: the data is not a stream of frames.
            msgspec.MsgspecError: a frame is not a message of the received types.
        """
        while not self._arrived:
            self._read()
        return self._arrived.popleft()

    def receive(self) -> list[tuple[int, Received]]:
        """Return the messages that are complete after the next read, with their numbers; raises as `wait` does.

        A blocking socket waits for data.
        """
        self._read()
        arrived = list(self._arrived)
        self._arrived.clear()
        return arrived

    def send(self, message: Sent, *, number: int = 0) -> None:
        """Send a message, waiting until the socket accepts it."""
        try:
            self._connection.sendall(frame_payload(encode_payload(message), number=number))
        except ConnectionError as error:
            raise PeerGone from error

    def post(self, message: Sent, *, number: int = 0) -> None:
        """Send as much of a message as the socket accepts without waiting; `flush` sends the rest."""
        self._unsent += frame_payload(encode_payload(message), number=number)
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

    def _read(self) -> None:
        try:
            data = self._connection.recv(_READ_BYTES)
        except BlockingIOError:
            return
        except ConnectionError as error:
            raise PeerGone from error
        if not data:
            raise PeerGone
        self._arrived.extend((number, self._decode(payload)) for number, payload in self._reader.feed(data))


class ClosedChannel(Generic[Received, Sent]):
    """Replaces the socket once the parent is gone: receives nothing, discards everything."""

    def receive(self) -> list[tuple[int, Received]]:
        """Return nothing."""
        return []

    def post(self, message: Sent, *, number: int = 0) -> None:
        """Drop a message."""

    def flush(self) -> None:
        """Nothing is buffered."""
