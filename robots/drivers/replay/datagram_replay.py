"""Plays the datagrams of a server back to its client: requests at their ports, in the order of their arrival."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Mapping
from dataclasses import dataclass
from types import TracebackType
from typing import Self

from robots.io.wire.datagram_ports import DatagramPorts
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.read_capture import CapturedConnection
from robots.io.wire.wire_tap import NO_TAP, Address

SET_POINT_PORTS = frozenset({20000})
"""Ports whose datagrams depend on time, so that any number of them with any values is accepted."""
_SHOWN_BYTES = 32
_log = logging.getLogger("flexcell.devices")


@dataclass(frozen=True, kw_only=True)
class _Command:
    port: int
    data: bytes
    offset: int


class DatagramReplay:
    """The server's side of captured datagrams.

    What the server sent before the first command is sent from the beginning, the rest after the command before it,
    each with its recorded delay.

    Args:
        captured: The datagrams of a client.
        host: IPv4 address to receive at.
        receiver: IPv4 address to send to, at the recorded ports.
        pace: Share of the recorded delays.
    """

    def __init__(self, captured: CapturedConnection, *, host: str, receiver: str, pace: float) -> None:
        self._host = host
        self._pace = pace
        self._commands: list[_Command] = []
        self._states: list[list[tuple[float, bytes, Address]]] = [[]]
        self._received = 0
        self._mismatch = ""
        since_s = 0.0
        ports: set[int] = set()
        for event in captured.events:
            if event.endpoints is None:
                continue
            local, remote = event.endpoints.local, event.endpoints.remote
            if event.kind == "received":
                self._states[-1].append((event.time_s - since_s, event.data, (receiver, local[1])))
                continue
            ports.add(remote[1])
            if remote[1] not in SET_POINT_PORTS:
                since_s = event.time_s
                self._commands.append(_Command(port=remote[1], data=event.data, offset=event.offset))
                self._states.append([])
        self.ports = sorted(ports)
        self._timers: list[asyncio.TimerHandle] = []

    def __enter__(self) -> Self:
        self._sockets = DatagramPorts(self._host, self.ports)
        self._sender = DatagramSocket(NO_TAP)
        self._sender.never_wait()
        for number in self._sockets.filenos():
            asyncio.get_running_loop().add_reader(number, self._sockets.read, self._take)
        self._send_states()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for number in self._sockets.filenos():
            asyncio.get_running_loop().remove_reader(number)
        for timer in self._timers:
            timer.cancel()
        self._sockets.close()
        self._sender.close()

    def state(self) -> Mapping[str, object]:
        """Return what was replayed, and why no more."""
        return {
            "mismatch": self._mismatch,
            "answered": self._received,
            "remaining_commands": len(self._commands) - self._received,
        }

    def _take(self, port: int, data: bytes, _sender: Address) -> None:
        if self._mismatch or port in SET_POINT_PORTS:
            return
        expected = self._commands[self._received] if self._received < len(self._commands) else None
        if expected is None or (expected.port, expected.data) != (port, data):
            self._mismatch = _difference(expected, port, data)
            _log.warning("the client does not do what was recorded: %s", self._mismatch)
            return
        self._received += 1
        self._send_states()

    def _send_states(self) -> None:
        """Send what the server sent after the last command, and nothing more of what it sent before."""
        for timer in self._timers:
            timer.cancel()
        loop = asyncio.get_running_loop()
        self._timers = [
            loop.call_later(self._pace * delay_s, self._sender.send, data, target)
            for delay_s, data, target in self._states[self._received]
        ]


def _difference(expected: _Command | None, port: int, data: bytes) -> str:
    found = f"port {port}: {_shown(data)}"
    if expected is None:
        return f"behind the last command of the capture {found} is sent"
    recorded = f"port {expected.port}: {_shown(expected.data)}"
    return f"offset {expected.offset} of the capture: recorded {recorded}, received {found}"


def _shown(data: bytes) -> str:
    return data[:_SHOWN_BYTES].hex(" ") + (" …" if len(data) > _SHOWN_BYTES else "")
