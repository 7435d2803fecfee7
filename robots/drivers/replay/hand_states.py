"""Sends the recorded states of a Franka Hand, which belong to its requests and go to a port that these name."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Sequence

from robots.drivers.franka_hand.hand_protocol import HEADER, HandRequest
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.read_capture import CapturedConnection
from robots.io.wire.wire_tap import NO_TAP

_PORT = struct.Struct("<H")
_PORT_AT = HEADER.size + 2
# A driver reads on for as long as it likes.
_REPEATED_S = 0.02


def without_port(request: bytes) -> bytes:
    """Return a request without the port of its states, which is another one in each connection."""
    if len(request) < _PORT_AT + _PORT.size or HEADER.unpack_from(request)[0] != HandRequest.CONNECT:
        return request
    return request[:_PORT_AT] + bytes(_PORT.size) + request[_PORT_AT + _PORT.size :]


class HandStateReplay:
    """The states of a hand: after each request those that came after it, then the last of them again and again.

    Args:
        states: The capture of the states.
        requests: That of the requests, of the same time.
        receiver: Where the driver is.
        pace: Share of the recorded delays.
    """

    def __init__(self, states: CapturedConnection, requests: CapturedConnection, *, receiver: str, pace: float) -> None:
        sent_s = [requests.start_s + each.time_s for each in requests.events if each.kind == "sent"]
        self._groups: list[list[tuple[float, bytes]]] = [[] for _ in range(len(sent_s) + 1)]
        for each in states.events:
            at_s = states.start_s + each.time_s
            group = sum(time_s <= at_s for time_s in sent_s)
            if each.kind == "received":
                self._groups[group].append((at_s - sent_s[group - 1] if group else 0.0, each.data))
        self._receiver = receiver
        self._pace = pace
        self._port = 0
        self._requests = 0
        self._timers: list[asyncio.TimerHandle] = []
        self._last = b""
        self._sender = DatagramSocket(NO_TAP)
        self._sender.never_wait()

    def close(self) -> None:
        """Send no more."""
        self._cancel()
        self._sender.close()

    def take(self, requests: bytes) -> None:
        """Note the next requests of the driver, and send what the hand measured after the last of them."""
        while requests:
            code, _, size = HEADER.unpack_from(requests)
            if code == HandRequest.CONNECT:
                (self._port,) = _PORT.unpack_from(requests, _PORT_AT)
            self._requests += 1
            requests = requests[size:]
        self._send_all(self._groups[min(self._requests, len(self._groups) - 1)])

    def _send_all(self, states: Sequence[tuple[float, bytes]]) -> None:
        self._cancel()
        loop = asyncio.get_running_loop()
        self._timers = [loop.call_later(self._pace * delay_s, self._send, data) for delay_s, data in states]
        end_s = self._pace * states[-1][0] if states else 0.0
        self._timers.append(loop.call_later(end_s + _REPEATED_S, self._repeat))

    def _send(self, state: bytes) -> None:
        self._last = state
        self._sender.send(state, (self._receiver, self._port))

    def _repeat(self) -> None:
        if self._last:
            self._send(self._last)
        self._timers = [asyncio.get_running_loop().call_later(_REPEATED_S, self._repeat)]

    def _cancel(self) -> None:
        for timer in self._timers:
            timer.cancel()
        self._timers = []
