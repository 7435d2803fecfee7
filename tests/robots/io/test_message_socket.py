"""The worker's end of the wire waits for nobody who does not listen, and takes messages once they are whole."""

from __future__ import annotations

import socket

import msgspec
import pytest

from robots.io.framing import frame_payload
from robots.io.message_codec import encode_payload
from robots.io.message_socket import MessageSocket, PeerGone


class Note(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """A message."""

    number: int
    filling: bytes = b""


class Bell(msgspec.Struct, frozen=True, kw_only=True, tag=True):
    """Another message."""


Message = Note | Bell


def test_messages_to_a_parent_that_does_not_listen_are_kept_in_order_and_nothing_waits() -> None:
    """Far more than the socket holds; each comes whole once there is somebody."""
    ours, theirs = socket.socketpair()
    theirs.setblocking(False)
    with ours, theirs:
        worker, parent = (
            MessageSocket[Message, Message](theirs, Message),
            MessageSocket[Message, Message](ours, Message),
        )
        for number in range(1, 41):
            worker.post(Note(number=number, filling=bytes(100_000)), number=number)
        heard: list[tuple[int, int]] = []
        while len(heard) < 40:
            for request, message in parent.receive():
                assert isinstance(message, Note)
                heard.append((request, message.number))
            worker.flush()
        assert heard == [(number, number) for number in range(1, 41)]


def test_messages_that_came_in_pieces_are_taken_once_they_are_whole_and_their_end_is_reported() -> None:
    ours, theirs = socket.socketpair()
    theirs.setblocking(False)
    with theirs:
        worker = MessageSocket[Message, Message](theirs, Message)
        sent = frame_payload(encode_payload(Note(number=7)), number=3) + frame_payload(encode_payload(Bell()))
        taken = [worker.receive()]
        for piece in (sent[:3], sent[3:-1], sent[-1:]):
            ours.sendall(piece)
            taken.append(worker.receive())
        assert taken == [[], [], [(3, Note(number=7))], [(0, Bell())]]
        ours.close()
        with pytest.raises(PeerGone):
            worker.receive()


def test_messages_that_came_together_are_waited_for_one_by_one_and_none_is_lost() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        worker = MessageSocket[Message, Message](theirs, Message)
        for number in (1, 2, 3):
            ours.sendall(frame_payload(encode_payload(Note(number=number)), number=number))
        assert worker.wait() == (1, Note(number=1))
        theirs.setblocking(False)
        assert worker.receive() == [(2, Note(number=2)), (3, Note(number=3))]
