"""What drivers make of bytes: their codecs, and their whole transports on sockets."""

from __future__ import annotations

import re
import socket
import struct
from collections.abc import Callable
from typing import Protocol

import msgspec

from benchmarks.fuzz_target import FuzzTarget
from robots.drivers.abb.simple_message import JOINTS, Frame, JointPosition, MessageType, SimpleMessageCodec
from robots.drivers.abb.state_transport import StateTransport
from robots.drivers.franka_hand.hand_protocol import (
    HEADER,
    STATE,
    HandRequest,
    decode_state,
    encode_connect,
    take_message,
)
from robots.drivers.robotiq.emulation.modbus_frames import with_crc, with_mbap
from robots.drivers.robotiq.modbus_transport import ModbusTransport
from robots.drivers.robotiq.robotiq_options import ModbusTcp, RtuOverTcp, UrcapSocket
from robots.drivers.robotiq.urcap_codec import STATUS_NAMES, decode_reply, status_of
from robots.drivers.robotiq.urcap_transport import UrcapTransport
from robots.drivers.servo_arm.servo_lines import decode_reply as decode_board_reply
from robots.drivers.softhand.hand_frames import (
    HandCommandCode,
    HandFrame,
    decode_words,
    encode_frame,
    encode_words,
    take_frame,
)
from robots.drivers.softhand.hand_transport import HandTransport
from robots.drivers.universal_robots.rtde_codec import (
    RecipeCodec,
    RtdePacketError,
    RtdePacketType,
    split_packets,
)
from robots.drivers.universal_robots.ur_faults import dashboard_fault
from robots.io.wire.link_error import LinkError
from robots.io.wire.pcapng_blocks import CaptureDamaged, CapturedPacket, CaptureInterface, CaptureSection, encode_block
from robots.io.wire.read_capture import decode_capture
from robots.reconcell.packet_codec import decode_packet
from robots.reconcell.packet_errors import PacketRefused

_STATUS = bytes.fromhex("3100 0300 0305")
_TIMEOUT_S = 0.05
_RECIPE = ("DOUBLE", "VECTOR6D", "INT32", "UINT32", "BOOL")


def urcap_codec() -> FuzzTarget:
    """Replies to GET."""
    values: dict[str, int] = {str(name): 0 for name in STATUS_NAMES}

    def feed(packet: bytes) -> str:
        try:
            values["OBJ"] = decode_reply("OBJ", packet)
            status_of(values)
        except LinkError:
            return "LinkError"
        return ""

    return FuzzTarget("urcap", "to the driver", (b"OBJ 3\n", b"OBJ 0\n", b"POS 3\n", b"?"), feed, lambda: False)


def softhand_codec() -> FuzzTarget:
    """Frames of a hand."""
    frames = (
        HandFrame(unit=1, command=HandCommandCode.GET_ACTIVATE, data=b"\x03"),
        HandFrame(unit=1, command=HandCommandCode.GET_INPUTS, data=encode_words(700, 0)),
        HandFrame(unit=1, command=HandCommandCode.GET_CURRENTS_AND_MEASUREMENTS, data=encode_words(60, 0, 700, 0, 0)),
    )
    buffer = bytearray()

    def feed(packet: bytes) -> str:
        buffer.extend(packet)
        try:
            frame = take_frame(buffer)
            if frame is None:
                return "ignored"
            decode_words(frame.data, 5)
        except LinkError as error:
            return type(error).__name__
        return ""

    return FuzzTarget("softhand", "to the driver", tuple(map(encode_frame, frames)), feed, lambda: False)


def franka_hand_codec() -> FuzzTarget:
    """Replies of a hand, which are laid out as requests are, and its states."""
    replies = (HEADER.pack(HandRequest.MOVE, 7, HEADER.size + 4) + bytes(4), encode_connect(0, udp_port=50_000))
    buffer = bytearray()

    def feed(packet: bytes) -> str:
        buffer.extend(packet)
        try:
            state = decode_state(packet)
            message = take_message(buffer)
            if message is not None:
                _ = message.status
        except LinkError as error:
            buffer.clear()
            return type(error).__name__
        return "" if state is not None or message is not None else "ignored"

    state = STATE.pack(1, 0.03, 0.08, 1, 25)
    return FuzzTarget("franka_hand", "to the driver", (*replies, state), feed, lambda: False)


def servo_codec() -> FuzzTarget:
    """Lines of a board."""
    lines = (
        b"READY flexcell_servo_arm 1",
        b"OK 45.0 120.0 place",
        b"HALT watchdog 45.0 120.0 pick",
        b"ERR out of range",
    )
    return FuzzTarget(
        "servo_lines",
        "to the driver",
        lines,
        lambda packet: "" if decode_board_reply(packet.strip(), servos=2) else "ignored",
        lambda: False,
    )


def simple_message_codec() -> FuzzTarget:
    """Measurements, states and replies of an IRC5."""
    codec = SimpleMessageCodec()
    position = codec.encode_joint_position(JointPosition(sequence=0, joints_rad=(0.1,) * JOINTS))
    status = codec.encode_frame(
        Frame(kind=MessageType.STATUS, comm=1, reply=0, data=struct.pack("<7i", 1, 0, 0, 0, 0, 2, 1))
    )
    reply = codec.encode_frame(Frame(kind=MessageType.TRAJECTORY_POINT, comm=3, reply=1, data=b""))
    decoders: dict[int, Callable[[Frame], object]] = {
        MessageType.JOINT_POSITION: codec.decode_joint_position,
        MessageType.STATUS: codec.decode_status,
    }

    def feed(packet: bytes) -> str:
        try:
            frames = codec.split(bytearray(packet))
            for frame in frames:
                decoders.get(frame.kind, codec.decode_reply)(frame)
        except LinkError as error:
            return str(error).partition(":")[0]
        return "" if frames else "ignored"

    return FuzzTarget("simple_message", "to the driver", (position, status, reply), feed, lambda: False)


def rtde_codec() -> FuzzTarget:
    """Data packets of a controller."""
    codec = RecipeCodec(1, _RECIPE)
    data = codec.pack([1.5, (0.0, -1.5, 1.5, -1.5, -1.5, 0.0), 7, 1, True]).encode()

    def feed(packet: bytes) -> str:
        try:
            packets = split_packets(bytearray(packet))
            for each in packets:
                if each.kind == RtdePacketType.DATA:
                    codec.unpack(each.payload)
        except RtdePacketError:
            return "RtdePacketError"
        return "" if packets else "ignored"

    return FuzzTarget("rtde", "to the driver", (data, b"\x00\x05V\x01\x01"), feed, lambda: False)


def dashboard_answer() -> FuzzTarget:
    """Answers of the dashboard to `safetystatus`."""
    lines = (b"Safetystatus: NORMAL", b"Safetystatus: PROTECTIVE_STOP", b"Safetystatus: FAULT")
    return FuzzTarget(
        "ur_dashboard",
        "to the driver",
        lines,
        lambda packet: "" if dashboard_fault(packet.decode("utf-8", "replace").strip()) else "ignored",
        lambda: False,
    )


def reconcell_state() -> FuzzTarget:
    """State packets, the first two bytes of each being its port here."""
    sizes = {15000: 360, 15001: 7, 15002: 1, 15003: 2, 15004: 2, 15005: 48, 15006: 48}
    valid = tuple(struct.pack(">H", port) + bytes(size) for port, size in sizes.items())

    def feed(packet: bytes) -> str:
        port = int.from_bytes(packet[:2])
        try:
            decode_packet(port, packet[2:], direction="state")
        except PacketRefused as refused:
            return refused.name
        return ""

    return FuzzTarget("reconcell", "to the driver", valid, feed, lambda: False)


def capture_reader() -> FuzzTarget:
    """Files of captures, which people send to one another."""
    blocks = (
        CaptureSection(comment="c", application="flexcell"),
        CaptureInterface(link_type=250, device="arm", protocol="servo_lines"),
        CapturedPacket(time_ns=1, data=bytes.fromhex("00000000 00000000 01 10 0000 3F0A"), outbound=True),
    )
    valid = (b"".join(map(encode_block, blocks)),)

    def feed(packet: bytes) -> str:
        try:
            decode_capture(packet)
        except CaptureDamaged:
            return "CaptureDamaged"
        return ""

    return FuzzTarget("capture", "to the driver", valid, feed, lambda: False)


class _Transport(Protocol):
    def open(self) -> None: ...
    def read(self) -> object: ...
    def close(self) -> None: ...


def transport(
    protocol: str, valid: tuple[bytes, ...], new: Callable[[str, int], _Transport], *, share: float = 0.01
) -> FuzzTarget:
    """A whole transport on a socket: the device answers each reading with a packet, and closes the connection."""
    server = socket.create_server(("127.0.0.1", 0))
    host, port = server.getsockname()
    device = new(host, port)

    def feed(packet: bytes) -> str:
        device.open()
        client, _ = server.accept()
        with client:
            client.sendall(packet)
            client.shutdown(socket.SHUT_WR)
            try:
                device.read()
            except LinkError as error:
                return re.split(r":|, but| with ", str(error))[0]
            finally:
                device.close()
        return ""

    return FuzzTarget(f"{protocol} transport", "to the driver", valid, feed, lambda: False, share)


def _hand_reading() -> bytes:
    answers = ((HandCommandCode.GET_ACTIVATE, b"\x03"), (HandCommandCode.GET_INPUTS, encode_words(0, 0)))
    last = (HandCommandCode.GET_CURRENTS_AND_MEASUREMENTS, encode_words(60, 0, 0, 0, 0))
    return b"".join(encode_frame(HandFrame(unit=1, command=code, data=data)) for code, data in (*answers, last))


def _states() -> tuple[bytes, ...]:
    position, status, _ = simple_message_codec().valid
    return (position + status, position, status)


def _modbus(kind: type[RtuOverTcp | ModbusTcp], host: str, port: int) -> ModbusTransport:
    return ModbusTransport(
        msgspec.convert({"kind": kind.__struct_config__.tag, "host": host, "port": port}, kind),
        unit=9,
        timeout_s=_TIMEOUT_S,
    )


DRIVERS: tuple[Callable[[], FuzzTarget], ...] = (
    urcap_codec,
    softhand_codec,
    franka_hand_codec,
    servo_codec,
    simple_message_codec,
    rtde_codec,
    dashboard_answer,
    reconcell_state,
    capture_reader,
)
TRANSPORTS: tuple[Callable[[], FuzzTarget], ...] = (
    lambda: transport(
        "modbus_tcp", (with_mbap(1, b"\x09\x04\x06" + _STATUS),), lambda host, port: _modbus(ModbusTcp, host, port)
    ),
    lambda: transport(
        "rtu_over_tcp", (with_crc(b"\x09\x03\x06" + _STATUS),), lambda host, port: _modbus(RtuOverTcp, host, port)
    ),
    lambda: transport(
        "urcap",
        (b"".join(f"{name} 3\n".encode() for name in STATUS_NAMES),),
        lambda host, port: UrcapTransport(UrcapSocket(host=host, port=port), timeout_s=_TIMEOUT_S),
    ),
    lambda: transport(
        "softhand",
        (_hand_reading(),),
        lambda host, port: HandTransport(f"socket://{host}:{port}", baud=2_000_000, unit=1, timeout_s=_TIMEOUT_S),
        # pyserial waits 0.3 s at each end of a connection.
        share=0.0002,
    ),
    lambda: transport(
        "simple_message_state",
        _states(),
        lambda host, port: StateTransport(host, port, byte_order="little", timeout_s=_TIMEOUT_S),
    ),
)
