"""The gripper over Modbus, through pymodbus: RTU on a serial line, RTU frames in a TCP socket, or Modbus TCP."""

from __future__ import annotations

import logging
import socket
from typing import Any

from pymodbus import FramerType, ModbusException
from pymodbus.client import ModbusSerialClient, ModbusTcpClient
from pymodbus.exceptions import ModbusIOException

from robots.drivers.robotiq.gripper_registers import (
    COMMAND_ADDRESS,
    STATUS_ADDRESS,
    WORDS,
    GripperCommand,
    GripperStatus,
    decode_status,
    encode_command,
)
from robots.drivers.robotiq.robotiq_options import ModbusTcp, RtuOverTcp, SerialLine
from robots.io.wire.link_error import LinkError
from robots.io.wire.tcp_connection import endpoints_of
from robots.io.wire.wire_tap import NO_TAP, WireTap

# What pymodbus logs is raised as well, and becomes our own message.
logging.getLogger("pymodbus.logging").setLevel(logging.CRITICAL)


_QUIET_TIMEOUTS = 2.0
_MOST_DRAINS = 10
_DRAINED_BYTES = 256
_SHOWN_BYTES = 12


class ModbusTransport:
    """Implements `DeviceTransport` over Modbus.

    Args:
        connection: Where and how.
        unit: Modbus address of the gripper.
        timeout_s: Time limit of each request.
        tap: Notes the bytes of the connection.
    """

    def __init__(
        self,
        connection: SerialLine | RtuOverTcp | ModbusTcp,
        *,
        unit: int,
        timeout_s: float,
        tap: WireTap = NO_TAP,
    ) -> None:
        self._connection = connection
        self._unit = unit
        self._timeout_s = timeout_s
        self._tap = tap
        self._client: ModbusSerialClient | ModbusTcpClient | None = None
        self._failed = False
        self._received = b""
        # The controller with Modbus TCP has its registers at 0, and the status among the input registers.
        self._at_zero = isinstance(connection, ModbusTcp)

    @property
    def address(self) -> str:
        """Host and port, or the serial device."""
        connection = self._connection
        return connection.device if isinstance(connection, SerialLine) else f"{connection.host}:{connection.port}"

    @property
    def remedy(self) -> str:
        """What to check when it does not answer."""
        match self._connection:
            case SerialLine():
                return f"check supply, cable, `device`, `baud` and unit {self._unit} of the gripper"
            case RtuOverTcp():
                return "check supply and network; on a UR arm, the RS485 URCap and the tool voltage of 24 V"
            case ModbusTcp():
                return "check supply and network, and that the controller of the gripper speaks Modbus TCP"

    def open(self) -> None:
        """Connect; commands nothing."""
        self._client = client = self._new_client()
        try:
            connected = client.connect()
        except (OSError, ModbusException) as error:
            raise LinkError(f"cannot connect: {error}") from error
        if not connected:
            raise LinkError("cannot connect")
        connection: object = client.socket
        self._tap.opened(endpoints_of(connection) if isinstance(connection, socket.socket) else None)
        if isinstance(client, ModbusSerialClient) and self._failed:
            self._drain(client)

    def close(self) -> None:
        """Disconnect."""
        if self._client is not None:
            self._client.close()
            self._client = None
            self._tap.closed()

    def read(self) -> GripperStatus:
        """Read the status registers."""
        client = self._opened()
        if self._at_zero:
            return decode_status(
                self._answer(lambda: client.read_input_registers(0, count=WORDS, device_id=self._unit))
            )
        return decode_status(
            self._answer(lambda: client.read_holding_registers(STATUS_ADDRESS, count=WORDS, device_id=self._unit))
        )

    def write(self, command: GripperCommand) -> None:
        """Write the command registers."""
        client, start = self._opened(), 0 if self._at_zero else COMMAND_ADDRESS
        self._answer(lambda: client.write_registers(start, encode_command(command), device_id=self._unit))

    def _new_client(self) -> ModbusSerialClient | ModbusTcpClient:
        common: dict[str, Any] = {"timeout": self._timeout_s, "retries": 0, "trace_packet": self._traced}
        match self._connection:
            case SerialLine() as line:
                return ModbusSerialClient(
                    line.device, framer=FramerType.RTU, baudrate=line.baud, bytesize=8, parity="N", stopbits=1, **common
                )
            case RtuOverTcp() as gateway:
                return ModbusTcpClient(gateway.host, port=gateway.port, framer=FramerType.RTU, **common)
            case ModbusTcp() as gateway:
                return ModbusTcpClient(gateway.host, port=gateway.port, framer=FramerType.SOCKET, **common)

    def _drain(self, client: ModbusSerialClient) -> None:
        """Wait until the line is quiet: RTU replies have no number, and a late one would answer the next request."""
        line: Any = client.socket
        line.timeout = _QUIET_TIMEOUTS * self._timeout_s
        try:
            quiet = any(not line.read(_DRAINED_BYTES) for _ in range(_MOST_DRAINS))
        except OSError as error:
            raise LinkError(f"the serial line failed: {error}") from error
        if not quiet:
            raise LinkError("the line is never quiet: is another master on it?")
        line.timeout = self._timeout_s
        self._failed = False

    def _opened(self) -> ModbusSerialClient | ModbusTcpClient:
        if self._client is None:
            raise LinkError("not connected")
        return self._client

    def _answer(self, request: Any) -> list[int]:
        self._received = b""
        try:
            response = request()
        except (OSError, ModbusException, IndexError, ValueError) as error:
            self._failed = True
            # pymodbus lets IndexError and ValueError of its decoders out where a frame is garbage.
            raise LinkError(f"no valid answer within {self._timeout_s:g} s{self._garbage(error)}") from error
        if response.isError():
            raise LinkError(f"the device refused the request with Modbus exception {response.exception_code}")
        return list(response.registers)

    def _garbage(self, error: Exception) -> str:
        """Return what was received instead of an answer; empty for nothing."""
        if self._received:
            return f", but bytes that are no answer: {self._received[:_SHOWN_BYTES].hex(' ')}"
        return "" if isinstance(error, ModbusIOException) else f": {_first_line(error)}"

    def _traced(self, sent: bool, packet: bytes) -> bytes:  # noqa: FBT001 - the signature is pymodbus's
        self._received += b"" if sent else packet
        if packet and sent:
            self._tap.sent(packet)
        elif packet:
            self._tap.received(packet)
        return packet


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0]
