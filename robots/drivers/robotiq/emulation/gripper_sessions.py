"""The protocols of the emulated gripper, one session a connection: Modbus RTU, Modbus TCP, and the URCap's texts."""

from __future__ import annotations

from dataclasses import replace

from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.robotiq.emulation.emulated_gripper import EmulatedGripper
from robots.drivers.robotiq.emulation.modbus_frames import (
    DEVICE_FAILURE,
    ILLEGAL_ADDRESS,
    READ_INPUT,
    RegisterRequest,
    encode_refusal,
    encode_reply,
    take_rtu_request,
    take_tcp_request,
    with_crc,
    with_mbap,
)
from robots.drivers.robotiq.gripper_registers import (
    COMMAND_ADDRESS,
    RESET,
    STATUS_ADDRESS,
    WORDS,
    GripperCommand,
    decode_command,
    encode_command,
    encode_status,
)

_LONGEST_LINE = 256
_PAUSE_S = 0.05
_UNKNOWN = b"?"


class RegisterBank:
    """The registers of the gripper, shared by all its connections.

    Args:
        gripper: What the registers command and measure.
        unit: Modbus address; requests to others are not answered.
        at_zero: Whether both blocks begin at address 0, the status among the input registers, as Modbus TCP has it.
        faults: Faults of the wire.
    """

    def __init__(self, gripper: EmulatedGripper, *, unit: int, at_zero: bool, faults: WireFaults) -> None:
        self.gripper = gripper
        self.latest = RESET
        self._unit = unit
        self._at_zero = at_zero
        self.faults = faults

    def serve(self, request: RegisterRequest) -> bytes:
        """Return the reply to a request, without CRC or header; empty if it is for another unit."""
        if request.unit != self._unit:
            return b""
        if self.faults.refuse:
            return encode_refusal(request, DEVICE_FAILURE)
        if request.failure:
            return encode_refusal(request, request.failure)
        if request.values and not self._write(request):
            return encode_refusal(request, ILLEGAL_ADDRESS)
        if not request.read_count:
            return encode_reply(request, ())
        words = self._read(request)
        return encode_refusal(request, ILLEGAL_ADDRESS) if words is None else encode_reply(request, words)

    def take(self, command: GripperCommand) -> None:
        """Take a command from any client."""
        self.latest = command
        self.gripper.command(command)

    def _write(self, request: RegisterRequest) -> bool:
        offset = request.write_to - (0 if self._at_zero else COMMAND_ADDRESS)
        if offset < 0 or offset + len(request.values) > WORDS:
            return False
        words = encode_command(self.latest)
        words[offset : offset + len(request.values)] = request.values
        self.take(decode_command(words))
        return True

    def _read(self, request: RegisterRequest) -> tuple[int, ...] | None:
        blocks = {STATUS_ADDRESS: encode_status(self.gripper.status()), COMMAND_ADDRESS: encode_command(self.latest)}
        if self._at_zero:
            blocks = {0: blocks[STATUS_ADDRESS if request.function == READ_INPUT else COMMAND_ADDRESS]}
        for start, words in blocks.items():
            offset = request.read_from - start
            if offset >= 0 and offset + request.read_count <= WORDS:
                return tuple(words[offset : offset + request.read_count])
        return None


class RtuSession:
    """Modbus RTU frames, on a serial line or in a socket; a pause ends a frame that is not complete."""

    def __init__(self, bank: RegisterBank) -> None:
        self._bank = bank
        self._buffer = bytearray()
        self._received_s = 0.0

    def feed(self, received: bytes) -> bytes:
        """Answer all complete requests."""
        now_s = self._bank.gripper.now_s()
        if now_s - self._received_s > _PAUSE_S:
            self._buffer.clear()
        self._received_s = now_s
        self._buffer.extend(received)
        replies = b""
        while (request := take_rtu_request(self._buffer)) is not None:
            reply = self._bank.serve(request)
            replies += with_crc(reply) if reply else b""
        return replies


class TcpSession:
    """Modbus TCP frames."""

    def __init__(self, bank: RegisterBank) -> None:
        self._bank = bank
        self._buffer = bytearray()

    def feed(self, received: bytes) -> bytes:
        """Answer all complete requests."""
        self._buffer.extend(received)
        replies = b""
        while (taken := take_tcp_request(self._buffer)) is not None:
            reply = self._bank.serve(taken[1])
            replies += with_mbap(taken[0], reply) if reply else b""
        return replies


class UrcapSession:
    """Lines of text: `SET` sets variables, `GET` returns one, `?` answers what is not understood."""

    def __init__(self, bank: RegisterBank) -> None:
        self._bank = bank
        self._buffer = b""

    def feed(self, received: bytes) -> bytes:
        """Answer all complete lines."""
        *lines, self._buffer = (self._buffer + received).split(b"\n")
        if len(self._buffer) > _LONGEST_LINE:
            self._buffer = b""
        return b"".join(self._line(line) for line in lines)

    def _line(self, line: bytes) -> bytes:
        words = line.decode("ascii", errors="replace").split()
        if self._bank.faults.refuse or not words:
            return _UNKNOWN
        if words[0] == "SET" and len(words) % 2 == 1 and len(words) > 1:
            return self._set(dict(zip(words[1::2], words[2::2], strict=True)))
        if words[0] == "GET" and len(words) == 2:
            value = self._values().get(words[1])
            return f"{words[1]} {value}\n".encode() if value is not None else _UNKNOWN
        return _UNKNOWN

    def _set(self, values: dict[str, str]) -> bytes:
        command = self._bank.latest
        for name, text in values.items():
            if not text.isdecimal() or int(text) > 0xFF:
                return _UNKNOWN
            value = int(text)
            match name:
                case "ACT":
                    command = replace(command, activate=bool(value))
                case "GTO":
                    command = replace(command, go=bool(value))
                case "ATR":
                    command = replace(command, release=bool(value))
                case "ARD" | "ADR":
                    pass  # the direction of an automatic release, which is not emulated
                case "POS":
                    command = replace(command, position=value)
                case "SPE":
                    command = replace(command, speed=value)
                case "FOR":
                    command = replace(command, force=value)
                case _:
                    return _UNKNOWN
        self._bank.take(command)
        return b"ack"

    def _values(self) -> dict[str, int]:
        status, command = self._bank.gripper.status(), self._bank.latest
        return {
            "ACT": int(status.activated),
            "GTO": int(status.go),
            "ATR": int(command.release),
            "ARD": 0,
            "FOR": command.force,
            "SPE": command.speed,
            "STA": int(status.activation),
            "PRE": status.position_echo,
            "OBJ": int(status.contact),
            "FLT": status.fault,
            "POS": status.position,
            "COU": round(status.current_a * 100.0),
        }
