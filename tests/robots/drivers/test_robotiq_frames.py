"""What pymodbus sends for us, and what our emulator answers, are the frames that the manual prints."""

from __future__ import annotations

from pathlib import Path

import pytest

from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.robotiq.emulation.emulated_gripper import EmulatedGripper
from robots.drivers.robotiq.emulation.gripper_sessions import RegisterBank, RtuSession, TcpSession
from robots.drivers.robotiq.emulation.kinematic_fingers import KinematicFingers
from robots.drivers.robotiq.emulation.modbus_frames import crc16, with_crc, with_mbap
from robots.drivers.robotiq.gripper_registers import (
    ACTIVATE,
    RESET,
    GripperCommand,
    decode_command,
    decode_status,
    encode_command,
)
from robots.drivers.robotiq.modbus_transport import ModbusTransport
from robots.drivers.robotiq.robotiq_options import RtuOverTcp
from robots.drivers.robotiq.urcap_codec import decode_reply, encode_get, encode_set
from robots.io.wire.wire_tap import WireTap
from tests.robots.drivers.emulated_gripper import emulated

LINES = (Path(__file__).parent / "robotiq_frames.txt").read_text(encoding="utf-8").splitlines()
FRAMES = [
    (name, direction, bytes.fromhex(text))
    for name, direction, text in (line.split(" ", 2) for line in LINES if not line.startswith("#"))
]
COMMANDS = {
    "reset": RESET,
    "activate": ACTIVATE,
    "close": GripperCommand(activate=True, go=True, position=255, speed=255, force=255),
    "open": GripperCommand(activate=True, go=True, position=0, speed=255, force=255),
}


def bank() -> RegisterBank:
    gripper = EmulatedGripper(lambda: 0.0, KinematicFingers(lambda: 0.0), activation_s=1.0)
    return RegisterBank(gripper, unit=9, at_zero=False, faults=WireFaults())


@pytest.mark.parametrize(("name", "direction", "frame"), FRAMES)
def test_a_frame_ends_with_its_checksum(name: str, direction: str, frame: bytes) -> None:
    assert frame == with_crc(frame[:-2])


@pytest.mark.parametrize(("name", "direction", "frame"), FRAMES)
def test_the_words_of_a_command_are_those_of_the_manual(name: str, direction: str, frame: bytes) -> None:
    if direction == ">" and name in COMMANDS:
        words = [int.from_bytes(frame[place : place + 2]) for place in (7, 9, 11)]
        assert encode_command(COMMANDS[name]) == words
        assert decode_command(words) == COMMANDS[name]


def test_the_emulator_answers_each_frame_as_a_gripper_does() -> None:
    session = RtuSession(bank())
    for name, _, frame in (each for each in FRAMES if each[1] == ">"):
        answers = [answer for other, direction, answer in FRAMES if (other, direction) == (name, "<")]
        reply = session.feed(frame)
        if answers:
            assert [reply] == answers
        else:
            assert (reply[:3], len(reply)) == (bytes.fromhex("09 03 06"), 11)
            decode_status([int.from_bytes(reply[place : place + 2]) for place in (3, 5, 7)])


def test_pymodbus_sends_those_frames_over_a_socket_and_takes_the_answers() -> None:
    sent: list[bytes] = []
    received: list[bytes] = []
    other: list[bytes] = []
    with emulated("rtu_over_tcp") as emulator:
        connection = RtuOverTcp(host=emulator.place["host"], port=emulator.place["port"])
        tap = WireTap(lambda event: {"sent": sent, "received": received}.get(event.kind, other).append(event.data))
        transport = ModbusTransport(connection, unit=9, timeout_s=2.0, tap=tap)
        transport.open()
        for name in ("reset", "activate", "read", "close", "open"):
            if name == "read":
                transport.read()
            else:
                transport.write(COMMANDS[name])
        transport.close()
    assert sent == [frame for _, direction, frame in FRAMES if direction == ">"]
    assert [each for each in received if each[1] == 0x10] == [frame for _, way, frame in FRAMES if way == "<"]


@pytest.mark.parametrize("pieces", [1, 2, 3, 7])
def test_a_frame_may_arrive_in_pieces(pieces: int) -> None:
    frame = next(frame for name, direction, frame in FRAMES if (name, direction) == ("close", ">"))
    session = RtuSession(bank())
    chunks = [frame[start : start + pieces] for start in range(0, len(frame), pieces)]
    assert b"".join(session.feed(chunk) for chunk in chunks) == bytes.fromhex("09 10 03 E8 00 03 01 30")


def test_a_pause_ends_a_frame_of_which_a_part_was_lost() -> None:
    """The part that arrived announces a long frame, which would swallow the requests after it."""
    now_s = 0.0
    gripper = EmulatedGripper(lambda: now_s, KinematicFingers(lambda: now_s), activation_s=1.0)
    session = RtuSession(RegisterBank(gripper, unit=9, at_zero=False, faults=WireFaults()))
    assert session.feed(bytes.fromhex("09 10 03 E8 00 03 FF")) == b""
    now_s = 0.2
    assert session.feed(bytes.fromhex("09 10 03 E8 00 03 06 00 00 00 00 00 00 73 30")) != b""


def test_another_unit_a_wrong_checksum_and_a_wrong_address_are_not_obeyed() -> None:
    owner = bank()
    session = RtuSession(owner)
    close = bytes.fromhex("09 10 03 E8 00 03 06 09 00 00 FF FF FF")
    assert session.feed(with_crc(b"\x08" + close[1:])) == b""
    assert session.feed(close + bytes([crc16(close) & 0xFF ^ 1, crc16(close) >> 8])) == b""
    assert session.feed(with_crc(bytes.fromhex("09 03 00 00 00 03"))) == with_crc(bytes.fromhex("09 83 02"))
    assert session.feed(with_crc(bytes.fromhex("09 07 00 00 00 03"))) == with_crc(bytes.fromhex("09 87 01"))
    assert owner.gripper.commands == 0


def test_modbus_tcp_has_its_registers_at_zero_and_returns_the_transaction() -> None:
    gripper = EmulatedGripper(lambda: 0.0, KinematicFingers(lambda: 0.0), activation_s=1.0)
    session = TcpSession(RegisterBank(gripper, unit=9, at_zero=True, faults=WireFaults()))
    reply = session.feed(with_mbap(0x1234, bytes.fromhex("09 10 00 00 00 03 06 01 00 00 00 00 00")))
    assert reply == bytes.fromhex("12 34 00 00 00 06 09 10 00 00 00 03")
    assert session.feed(with_mbap(7, bytes.fromhex("09 04 00 00 00 03")))[:9] == bytes.fromhex(
        "00 07 00 00 00 09 09 04 06"
    )


def test_the_lines_of_the_urcap_are_those_of_its_server() -> None:
    assert encode_get("POS") == b"GET POS\n"
    assert encode_set(COMMANDS["close"]) == b"SET ACT 1 GTO 1 ATR 0 SPE 255 FOR 255 POS 255\n"
    assert decode_reply("POS", b"POS 3\n") == 3
