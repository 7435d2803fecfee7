"""What drivers are up against, fed with bytes: the emulators and servers of each protocol, without sockets or time."""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable
from typing import Any, cast

import numpy as np

from benchmarks.fuzz_target import FuzzTarget
from robots.drivers.abb.emulation.controller_sessions import (
    EmulatedGripperSwitch,
    GripperSession,
    MotionSession,
    SessionClosed,
)
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.simple_message import JOINTS, SimpleMessageCodec, TrajectoryPoint
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.robotiq.emulation.emulated_gripper import EmulatedGripper
from robots.drivers.robotiq.emulation.gripper_sessions import RegisterBank, RtuSession, TcpSession, UrcapSession
from robots.drivers.robotiq.emulation.kinematic_fingers import KinematicFingers
from robots.drivers.robotiq.emulation.modbus_frames import with_crc, with_mbap
from robots.drivers.servo_arm.emulation.board_session import BoardPower, BoardSession
from robots.drivers.servo_arm.emulation.emulated_board import EmulatedBoard
from robots.drivers.softhand.emulation.emulated_hand import EmulatedHand
from robots.drivers.softhand.emulation.hand_session import HandSession, HandWire
from robots.drivers.softhand.emulation.kinematic_tendon import KinematicTendon
from robots.drivers.softhand.hand_frames import HandCommandCode, HandFrame, encode_frame, encode_words
from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.dashboard import DashboardCommands
from robots.drivers.universal_robots.emulator.emulated_arm import EmulatedArm
from robots.drivers.universal_robots.emulator.link_faults import LinkFaults
from robots.drivers.universal_robots.emulator.rtde_server import RtdeServer, RtdeSession
from robots.drivers.universal_robots.emulator.ur_models import ARMS, SERIES
from robots.drivers.universal_robots.emulator.urscript.urscript_parser import parse_program
from robots.drivers.universal_robots.emulator.urscript.urscript_syntax import UrscriptError
from robots.drivers.universal_robots.emulator.urscript.urscript_tokens import ProgramSplitter
from robots.drivers.universal_robots.rtde_codec import RtdePacket, RtdePacketType, split_packets

_PERIOD_S = 0.1
_SCRIPTS = (
    b"def move():\n  global q = [0.0, -1.57, 1.57, -1.57, -1.57, 0.0]\n  movej(q, a=1.4, v=1.05)\nend\n",
    b"sec out():\n  set_digital_out(3, True)\nend\n",
    b"""def loop():
  i = 0
  while i < 10 and not (i == 5):
    if i > 3:
      servoj(get_inverse_kin(p[0.1, 0.2, 0.3, 0, 3.14, 0]), t=0.008)
    elif i == 2:
      sleep(0.1)
    else:
      sync()
    end
    i = i + 1
  end
end
""",
    b"""def threads():
  thread work():
    while True:
      enter_critical
      x = read_input_integer_register(0)
      exit_critical
      sync()
    end
  end
  handle = run work()
  kill handle
end
""",
)


class DeviceClock:
    """The time of an emulator, which passes between two packets."""

    def __init__(self) -> None:
        self.now_s = 0.0

    def __call__(self) -> float:
        """Return the time."""
        return self.now_s


def _modbus_requests(*, at_zero: bool) -> tuple[bytes, ...]:
    command, status, function = (0, 0, 4) if at_zero else (0x3E8, 0x7D0, 3)
    return (
        struct.pack(">BBHH", 9, function, status, 3),
        struct.pack(">BBHH", 9, 3, command, 3),
        struct.pack(">BBHHB6s", 9, 16, command, 3, 6, bytes.fromhex("0800 00FF FFFF")),
        struct.pack(">BBHHHHB6s", 9, 23, status, 3, command, 3, 6, bytes(6)),
    )


def _modbus_outcome(reply: bytes, function_at: int) -> str:
    if len(reply) <= function_at:
        return "ignored"
    return f"exception {reply[function_at + 1]}" if reply[function_at] & 0x80 else ""


def robotiq(protocol: str) -> FuzzTarget:
    """An activated gripper is a moving one: this one is not, and only a command can activate it."""
    clock = DeviceClock()
    fingers = KinematicFingers(clock)
    gripper = EmulatedGripper(clock, fingers, activation_s=1.0)
    bank = RegisterBank(gripper, unit=9, at_zero=protocol == "modbus_tcp", faults=WireFaults())
    sessions: dict[str, Callable[[RegisterBank], RtuSession | TcpSession | UrcapSession]] = {
        "modbus_tcp": TcpSession,
        "modbus_rtu": RtuSession,
        "urcap": UrcapSession,
    }
    session = sessions[protocol](bank)

    def feed(packet: bytes) -> str:
        clock.now_s += _PERIOD_S
        reply = session.feed(packet)
        if protocol == "urcap":
            return "?" if b"?" in reply else "" if reply else "ignored"
        return _modbus_outcome(reply, 7 if protocol == "modbus_tcp" else 1)

    def has_moved() -> bool:
        gripper.advance()
        return fingers.travel > 0.0 and gripper.commands == 0

    requests = _modbus_requests(at_zero=protocol == "modbus_tcp")
    valid = {
        "modbus_tcp": tuple(with_mbap(7, each) for each in requests),
        "modbus_rtu": tuple(with_crc(each) for each in requests),
        "urcap": (b"GET POS\n", b"GET STA\n", b"SET ACT 0 GTO 1 POS 255\n", b"SET SPE 255 FOR 0\n"),
    }
    return FuzzTarget(protocol, "to the device", valid[protocol], feed, has_moved)


def softhand() -> FuzzTarget:
    """A hand whose motor is off."""
    clock = DeviceClock()
    tendon = KinematicTendon(clock)
    hand = EmulatedHand(clock, tendon, active=False)
    session = HandSession(HandWire(hand, unit=1))
    activated = [False]
    codes = (HandCommandCode.GET_ACTIVATE, HandCommandCode.GET_INPUTS, HandCommandCode.GET_CURRENTS_AND_MEASUREMENTS)
    frames = [HandFrame(unit=1, command=code) for code in codes]
    frames.append(HandFrame(unit=1, command=HandCommandCode.SET_INPUTS, data=encode_words(9000, 0)))

    def feed(packet: bytes) -> str:
        clock.now_s += _PERIOD_S
        reply = session.feed(packet)
        activated[0] |= hand.active
        return "" if reply else "ignored"

    def has_moved() -> bool:
        tendon.measured()
        return tendon.travel > 0.0 and not activated[0]

    return FuzzTarget("softhand", "to the device", tuple(map(encode_frame, frames)), feed, has_moved)


def servo_lines() -> FuzzTarget:
    """A board that has started and was not enabled."""
    clock = DeviceClock()
    board = EmulatedBoard(clock, home_deg=(90.0, 90.0), max_deg_s=60.0, watchdog_s=0.5)
    session = BoardSession(board, BoardPower(), answers=True)
    enabled = [False]

    def feed(packet: bytes) -> str:
        clock.now_s += _PERIOD_S
        reply = session.feed(packet)
        enabled[0] |= b"OK" in reply
        return "ERR" if b"ERR" in reply else "" if reply else "ignored"

    def has_moved() -> bool:
        board.advance()
        return board.travel > 0.0 and not enabled[0]

    valid = (b"45.0 120.0\n", b"?\n", b"STOP\n", b"pick\n", b"place\n")
    return FuzzTarget("servo_lines", "to the device", valid, feed, has_moved)


def simple_message() -> FuzzTarget:
    """A controller whose trajectories are never ended, so that none begins."""
    clock = DeviceClock()
    controller = EmulatedController(clock, axes=np.zeros(6), stop_s=0.2)
    codec = SimpleMessageCodec()
    sessions = [MotionSession(controller, WireFaults(), byte_order="little")]
    joints = (0.1,) * JOINTS
    points = [TrajectoryPoint(sequence=number, joints_rad=joints, duration_s=1.0) for number in (-1, 1, 2, -4)]

    def feed(packet: bytes) -> str:
        clock.now_s += _PERIOD_S
        try:
            return "" if sessions[0].feed(packet) else "ignored"
        except SessionClosed as closed:
            sessions[0] = MotionSession(controller, WireFaults(), byte_order="little")
            return str(closed).partition(":")[0].partition(" of type")[0]

    def has_moved() -> bool:
        controller.advance()
        return controller.travel_rad > 0.0 and controller.started == 0

    valid = tuple(codec.encode_point(point) for point in points)
    return FuzzTarget("simple_message", "to the device", valid, feed, has_moved)


def gripper_text() -> FuzzTarget:
    """The gripper program of an IRC5."""
    gripper = EmulatedGripperSwitch("ok")
    session = GripperSession(gripper)
    texts = [0]

    def feed(packet: bytes) -> str:
        texts[0] += packet[:80].decode("ascii", "replace").strip() in ("gripperON", "gripperOFF")
        return "" if session.feed(packet) else "ignored"

    valid = (b"gripperON", b"gripperOFF")
    return FuzzTarget("gripper_text", "to the device", valid, feed, lambda: gripper.switched > texts[0])


def _ur_controller() -> ControllerState:
    return ControllerState(EmulatedArm(ARMS["ur10"], cycle_s=0.008))


def rtde() -> FuzzTarget:
    """The RTDE port of a controller without a program."""
    controller = _ur_controller()
    server = RtdeServer(controller, SERIES["cb3"], LinkFaults())
    wires = [_connected(server)]
    outputs = struct.pack(">d", 125.0) + b"timestamp,actual_q,robot_mode,safety_status_bits,"
    packets = [0]
    valid = (
        RtdePacket(RtdePacketType.PROTOCOL_VERSION, b"\x00\x02"),
        RtdePacket(RtdePacketType.CONTROLLER_VERSION),
        RtdePacket(RtdePacketType.SETUP_OUTPUTS, outputs),
        RtdePacket(RtdePacketType.SETUP_INPUTS, b"input_int_register_0,input_double_register_0,"),
        RtdePacket(RtdePacketType.START),
        RtdePacket(RtdePacketType.PAUSE),
        RtdePacket(RtdePacketType.DATA, struct.pack(">Bid", 1, 7, 0.5)),
    )
    start = np.array(controller.arm.q)

    def feed(packet: bytes) -> str:
        session, wire = wires[0]
        controller.run_cycle()
        packets[0] += 1
        wire.sent.clear()
        session.data_received(packet)
        session.send_data(0)
        refused = any(each.kind == RtdePacketType.TEXT_MESSAGE for each in split_packets(bytearray(wire.sent)))
        controller.messages.clear()
        # A packet may announce 65,535 bytes, which swallow all that follows.
        if wire.is_closed or packets[0] % 3 == 0:
            session.connection_lost(None)
            wires[0] = _connected(server)
        return "message" if refused else "" if wire.sent else "ignored"

    def has_moved() -> bool:
        return bool((np.array(controller.arm.q) != start).any())

    return FuzzTarget("rtde", "to the device", tuple(each.encode() for each in valid), feed, has_moved)


def dashboard() -> FuzzTarget:
    """Lines of the dashboard; without a program nothing can move."""
    controller = _ur_controller()
    commands = DashboardCommands(controller, SERIES["cb3"], model="ur10")
    start = np.array(controller.arm.q)
    lines = (b"PolyscopeVersion", b"safetystatus", b"stop", b"play", b"unlock protective stop", b"power off", b"load a")

    def feed(packet: bytes) -> str:
        controller.run_cycle()
        answer = commands.answer(packet.decode("utf-8", "replace").strip())
        return "not understood" if "could not understand" in answer.lower() else ""

    def has_moved() -> bool:
        return bool((np.array(controller.arm.q) != start).any())

    return FuzzTarget("ur_dashboard", "to the device", lines, feed, has_moved)


def urscript() -> FuzzTarget:
    """Programs as the script ports take them: cut into programs and parsed, not executed."""

    def feed(packet: bytes) -> str:
        try:
            programs = ProgramSplitter().feed(packet.decode("utf-8", "replace"))
            for program in programs:
                parse_program(program)
        except UrscriptError:
            return "UrscriptError"
        return "" if programs else "ignored"

    return FuzzTarget("urscript", "to the device", _SCRIPTS, feed, lambda: False)


class _SentBytes(asyncio.Transport):
    """Keeps what is written."""

    def __init__(self) -> None:
        super().__init__()
        self.sent = bytearray()
        self.is_closed = False

    def write(self, data: Any) -> None:
        self.sent += cast("bytes", data)

    def is_closing(self) -> bool:
        return self.is_closed

    def close(self) -> None:
        self.is_closed = True

    def abort(self) -> None:
        self.is_closed = True

    def get_write_buffer_size(self) -> int:
        return 0


def _connected(server: RtdeServer) -> tuple[RtdeSession, _SentBytes]:
    session, wire = server.new_session(), _SentBytes()
    session.connection_made(wire)
    return session, wire


DEVICES: tuple[Callable[[], FuzzTarget], ...] = (
    lambda: robotiq("modbus_rtu"),
    lambda: robotiq("modbus_tcp"),
    lambda: robotiq("urcap"),
    softhand,
    servo_lines,
    simple_message,
    gripper_text,
    rtde,
    dashboard,
    urscript,
)
