"""Serves the interface of one arm of an open cell: receives commands, sends the state, at the ports of the document."""

from __future__ import annotations

import asyncio
import ipaddress
import logging
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import msgspec

from engine.bus import SkillBus
from engine.errors import FlexcellError
from engine.messages import RobotDescription
from robots.io.wire.datagram_ports import DatagramPorts
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.wire_capture import WireCapture
from robots.reconcell.command_interface import CommandInterface
from robots.reconcell.interface_options import InterfaceOptions
from robots.reconcell.packet_table import command_ports
from robots.reconcell.reconcell_status import ReconcellStatus
from robots.reconcell.state_broadcast import StateBroadcast

_log = logging.getLogger("flexcell.reconcell")


def new_reconcell_server(
    bus: SkillBus, robot: str, *, is_stopped: Callable[[], bool] = lambda: False, **options: Any
) -> ReconcellServer:
    """Return the server, for the entry point `flexcell.servers`; `options` are those of `InterfaceOptions`.

    Raises:
        FlexcellError: as `ReconcellServer` does, or an option has a value that it cannot have.
    """
    try:
        chosen = msgspec.convert(options, InterfaceOptions)
    except msgspec.ValidationError as error:
        raise FlexcellError(str(error), hint="flexcell reconcell serve --help") from error
    return ReconcellServer(bus, robot, chosen, is_stopped=is_stopped)


class ReconcellServer:
    """The interface of one arm, served from entering to leaving the block; at its end the arm is at rest.

    Args:
        bus: The bus of the open cell.
        robot: The arm.
        options: Addresses, rate, watchdogs.
        is_stopped: Whether the cell is stopped until an operator releases it; no motion starts then.

    Raises:
        FlexcellError: there is no such arm, it has not six joints, or an address is not permitted.
    """

    def __init__(
        self,
        bus: SkillBus,
        robot: str,
        options: InterfaceOptions,
        *,
        is_stopped: Callable[[], bool] = lambda: False,
    ) -> None:
        if not _is_loopback(options.address):
            raise FlexcellError(
                "commands are received on this machine only",
                where=options.address,
                hint="use an address of 127/8; a program elsewhere needs a tunnel of its own",
            )
        if not 0.0 < options.rate_hz <= 1000.0:
            raise FlexcellError(f"the rate is {options.rate_hz:g} Hz", hint="above 0, at most 1000")
        description = bus.find_topic(f"{robot}/description").latest
        if not isinstance(description, RobotDescription):
            raise FlexcellError("it does not describe itself as an arm", where=robot)
        self._bus = bus
        self._options = options
        self.interface = CommandInterface(bus, description, options=options, is_stopped=is_stopped)
        self._broadcast = StateBroadcast(bus, description, self.interface, order=options.quaternion)
        self._status = bus.topic(f"{robot}/reconcell", ReconcellStatus)
        self._commands: DatagramPorts | None = None
        self._tap = WireCapture(Path(options.capture) if options.capture else None, device=robot).tap(
            "reconcell_server"
        )
        self._states: DatagramSocket | None = None
        self._sending: asyncio.Task[None] | None = None
        self._unreachable: set[str] = set()

    async def __aenter__(self) -> Self:
        self._commands = DatagramPorts(self._options.address, command_ports(), tap=self._tap)
        self._states = DatagramSocket(self._tap)
        self._states.never_wait()
        self._states.permit_broadcast()
        self._status.provide(lambda: self.interface.status)
        loop = asyncio.get_running_loop()
        for number in self._commands.filenos():
            loop.add_reader(number, self._read)
        self._sending = loop.create_task(self._send_states(), name="state of the ReconCell interface")
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._commands is not None
        assert self._states is not None
        assert self._sending is not None
        loop = asyncio.get_running_loop()
        for number in self._commands.filenos():
            loop.remove_reader(number)
        self._commands.close()
        self._sending.cancel()
        await asyncio.wait((self._sending,))
        await self.interface.commands.close()
        self._states.close()

    def _read(self) -> None:
        if self._commands is not None:
            self._commands.read(self.interface.receive)

    async def _send_states(self) -> None:
        clock, period_s = self._bus.clock, 1.0 / self._options.rate_hz
        due_s = clock.now_s()
        published = self.interface.status
        while True:
            self.interface.look()
            self._send(await self._state_of_now())
            if (status := self.interface.status) != published:
                published = status
                self._status.publish(status)
            # Packets that are late are left out.
            due_s = max(due_s + period_s, clock.now_s())
            await clock.sleep(due_s - clock.now_s())

    async def _state_of_now(self) -> tuple[tuple[int, bytes], ...]:
        try:
            return await self._broadcast.datagrams()
        except Exception:
            # A defect in the state must not end the watch over a silent commander.
            _log.exception("no state of %s is sent", self._status.name)
            return ()

    def _send(self, datagrams: tuple[tuple[int, bytes], ...]) -> None:
        assert self._states is not None
        for receiver in self._options.receivers:
            try:
                for port, data in datagrams:
                    self._states.send(data, (receiver, port))
            except OSError as error:
                if receiver not in self._unreachable:
                    self._unreachable.add(receiver)
                    _log.warning("the state does not reach %s: %s", receiver, error)


def _is_loopback(address: str) -> bool:
    try:
        return ipaddress.IPv4Address(address).is_loopback
    except ValueError:
        return False
