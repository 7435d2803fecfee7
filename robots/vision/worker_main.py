"""The camera process: takes states of the world from a socket, renders and maps them, answers with the map."""

from __future__ import annotations

import os
import signal
import socket
import sys

import msgspec

from engine.child_process import end_with_parent
from engine.errors import FlexcellError
from robots.sim.framed_socket import FramedSocket, PeerGone
from robots.vision.eye import Eye
from robots.vision.worker_messages import Answer, Begin, FromWorker, Opened, Order, Refused, Tell, ToWorker

_NICE = 5


class _Mailbox:
    """The worker's end of the socket."""

    def __init__(self, connection: socket.socket) -> None:
        self._messages = FramedSocket(connection)
        self._decode = msgspec.msgpack.Decoder(ToWorker).decode
        self._encode = msgspec.msgpack.Encoder().encode
        self._waiting: list[bytes] = []

    def next(self) -> ToWorker:
        """Return the next message, once there is one."""
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
    end_with_parent(connection)
    try:
        _serve(_Mailbox(connection))
    except PeerGone:
        connection.close()


def _serve(mailbox: _Mailbox) -> None:
    begin = mailbox.next()
    if not isinstance(begin, Begin):
        return
    try:
        eye = Eye(begin.sight, repeatable=False)
        eye.warm()
    except FlexcellError as error:
        mailbox.send(_refused(error))
        return
    # Where cores are scarce, the event loop and the planners come first: a late image is dropped, nothing else.
    os.nice(_NICE)
    mailbox.send(Opened(words=eye.words))
    while True:
        match mailbox.next():
            case Tell(known=known):
                eye.know(known)
            case Order(number=number, look=look):
                try:
                    mailbox.send(Answer(number=number, seen=eye.look(look)))
                except (FlexcellError, ValueError) as error:
                    # ValueError: a pose or an array that is none; the next order may be a good one.
                    mailbox.send(_refused(error, number=number))
            case Begin():
                return


def _refused(error: Exception, *, number: int = 0) -> Refused:
    if not isinstance(error, FlexcellError):
        return Refused(message=str(error), number=number)
    where = str(error.where) if error.where is not None else ""
    return Refused(message=error.message, where=where, hint=error.hint or "", number=number)
