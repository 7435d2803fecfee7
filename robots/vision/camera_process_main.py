"""The camera process: receives world states from a socket, renders and maps them, and replies with the map."""

from __future__ import annotations

import os
import signal
import socket
import sys

from engine.errors import FlexcellError
from engine.host.child_process import set_parent_death_signal
from robots.io.message_socket import MessageSocket, PeerGone
from robots.io.request_failure import RequestFailure
from robots.vision.camera_process_messages import FromCameras, PerceptionReady, ToCameras
from robots.vision.camera_rig import CameraRig
from robots.vision.known_geometry import KnownGeometry
from robots.vision.perception_messages import PerceptionRequest, PerceptionResult, PerceptionSetup

_NICE = 5


_Mailbox = MessageSocket[ToCameras, FromCameras]


def main() -> None:
    """Serve the socket whose descriptor is the first argument until the other end closes it."""
    # Ctrl-C reaches the whole process group; the parent decides when this one ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    connection = socket.socket(fileno=int(sys.argv[1]))
    set_parent_death_signal(connection)
    try:
        _serve(_Mailbox(connection, ToCameras))
    except PeerGone:
        connection.close()


def _serve(mailbox: _Mailbox) -> None:
    number, setup = mailbox.wait()
    if not isinstance(setup, PerceptionSetup):
        return
    try:
        rig = CameraRig(setup, repeatable=False)
        rig.warm()
    except FlexcellError as error:
        mailbox.send(RequestFailure.of(error), number=number)
        return
    # On few cores the event loop and the planners have priority: a late image is merely dropped.
    os.nice(_NICE)
    mailbox.send(PerceptionReady(words=rig.words), number=number)
    while True:
        number, message = mailbox.wait()
        match message:
            case KnownGeometry():
                rig.know(message)
            case PerceptionRequest():
                mailbox.send(_answer(rig, message), number=number)
            case PerceptionSetup():
                rig.change(message)


def _answer(rig: CameraRig, request: PerceptionRequest) -> PerceptionResult | RequestFailure:
    try:
        return rig.look(request)
    except (FlexcellError, ValueError) as error:
        # ValueError: an invalid pose or array; the next request may be valid.
        return RequestFailure.of(error)
