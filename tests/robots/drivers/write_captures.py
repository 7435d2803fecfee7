"""Writes `captures/`: a short exchange of each protocol with its emulator, by a driver or a foreign client.

Run: python -m tests.robots.drivers.write_captures [PROTOCOL…]. `test_drivers_golden_captures` compares what is in them
with bytes that were written by hand; addresses and times are replaced by those of an example.
"""

from __future__ import annotations

import asyncio
import dataclasses
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from robots.drivers.abb.abb_faults import AbbLinkError
from robots.drivers.abb.abb_options import GripperStrings
from robots.drivers.abb.egm.egm_messages import (
    EgmMeasurement,
    MciState,
    MotorState,
    RapidState,
    decode_set_point,
    encode_measurement,
    encode_set_point,
)
from robots.drivers.abb.egm.egm_socket import EgmSocket
from robots.drivers.abb.gripper_switch import GripperSwitch
from robots.drivers.abb.motion_link import MotionLink
from robots.drivers.abb.rws.rws_client import RwsClient
from robots.drivers.abb.rws.rws_options import RwsOptions
from robots.drivers.abb.rws.rws_transport import RwsCommand, RwsTransport
from robots.drivers.abb.simple_message import JOINTS, TrajectoryPoint
from robots.drivers.abb.state_transport import StateTransport
from robots.drivers.robotiq.gripper_registers import ACTIVATE, GripperCommand
from robots.drivers.robotiq.modbus_transport import ModbusTransport
from robots.drivers.robotiq.robotiq_options import ModbusTcp, RtuOverTcp, SerialLine, UrcapSocket
from robots.drivers.robotiq.urcap_transport import UrcapTransport
from robots.drivers.servo_arm.servo_arm_controller import ServoArmController
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions
from robots.drivers.softhand.hand_reading import HandActivation, HandReference
from robots.drivers.softhand.hand_transport import HandTransport
from robots.drivers.universal_robots.ur_dashboard import ask_dashboard
from robots.drivers.universal_robots.ur_joint_controller import UrJointController
from robots.drivers.universal_robots.ur_options import UrOptions
from robots.io.wire.datagram_ports import DatagramPorts
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.packet_headers import PacketEncoder
from robots.io.wire.pcapng_blocks import CaptureInterface, CaptureSection, encode_block
from robots.io.wire.read_capture import CapturedEvent, read_capture
from robots.io.wire.tcp_connection import endpoints_of
from robots.io.wire.wire_capture import WireCapture
from robots.io.wire.wire_tap import NO_TAP, WireEndpoints, WireEvent, WireTap
from robots.reconcell import ControlMode, ReconcellClient
from robots.reconcell.packet_codec import encode_packet
from robots.reconcell.packet_table import command_ports
from robots.reconcell.packets import RobotFlags
from tests.robots.drivers.abb.emulated_irc5 import emulated as emulated_irc5
from tests.robots.drivers.emulated_gripper import emulated as emulated_gripper
from tests.robots.drivers.emulated_hand import emulated_hand
from tests.robots.drivers.servo_arm.emulated_arm import emulated_servo_arm, enabled, read
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController
from tests.robots.own_address import own_address

FOLDER = Path(__file__).parent / "captures"
_EPOCH_NS = 1_790_000_000_000_000_000
_OWN, _DEVICE = "192.0.2.10", "192.0.2.20"
_CLOSE = GripperCommand(activate=True, go=True, position=255, speed=255, force=255)
_RECEIVE = """
import sys, rtde_receive
receive = rtde_receive.RTDEReceiveInterface(sys.argv[1], 125.0, ["timestamp", "actual_q", "robot_mode"])
receive.getActualQ()
receive.disconnect()
"""


def robotiq(connection: str, tap: WireTap) -> None:
    """Read, activate, close."""
    with emulated_gripper(connection, active=False) as emulator:
        place = emulator.place
        if connection == "urcap":
            urcap = UrcapTransport(UrcapSocket(host=place["host"], port=place["port"]), timeout_s=2.0, tap=tap)
            _exchange(urcap)
            return
        ways: dict[str, Callable[[], SerialLine | RtuOverTcp | ModbusTcp]] = {
            "serial": lambda: SerialLine(device=place["device"]),
            "rtu_over_tcp": lambda: RtuOverTcp(host=place["host"], port=place["port"]),
            "modbus_tcp": lambda: ModbusTcp(host=place["host"], port=place["port"]),
        }
        _exchange(ModbusTransport(ways[connection](), unit=9, timeout_s=2.0, tap=tap))


def _exchange(transport: ModbusTransport | UrcapTransport) -> None:
    transport.open()
    transport.read()
    transport.write(ACTIVATE)
    transport.write(_CLOSE)
    transport.close()


def softhand(tap: WireTap) -> None:
    """Switch the motor on, send a reference, read."""
    with emulated_hand("serial", active=False) as emulator:
        hand = HandTransport(emulator.serial_device, baud=2_000_000, unit=1, timeout_s=2.0, tap=tap)
        hand.open()
        hand.write(HandActivation(on=True))
        hand.write(HandReference(ticks=0))
        hand.read()
        hand.close()


def servo_lines(tap: WireTap) -> None:
    """Wait for the board, enable, send a set point, stop."""
    with emulated_servo_arm("tcp") as emulator:
        options = ServoArmOptions(device=emulator.serial_device, boot_s=5.0, stale_s=5.0)
        arm = ServoArmController(options, tap=tap)
        arm.connect()
        enabled(arm)
        start = read(arm).position_rad
        arm.command(start + np.radians(1.0), np.zeros(2))
        arm.close()


def simple_message_state(tap: WireTap) -> None:
    """Receive a measurement and a status."""
    with emulated_irc5() as emulator:
        place = emulator.place
        state = StateTransport(place["host"], place["state_port"], byte_order="little", timeout_s=5.0, tap=tap)
        state.open()
        state.read()
        state.close()


class _Nobody:
    def motion_link_lost(self, reason: str) -> None:
        """Nothing is lost."""

    def stopped_by_silence(self, silent_s: float) -> None:
        """Nothing is armed."""


def simple_message_motion(tap: WireTap) -> None:
    """Connect, which requests a stop, and download three points."""

    async def download(host: str, port: int) -> None:
        link = MotionLink(host, port, _Nobody(), byte_order="little", timeout_s=5.0, silence_s=5.0, tap=tap)
        await link.connect()
        joints = (0.0, 0.0, 0.0, 0.0, 0.5, 0.0)
        points = [
            TrajectoryPoint(
                sequence=sequence,
                joints_rad=(joints[0] + turned, *joints[1:], *(0.0,) * (JOINTS - 6)),
                duration_s=duration_s,
            )
            for sequence, turned, duration_s in ((-1, 0.0, 0.5), (1, 0.125, 1.0), (-3, 0.25, 1.0))
        ]
        await link.download(points)
        await link.close()

    with emulated_irc5() as emulator:
        asyncio.run(download(emulator.place["host"], emulator.place["motion_port"]))


def gripper_text(tap: WireTap) -> None:
    """Switch on, confirmed by a reply."""

    async def switch(host: str, port: int) -> None:
        gripper = GripperSwitch(host, GripperStrings(port=port, reply="done", reply_s=5.0), timeout_s=5.0, tap=tap)
        gripper.connect()
        gripper.set(0, on=True)
        await gripper.confirmed()
        gripper.close("the end")

    with emulated_irc5(gripper_reply="done") as emulator:
        asyncio.run(switch(emulator.place["host"], emulator.place["gripper_port"]))


def rws(tap: WireTap) -> None:
    """Read the state, which asks for a password, and switch the motors on."""
    with emulated_irc5() as emulator:
        place = emulator.place

        def new_client() -> RwsClient:
            user, password = "Default User", RwsOptions().secret("an example")
            return RwsClient(place["host"], place["rws_port"], user=user, password=password, timeout_s=5.0, tap=tap)

        transport = RwsTransport("an example", new_client)
        transport.open()
        transport.read()
        transport.write(RwsCommand.MOTORS_ON)
        transport.close()


def egm(tap: WireTap) -> None:
    """Receive a measurement, and answer with a set point."""
    own = own_address()
    socket_here = EgmSocket(own, address=own, port=6510, tap=tap)
    socket_here.open()
    controller = DatagramSocket(NO_TAP)
    controller.bind((own, 0))
    measurement = EgmMeasurement(
        number=7,
        time_ms=1000,
        measured_deg=(0.0, 0.5, -0.5, 0.0, 30.0, 0.0),
        planned_deg=(0.0, 0.5, -0.5, 0.0, 30.0, 0.0),
        motors=MotorState.ON,
        mci=MciState.RUNNING,
        rapid=RapidState.RUNNING,
    )
    controller.send(encode_measurement(measurement), (own, 6510))
    socket_here.receive(5.0)
    socket_here.send((0.25, 0.5, -0.5, 0.0, 30.0, 0.0))
    controller.close()
    socket_here.close()


def _without_session(data: bytes) -> bytes:
    """Replace address and nonce in HTTP."""
    data = re.sub(rb"Host: [\d.:]+", b"Host: 192.0.2.20", data)
    return re.sub(rb'nonce="\w+"', b'nonce="' + b"0" * 32 + b'"', data)


def _without_time(packet: bytes) -> bytes:
    """Replace the time in a set point; a measurement has an example's already."""
    try:
        return encode_set_point(dataclasses.replace(decode_set_point(packet), time_ms=2000))
    except AbbLinkError:
        return packet


def ur_dashboard(tap: WireTap) -> None:
    """Ask for the safety status."""
    with EmulatedController(series="cb3") as controller:
        ask_dashboard(controller.host, "safetystatus", limit_s=5.0, tap=tap)


def ur_secondary(capture: WireCapture) -> None:
    """Set an output by a program."""
    with EmulatedController(series="cb3") as controller:
        UrJointController(UrOptions(host=controller.host), capture).set_output(3, on=True)


def rtde(tap: WireTap) -> None:
    """What the client library asks and is answered, seen from between the two."""
    address = own_address()
    with EmulatedController(series="cb3") as controller, socket.create_server((address, 30004)) as server:
        client = subprocess.Popen([sys.executable, "-c", _RECEIVE, address])
        near, _ = server.accept()
        far = socket.create_connection((controller.host, 30004))
        tap.opened(endpoints_of(far))

        def forward(source: socket.socket, target: socket.socket, note: Callable[[bytes], None]) -> None:
            with suppress(OSError):  # the client has disconnected
                while data := source.recv(4096):
                    note(data)
                    target.sendall(data)

        back = threading.Thread(target=forward, args=(far, near, tap.received), daemon=True)
        back.start()
        forward(near, far, tap.sent)
        tap.closed()
        client.wait(20.0)


def reconcell(capture: WireCapture) -> None:
    """Start a trapezoidal motion, and receive flags."""
    server, own = own_address(), own_address()
    ports = DatagramPorts(server, command_ports())
    with ReconcellClient(server, own=own, capture=capture) as client:
        client.send_set_point((0.0,) * 6)
        client.move_joints((0.5, -0.5, 0.5, -0.5, 0.5, -0.5), speed=0.25)
        flags = RobotFlags(received_mode=12, sent_mode=12, idle=0, error=0, running=1, received=1, finished=0)
        sender = DatagramSocket(NO_TAP)
        sender.send(encode_packet(flags, 15001, direction="state"), (own, 15001))
        client.receive(5.0)
        client.select(ControlMode.STOP)
        sender.close()
    ports.close()


_Session = Callable[[WireCapture], object]
SESSIONS: dict[str, tuple[int, int, _Session]] = {
    "modbus_rtu": (0, 99, lambda capture: robotiq("serial", capture.tap("modbus_rtu"))),
    "rtu_over_tcp": (54321, 99, lambda capture: robotiq("rtu_over_tcp", capture.tap("rtu_over_tcp"))),
    "modbus_tcp": (502, 99, lambda capture: robotiq("modbus_tcp", capture.tap("modbus_tcp"))),
    "urcap": (63352, 99, lambda capture: robotiq("urcap", capture.tap("urcap"))),
    "softhand": (0, 99, lambda capture: softhand(capture.tap("softhand"))),
    "servo_lines": (23, 99, lambda capture: servo_lines(capture.tap("servo_lines"))),
    "simple_message_state": (11002, 99, lambda capture: simple_message_state(capture.tap("simple_message_state"))),
    "simple_message_motion": (11000, 99, lambda capture: simple_message_motion(capture.tap("simple_message_motion"))),
    "gripper_text": (11004, 99, lambda capture: gripper_text(capture.tap("gripper_text"))),
    "rws": (80, 99, lambda capture: rws(capture.tap("rws"))),
    "egm": (0, 99, lambda capture: egm(capture.tap("egm"))),
    "ur_dashboard": (29999, 99, lambda capture: ur_dashboard(capture.tap("ur_dashboard"))),
    "ur_secondary": (30002, 99, ur_secondary),
    "rtde": (30004, 12, lambda capture: rtde(capture.tap("rtde"))),
    "reconcell": (0, 99, reconcell),
}
"""By protocol: the usual port of the device, the most events kept, and what is done."""
_REPLACED: dict[str, Callable[[bytes], bytes]] = {"rws": _without_session, "egm": _without_time}
"""By protocol, what differs from session to session inside of the bytes, and is that of an example."""


def write(protocol: str) -> None:
    """Write one capture."""
    port, most, session = SESSIONS[protocol]
    with TemporaryDirectory() as folder:
        capture = WireCapture(Path(folder), device="example")
        session(capture)
        capture.close()
        (file,) = Path(folder).glob(f"example.{protocol}.*")
        captured = read_capture(file)
    encoder = PacketEncoder(captured.transport)
    blocks = [
        encode_block(CaptureSection(comment="an example: addresses and times were replaced", application="flexcell")),
        encode_block(CaptureInterface(link_type=encoder.link_type, device="example", protocol=protocol)),
    ]
    for number, event in enumerate(captured.events[:most]):
        time_ns = _EPOCH_NS + number * 10_000_000
        data = _REPLACED.get(protocol, bytes)(event.data)
        noted = WireEvent(time_ns=time_ns, kind=event.kind, data=data, endpoints=_example(event, port))
        blocks += [encode_block(packet) for packet in encoder.packets(noted, time_ns=time_ns)]
    (FOLDER / f"{protocol}.pcapng").write_bytes(b"".join(blocks))


def _example(event: CapturedEvent, port: int) -> WireEndpoints | None:
    if event.endpoints is None:
        return None
    if port:
        return WireEndpoints(local=(_OWN, 50000), remote=(_DEVICE, port))
    # The ports of datagrams say what they are; that of a sender is any.
    ports = [each if each < 30000 else 50000 for each in (event.endpoints.local[1], event.endpoints.remote[1])]
    return WireEndpoints(local=(_OWN, ports[0]), remote=(_DEVICE, ports[1]))


if __name__ == "__main__":
    for name in sys.argv[1:] or SESSIONS:
        start_s = time.monotonic()
        write(name)
        sys.stdout.write(f"{name}: {time.monotonic() - start_s:.1f} s\n")
