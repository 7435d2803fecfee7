"""One port of a control cabinet: passes commands on TCP and datagrams on UDP between a client and the simulated robot.

The client names its UDP port when it connects; the simulated robot is told that of this link instead.
"""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from robots.drivers.franka.emulation.link_state import LinkState

_CONNECT = 0
_CONNECT_PAYLOAD = struct.Struct("<HH")
_INCOMPATIBLE = 1

Address = tuple[str, int]
Write = Callable[[bytes], None]


class LinkRules(Protocol):
    """Sees what passes a link, and may change it."""

    def connected(self, *, to_robot: Write, to_client: Write) -> None:
        """Note a client, and how it and the robot are written to."""
        ...

    def request(self, code: int, number: int, message: bytes) -> bool:
        """Return whether a request of the client reaches the robot."""
        ...

    def reply(self, code: int, number: int, message: bytes) -> bytes:
        """Return what the client receives instead of a reply, nothing if empty."""
        ...

    def state(self, datagram: bytes) -> bytes:
        """Return what the client receives instead of a state."""
        ...

    def command(self) -> None:
        """Note a datagram of the client."""
        ...

    def disconnected(self) -> None:
        """Note that the client has gone."""
        ...


class _Datagrams(asyncio.DatagramProtocol):
    """One UDP socket."""

    def __init__(self, received: Callable[[bytes, Address], None]) -> None:
        self._received = received

    def datagram_received(self, data: bytes, addr: Address) -> None:
        """Pass it on."""
        self._received(data, addr)


@dataclass(kw_only=True)
class _Session:
    """One connected client."""

    client: asyncio.StreamWriter
    robot: asyncio.StreamWriter
    from_robot: asyncio.DatagramTransport
    from_client: asyncio.DatagramTransport
    client_address: Address | None = None
    robot_address: Address | None = None


class CommandLink:
    """Serves one client at a time, as a control cabinet does; further ones are closed.

    Args:
        host: Address of the cabinet.
        inner_host: Address of the simulated robot.
        port: On both.
        header: Code, number and size of each message.
        rules: What is changed.
        faults: What is wrong with the network.
    """

    def __init__(
        self, *, host: str, inner_host: str, port: int, header: struct.Struct, rules: LinkRules, faults: LinkState
    ) -> None:
        self._host = host
        self._inner_host = inner_host
        self._port = port
        self._header = header
        self._rules = rules
        self._faults = faults
        self._server: asyncio.Server | None = None
        self._session: _Session | None = None
        self._is_taken = False
        self.foreign_version = 0
        """Version of a server that refuses this protocol; 0 for one that speaks it."""

    async def open(self) -> None:
        """Listen."""
        self._server = await asyncio.start_server(self._serve, self._host, self._port)

    def close(self) -> None:
        """Stop listening and disconnect the client."""
        if self._server is not None:
            self._server.close()
        self.drop()

    def drop(self) -> None:
        """Disconnect the client."""
        if self._session is not None:
            self._session.client.transport.abort()
            self._session.robot.transport.abort()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if self._is_taken or self._faults.is_cut:
            writer.transport.abort()
            return
        self._is_taken = True
        try:
            await self._serve_client(reader, writer)
        except (OSError, asyncio.IncompleteReadError):
            pass  # one side has gone: the other one follows
        except asyncio.CancelledError:
            pass  # the emulator ends: asyncio would report this as an error of the handler
        finally:
            self._is_taken = False
            self._session = None
            writer.transport.abort()
            self._rules.disconnected()

    async def _serve_client(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        loop = asyncio.get_running_loop()
        from_robot, robot = await asyncio.open_connection(self._inner_host, self._port, local_addr=(self._host, 0))
        states, _ = await loop.create_datagram_endpoint(lambda: _Datagrams(self._state), local_addr=(self._host, 0))
        commands, _ = await loop.create_datagram_endpoint(lambda: _Datagrams(self._command), local_addr=(self._host, 0))
        self._session = _Session(client=writer, robot=robot, from_robot=states, from_client=commands)
        self._rules.connected(to_robot=robot.write, to_client=writer.write)
        passing = (
            asyncio.create_task(self._pass(reader, self._request)),
            asyncio.create_task(self._pass(from_robot, self._reply)),
        )
        try:
            await asyncio.wait(passing, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in passing:
                task.cancel()
            await asyncio.gather(*passing, return_exceptions=True)
            for transport in (robot.transport, states, commands):
                transport.abort()

    async def _pass(self, reader: asyncio.StreamReader, take: Callable[[int, int, bytes], None]) -> None:
        while True:
            head = await reader.readexactly(self._header.size)
            code, number, size = self._header.unpack(head)
            message = head + await reader.readexactly(max(0, size - len(head)))
            await self._faults.pass_on()
            take(code, number, message)

    def _request(self, code: int, number: int, message: bytes) -> None:
        session = self._session
        assert session is not None
        if code == _CONNECT:
            self._connect(session, number, message)
        elif self._rules.request(code, number, message):
            session.robot.write(message)

    def _connect(self, session: _Session, number: int, message: bytes) -> None:
        start = self._header.size
        version, port = _CONNECT_PAYLOAD.unpack_from(message, start)
        if self.foreign_version:
            payload = _CONNECT_PAYLOAD.pack(_INCOMPATIBLE, self.foreign_version)
            # As long as the reply of a server that speaks it.
            size = start + len(payload) + 4
            session.client.write(self._header.pack(_CONNECT, number, size) + payload + bytes(4))
            return
        session.client_address = (str(session.client.get_extra_info("peername")[0]), port)
        ours = int(session.from_robot.get_extra_info("sockname")[1])
        session.robot.write(message[:start] + _CONNECT_PAYLOAD.pack(version, ours) + message[start + 4 :])

    def _reply(self, code: int, number: int, message: bytes) -> None:
        session = self._session
        assert session is not None
        session.client.write(self._rules.reply(code, number, message))

    def _state(self, datagram: bytes, sender: Address) -> None:
        session = self._session
        if session is None:
            return
        session.robot_address = sender
        shown = self._rules.state(datagram)
        if session.client_address is not None:
            self._send(session.from_client, shown, session.client_address)

    def _command(self, datagram: bytes, _sender: Address) -> None:
        session = self._session
        if session is not None and session.robot_address is not None and not self._faults.is_frozen:
            self._rules.command()
            self._send(session.from_robot, datagram, session.robot_address)

    def _send(self, transport: asyncio.DatagramTransport, datagram: bytes, address: Address) -> None:
        if self._faults.is_frozen:
            return
        if self._faults.delay_s:
            asyncio.get_running_loop().call_later(self._faults.delay_s, transport.sendto, datagram, address)
        else:
            transport.sendto(datagram, address)
