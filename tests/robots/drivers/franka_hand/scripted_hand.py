"""A Franka Hand that does what a test says, and needs no simulator."""

from __future__ import annotations

import socket
import threading

from robots.drivers.franka_hand.hand_protocol import (
    HAND_PORT,
    HAND_VERSION,
    HEADER,
    STATE,
    HandReply,
    HandRequest,
)
from tests.robots.own_address import own_address

LIMIT_S = 60.0


class ScriptedHand:
    """The hand's side of both sockets; it answers a stop by itself."""

    def __init__(self) -> None:
        self.host = own_address()
        self._listener = socket.create_server((self.host, HAND_PORT))
        self._states = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._commands: socket.socket | None = None
        self._state_port = 0
        self.requests: list[HandRequest] = []
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()

    def end(self, number: int) -> None:
        """Say that a request has ended."""
        self._reply(HandRequest.GRASP, number)

    def measure(self, *, is_grasping: bool, width_m: float = 0.02) -> None:
        """Send a state."""
        state = STATE.pack(1, width_m, 0.08, is_grasping, 30)
        self._states.sendto(state, ("127.0.0.1", self._state_port))

    def close(self) -> None:
        """End; the transport is closed before."""
        self._thread.join(LIMIT_S)
        for each in (self._commands, self._listener, self._states):
            if each is not None:
                each.close()

    def _serve(self) -> None:
        client = self._commands = self._listener.accept()[0]
        with client.makefile("rb") as stream:
            while header := stream.read(HEADER.size):
                code, number, size = HEADER.unpack(header)
                payload = stream.read(size - HEADER.size)
                request = HandRequest(code)
                self.requests.append(request)
                if request is HandRequest.CONNECT:
                    self._state_port = int.from_bytes(payload[2:4], "little")
                    self._reply(request, number, HAND_VERSION)
                if request is HandRequest.STOP:
                    self._reply(request, number)

    def _reply(self, request: HandRequest, number: int, *words: int) -> None:
        assert self._commands is not None
        payload = b"".join(word.to_bytes(2, "little") for word in (HandReply.SUCCESS, *words))
        self._commands.sendall(HEADER.pack(request, number, HEADER.size + len(payload)) + payload)
