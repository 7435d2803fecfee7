"""The RTDE port: recipes, owners of inputs, and one data packet a period to each client."""

from __future__ import annotations

import asyncio

from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.link_faults import LinkFaults
from robots.drivers.universal_robots.emulator.rtde_variables import INPUTS, OutputReader, output_variable, write_inputs
from robots.drivers.universal_robots.emulator.ur_models import ControllerSeries
from robots.drivers.universal_robots.rtde_codec import (
    IN_USE,
    NOT_FOUND,
    PROTOCOL_VERSION,
    RecipeCodec,
    RtdeMessageLevel,
    RtdePacket,
    RtdePacketError,
    RtdePacketType,
    read_frequency,
    read_names,
    recipe_reply,
    split_packets,
    text_message,
)

_MOST_RECIPES = 255
_LOWEST_HZ = 1.0
_MOST_UNSENT_BYTES = 1_000_000
# The loop executes calls of the same time in any order.
_LATE_STEP_S = 1e-6


class RtdeServer:
    """All clients of the port, and who owns which input."""

    def __init__(self, controller: ControllerState, series: ControllerSeries, faults: LinkFaults) -> None:
        self.controller = controller
        self.series = series
        self.faults = faults
        self.owners: dict[str, RtdeSession] = {}
        self.sessions: set[RtdeSession] = set()

    def new_session(self) -> RtdeSession:
        """Return the protocol of a new connection."""
        return RtdeSession(self)

    def send_data(self, cycle: int) -> None:
        """Send to each client what is due in this cycle."""
        for session in tuple(self.sessions):
            session.send_data(cycle)


class RtdeSession(asyncio.Protocol):
    """One client."""

    def __init__(self, server: RtdeServer) -> None:
        self._server = server
        self._transport: asyncio.Transport | None = None
        self._received = bytearray()
        self._inputs: dict[int, tuple[RecipeCodec, list[str]]] = {}
        self._outputs: tuple[RecipeCodec, list[OutputReader]] | None = None
        self._every_cycles = 1
        self._late = 0
        self._late_until_s = 0.0
        self._is_started = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Take the connection, unless the link is cut."""
        assert isinstance(transport, asyncio.Transport)
        if self._server.faults.admit(transport):
            self._transport = transport
            self._server.sessions.add(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Give back the inputs that the client owned."""
        if self._transport is not None:
            self._server.faults.forget(self._transport)
        self._server.sessions.discard(self)
        for name in [name for name, owner in self._server.owners.items() if owner is self]:
            del self._server.owners[name]

    def data_received(self, data: bytes) -> None:
        """Answer what is complete; bytes that are no packet end the connection."""
        if self._transport is None:
            return
        self._received += data
        try:
            for packet in split_packets(self._received):
                self._answer(packet)
        except RtdePacketError as error:
            self._send(text_message(str(error), "RTDE", RtdeMessageLevel.EXCEPTION))
            self._transport.close()

    def send_data(self, cycle: int) -> None:
        """Send the outputs, where they are asked for and due; a client that does not read is dropped."""
        if not self._is_started or self._outputs is None or cycle % self._every_cycles:
            return
        assert self._transport is not None
        if self._transport.get_write_buffer_size() > _MOST_UNSENT_BYTES:
            self._transport.abort()
            return
        codec, readers = self._outputs
        self._send(codec.pack([read(self._server.controller) for read in readers]))

    def _send(self, packet: RtdePacket) -> None:
        transport = self._transport
        if transport is None or transport.is_closing():
            return
        faults, sent = self._server.faults, packet.encode()
        if faults.garbles:
            sent = bytes(len(sent))
        if faults.delay_s <= 0.0 and not self._late:
            transport.write(sent)
            return
        # In order, also where the link is slow no more.
        loop = asyncio.get_running_loop()
        self._late_until_s = max(self._late_until_s + _LATE_STEP_S, loop.time() + faults.delay_s)
        self._late += 1
        loop.call_at(self._late_until_s, self._send_late, transport, sent)

    def _send_late(self, transport: asyncio.Transport, sent: bytes) -> None:
        self._late -= 1
        if not transport.is_closing():
            transport.write(sent)

    def _refuse(self, reason: str) -> None:
        self._server.controller.messages.append(f"RTDE: {reason}")
        self._send(text_message(reason, "RTDE", RtdeMessageLevel.ERROR))

    def _answer(self, packet: RtdePacket) -> None:
        match packet.kind:
            case RtdePacketType.PROTOCOL_VERSION:
                is_ours = packet.payload == PROTOCOL_VERSION.to_bytes(2, "big")
                self._reply(packet.kind, bytes([is_ours]))
            case RtdePacketType.CONTROLLER_VERSION:
                version = self._server.series.version
                self._reply(packet.kind, b"".join(number.to_bytes(4, "big") for number in version))
            case RtdePacketType.SETUP_OUTPUTS:
                self._reply(packet.kind, self._set_up_outputs(packet.payload))
            case RtdePacketType.SETUP_INPUTS:
                self._reply(packet.kind, self._set_up_inputs(packet.payload))
            case RtdePacketType.START:
                self._is_started = self._outputs is not None or bool(self._inputs)
                self._reply(packet.kind, bytes([self._is_started]))
            case RtdePacketType.PAUSE:
                self._is_started = False
                self._reply(packet.kind, b"\x01")
            case RtdePacketType.DATA:
                self._take_inputs(packet.payload)
            case RtdePacketType.TEXT_MESSAGE:
                pass
            case _:
                raise RtdePacketError(f"packet type {packet.kind} is unknown")

    def _reply(self, kind: int, payload: bytes) -> None:
        self._send(RtdePacket(kind, payload))

    def _set_up_outputs(self, payload: bytes) -> bytes:
        frequency_hz, rest = read_frequency(payload)
        names = read_names(rest)
        cycle_hz = self._server.series.cycle_hz
        is_valid = _LOWEST_HZ <= frequency_hz <= cycle_hz and bool(names)
        variables = [output_variable(name) for name in names]
        types = [NOT_FOUND if variable is None else variable[0] for variable in variables]
        if not is_valid or NOT_FOUND in types:
            self._outputs = None
            return recipe_reply(0, types)
        self._outputs = RecipeCodec(1, types), [variable[1] for variable in variables if variable is not None]
        self._every_cycles = max(1, round(cycle_hz / frequency_hz))
        return recipe_reply(1, types)

    def _set_up_inputs(self, payload: bytes) -> bytes:
        names = read_names(payload)
        types = [self._input_type(name) for name in names]
        recipe = len(self._inputs) + 1
        if not names or NOT_FOUND in types or IN_USE in types or recipe > _MOST_RECIPES:
            return recipe_reply(0, types)
        for name in names:
            self._server.owners[name] = self
        self._inputs[recipe] = RecipeCodec(recipe, types), names
        return recipe_reply(recipe, types)

    def _input_type(self, name: str) -> str:
        if name not in INPUTS:
            return NOT_FOUND
        return INPUTS[name] if self._server.owners.get(name, self) is self else IN_USE

    def _take_inputs(self, payload: bytes) -> None:
        """Write the inputs; what fits no recipe is answered with a message and changes nothing."""
        recipe = self._inputs.get(payload[0]) if payload else None
        if recipe is None:
            self._refuse("data of a recipe that is not set up")
            return
        codec, names = recipe
        try:
            values = codec.unpack(payload)
        except RtdePacketError as error:
            self._refuse(str(error))
            return
        write_inputs(self._server.controller, dict(zip(names, values, strict=True)))
