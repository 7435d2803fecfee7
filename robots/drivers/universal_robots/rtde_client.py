"""One RTDE connection to a controller, without a library: outputs at its control frequency, and inputs."""

from __future__ import annotations

import struct
import time
from collections.abc import Sequence

from robots.drivers.universal_robots.rtde_codec import (
    IN_USE,
    NOT_FOUND,
    PROTOCOL_VERSION,
    RecipeCodec,
    RtdePacket,
    RtdePacketError,
    RtdePacketType,
    RtdeValue,
    read_names,
    split_packets,
)
from robots.io.wire.link_error import LinkError
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

_READ_BYTES = 65_536
_VERSION = struct.Struct(">4I")


class RtdeVersionError(LinkError):
    """The controller does not offer what this client needs; says what."""


class RtdeInputsInUse(LinkError):
    """Another client owns inputs; says which."""


class RtdeClient:
    """Used by one thread. Every call ends within its limit, or raises LinkError.

    Args:
        host: Address of the controller.
        port: Its RTDE port.
        limit_s: Time limit of the connection and of each answer.
        tap: Notes its bytes.
    """

    def __init__(self, host: str, port: int, *, limit_s: float, tap: WireTap = NO_TAP) -> None:
        self._address = (host, port)
        self._tap = tap
        self._limit_s = limit_s
        self._connection: TcpConnection | None = None
        self._received = bytearray()
        self._queued: list[RtdePacket] = []
        self._unsent = bytearray()
        self._outputs: RecipeCodec | None = None
        self._inputs: RecipeCodec | None = None

    def connect(self) -> tuple[int, int, int, int]:
        """Connect and return the version of the controller; commands nothing."""
        try:
            self._connection = TcpConnection(self._address, timeout_s=self._limit_s, tap=self._tap)
        except OSError as error:
            raise LinkError(f"cannot connect: {error.strerror or error}") from error
        accepted = self._ask(RtdePacketType.PROTOCOL_VERSION, PROTOCOL_VERSION.to_bytes(2, "big"))
        if accepted != b"\x01":
            raise RtdeVersionError(f"the controller does not speak protocol {PROTOCOL_VERSION} of RTDE")
        version = self._ask(RtdePacketType.CONTROLLER_VERSION)
        if len(version) != _VERSION.size:
            raise LinkError(f"the answer to the version has {len(version)} bytes, expected {_VERSION.size}")
        major, minor, bugfix, build = _VERSION.unpack(version)
        return major, minor, bugfix, build

    def choose_outputs(self, names: Sequence[str], *, optional: Sequence[str], frequency_hz: float) -> tuple[str, ...]:
        """Say what the controller sends once it is started, and return that with the optional ones that it has.

        Raises:
            RtdeVersionError: it lacks one that is not optional.
        """
        chosen = [*names, *optional]
        types = self._set_up_outputs(chosen, frequency_hz)
        missing = [name for name, kind in zip(chosen, types, strict=True) if kind == NOT_FOUND]
        if needed := [name for name in missing if name in names]:
            raise RtdeVersionError(f"the controller offers no {', '.join(needed)}")
        if missing:
            chosen = [name for name in chosen if name not in missing]
            types = self._set_up_outputs(chosen, frequency_hz)
        if self._outputs is None or NOT_FOUND in types:
            raise LinkError(f"the controller refuses outputs at {frequency_hz:g} Hz")
        return tuple(chosen)

    def start(self) -> None:
        """Have the controller send its outputs; one whose client reads none closes the connection."""
        if self._ask(RtdePacketType.START) != b"\x01":
            raise LinkError("the controller does not start its outputs")

    def own_inputs(self, names: Sequence[str], types: Sequence[str]) -> None:
        """Become the owner of inputs, which only then can be written.

        Raises:
            RtdeInputsInUse: another client owns one.
            RtdeVersionError: the controller lacks one.
        """
        recipe, answered = self._recipe(RtdePacketType.SETUP_INPUTS, ",".join(names).encode(), len(names))
        taken = [name for name, kind in zip(names, answered, strict=True) if kind == IN_USE]
        if taken:
            raise RtdeInputsInUse(f"another client writes {taken[0]}")
        if tuple(answered) != tuple(types) or recipe == 0:
            raise RtdeVersionError("the controller offers other inputs than expected")
        self._inputs = RecipeCodec(recipe, types)

    def latest(self, limit_s: float) -> list[RtdeValue] | None:
        """Wait for outputs and return the newest; None if there are none within the limit."""
        last: list[RtdeValue] | None = None
        end_s = time.monotonic() + limit_s
        while last is None:
            left_s = end_s - time.monotonic()
            if left_s <= 0.0 and not self._has_bytes():
                return None
            last = self._take(max(0.001, left_s))
        # What has queued up while this process was late is not of interest.
        while self._has_bytes():
            last = self._take(0.001) or last
        return last

    def write(self, values: Sequence[RtdeValue]) -> None:
        """Send inputs; does not wait for a controller that takes none, which is left out then."""
        assert self._inputs is not None
        connection = self._opened()
        try:
            while self._has_bytes():
                self._take(0.001)
            if not self._unsent:
                self._unsent += self._inputs.pack(values).encode()
            del self._unsent[: connection.send_some(self._unsent)]
        except OSError as error:
            raise _lost(error) from error

    def close(self) -> None:
        """Disconnect, which gives the inputs back."""
        connection, self._connection = self._connection, None
        if connection is not None:
            connection.close()

    def _set_up_outputs(self, names: Sequence[str], frequency_hz: float) -> list[str]:
        payload = struct.pack(">d", frequency_hz) + ",".join(names).encode()
        recipe, types = self._recipe(RtdePacketType.SETUP_OUTPUTS, payload, len(names))
        self._outputs = RecipeCodec(recipe, types) if recipe else None
        return types

    def _recipe(self, kind: RtdePacketType, payload: bytes, count: int) -> tuple[int, list[str]]:
        """Return number and types of a recipe that is set up."""
        answer = self._ask(kind, payload)
        try:
            types = read_names(answer[1:])
        except RtdePacketError as error:
            raise LinkError(str(error)) from error
        if not answer or len(types) != count:
            raise LinkError(f"a recipe of {count} variables is answered with {len(types)} types")
        return answer[0], types

    def _ask(self, kind: RtdePacketType, payload: bytes = b"") -> bytes:
        """Return the payload of the answer to a request."""
        connection = self._opened()
        end_s = time.monotonic() + self._limit_s
        try:
            connection.set_timeout(self._limit_s)
            connection.send(RtdePacket(kind, payload).encode())
        except OSError as error:
            raise _lost(error) from error
        while (left_s := end_s - time.monotonic()) > 0.0:
            packets = self._packets(left_s)
            for number, packet in enumerate(packets, start=1):
                if packet.kind == kind:
                    # Data may have come together with the answer.
                    self._queued = packets[number:]
                    return packet.payload
        raise LinkError(f"no answer to a request within {self._limit_s:g} s")

    def _take(self, limit_s: float) -> list[RtdeValue] | None:
        """Return the newest outputs of what arrives next."""
        last: bytes | None = None
        for packet in self._packets(limit_s):
            if packet.kind == RtdePacketType.DATA:
                last = packet.payload
        if last is None or self._outputs is None:
            return None
        try:
            return self._outputs.unpack(last)
        except RtdePacketError as error:
            raise LinkError(str(error)) from error

    def _has_bytes(self) -> bool:
        """Whether something has arrived that was not read; also the end of the connection."""
        connection = self._opened()
        if self._queued:
            return True
        try:
            return connection.has_bytes()
        except OSError as error:
            raise _lost(error) from error

    def _packets(self, limit_s: float) -> list[RtdePacket]:
        """Return the packets that are complete once something has arrived; none if nothing does within the limit."""
        connection = self._opened()
        if self._queued:
            queued, self._queued = self._queued, []
            return queued
        try:
            connection.set_timeout(limit_s)
            received = connection.receive(_READ_BYTES)
        except TimeoutError:
            return []
        except OSError as error:
            raise _lost(error) from error
        if not received:
            raise LinkError("the controller closed the connection")
        self._received += received
        try:
            return split_packets(self._received)
        except RtdePacketError as error:
            raise LinkError(str(error)) from error

    def _opened(self) -> TcpConnection:
        if self._connection is None:
            raise LinkError("not connected")
        return self._connection


def _lost(error: OSError) -> LinkError:
    return LinkError(f"the connection failed: {error.strerror or error}")
