"""The camera process: receives world states from a socket, renders and maps them, and replies with the map."""

from __future__ import annotations

import os
import signal
import socket
import sys

import msgspec

from engine.errors import FlexcellError
from engine.host.child_process import set_parent_death_signal
from robots.io.framed_socket import FramedSocket, PeerGone
from robots.vision.camera_process_messages import (
    FromWorker,
    PerceptionAnswer,
    PerceptionOrder,
    PerceptionReady,
    PerceptionRefusal,
    StartPerception,
    ToWorker,
    UpdateKnownGeometry,
)
from robots.vision.camera_rig import CameraRig

_NICE = 5


class _Mailbox:
    """The worker's end of the socket."""

    def __init__(self, connection: socket.socket) -> None:
        self._messages = FramedSocket(connection)
        self._decode = msgspec.msgpack.Decoder(ToWorker).decode
        self._encode = msgspec.msgpack.Encoder().encode
        self._waiting: list[bytes] = []

    def next(self) -> ToWorker:
        """Wait for the next message and return it."""
        while not self._waiting:
            self._waiting = self._messages.receive()
        return self._decode(self._waiting.pop(0))

    def send(self, message: FromWorker) -> None:
        """Send a message."""
        self._messages.send(self._encode(message))


def main() -> None:
    """Serve the socket whose descriptor is the first argument until the other end closes it."""
    # Ctrl-C reaches the whole process group; the parent decides when this one ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    connection = socket.socket(fileno=int(sys.argv[1]))
    set_parent_death_signal(connection)
    try:
        _serve(_Mailbox(connection))
    except PeerGone:
        connection.close()


def _serve(mailbox: _Mailbox) -> None:
    begin = mailbox.next()
    if not isinstance(begin, StartPerception):
        return
    try:
        eye = CameraRig(begin.sight, repeatable=False)
        eye.warm()
    except FlexcellError as error:
        mailbox.send(_refused(error))
        return
    # On few cores the event loop and the planners have priority: a late image is merely dropped.
    os.nice(_NICE)
    mailbox.send(PerceptionReady(words=eye.words))
    while True:
        match mailbox.next():
            case UpdateKnownGeometry(known=known):
                eye.know(known)
            case PerceptionOrder(number=number, look=look):
                try:
                    mailbox.send(PerceptionAnswer(number=number, seen=eye.look(look)))
                except (FlexcellError, ValueError) as error:
                    # ValueError: an invalid pose or array; the next request may be valid.
                    mailbox.send(_refused(error, number=number))
            case StartPerception():
                return


def _refused(error: Exception, *, number: int = 0) -> PerceptionRefusal:
    if not isinstance(error, FlexcellError):
        return PerceptionRefusal(message=str(error), number=number)
    where = str(error.where) if error.where is not None else ""
    return PerceptionRefusal(message=error.message, where=where, hint=error.hint or "", number=number)
