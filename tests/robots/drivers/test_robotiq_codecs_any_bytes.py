"""Any bytes in either direction: no crash, no motion, an error by name."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from robots.drivers.emulation.byte_stream import ProtocolSession
from robots.drivers.emulation.wire_faults import WireFaults
from robots.drivers.robotiq.emulation.emulated_gripper import EmulatedGripper
from robots.drivers.robotiq.emulation.gripper_sessions import RegisterBank, RtuSession, TcpSession, UrcapSession
from robots.drivers.robotiq.emulation.kinematic_fingers import KinematicFingers
from robots.drivers.robotiq.emulation.modbus_frames import with_crc, with_mbap
from robots.drivers.robotiq.gripper_registers import (
    GripperCommand,
    decode_command,
    decode_status,
    encode_command,
    encode_status,
)
from robots.drivers.robotiq.urcap_codec import STATUS_NAMES, decode_reply, status_of
from robots.io.wire.link_error import LinkError
from tests.tiers import examples

MANY = settings(max_examples=examples(200, nightly=25_000))
"""Nightly more than 10⁵ frames in each direction: four tests read replies, four feed several requests an example."""
BYTE = st.integers(0, 255)
WORD = st.integers(0, 0xFFFF)
CHUNKS = st.lists(st.binary(max_size=40), max_size=8)
COMMANDS = st.builds(
    GripperCommand,
    activate=st.booleans(),
    go=st.booleans(),
    release=st.booleans(),
    position=BYTE,
    speed=BYTE,
    force=BYTE,
)


class FrozenTime:
    """A gripper of its own, which has all the time to move that it wants."""

    def __init__(self, *, at_zero: bool) -> None:
        self.now_s = 0.0
        self.fingers = KinematicFingers(lambda: self.now_s)
        self.gripper = EmulatedGripper(lambda: self.now_s, self.fingers, activation_s=1.0)
        self.bank = RegisterBank(self.gripper, unit=9, at_zero=at_zero, faults=WireFaults())

    def travel_after(self, session: ProtocolSession, chunks: list[bytes]) -> float:
        """Feed bytes, let a minute pass, and return how far the fingers went."""
        for chunk in chunks:
            session.feed(chunk)
            self.now_s += 60.0
        self.gripper.advance()
        return self.fingers.travel


@MANY
@given(CHUNKS)
def test_no_bytes_move_a_gripper_over_rtu(chunks: list[bytes]) -> None:
    device = FrozenTime(at_zero=False)
    assert device.travel_after(RtuSession(device.bank), chunks) == 0.0


@MANY
@given(st.lists(st.binary(min_size=2, max_size=30), max_size=6))
def test_no_frame_with_a_checksum_but_of_another_meaning_moves_a_gripper(bodies: list[bytes]) -> None:
    """Whatever is read or written, only a command that activates moves the fingers, and then it is one."""
    device = FrozenTime(at_zero=False)
    travel = device.travel_after(RtuSession(device.bank), [with_crc(body) for body in bodies])
    assert travel == 0.0 or device.gripper.commands > 0


@MANY
@given(CHUNKS)
def test_no_bytes_crash_the_server_of_modbus_tcp(chunks: list[bytes]) -> None:
    device = FrozenTime(at_zero=True)
    travel = device.travel_after(TcpSession(device.bank), [with_mbap(1, chunk) for chunk in chunks] + chunks)
    assert travel == 0.0 or device.gripper.commands > 0


@MANY
@given(CHUNKS)
def test_no_bytes_crash_the_text_server(chunks: list[bytes]) -> None:
    device = FrozenTime(at_zero=False)
    travel = device.travel_after(UrcapSession(device.bank), chunks)
    assert travel == 0.0 or device.gripper.commands > 0


@MANY
@given(st.lists(WORD, max_size=5))
def test_registers_are_a_status_or_an_error_by_name(words: list[int]) -> None:
    try:
        status = decode_status(words)
    except LinkError:
        return
    again = decode_status(encode_status(status))
    assert again == status
    assert isinstance(status.fault_name, str)


@MANY
@given(st.lists(st.integers(-10, 70_000), max_size=4))
def test_numbers_that_are_no_registers_are_an_error_by_name(words: list[int]) -> None:
    if len(words) != 3 or not all(0 <= word <= 0xFFFF for word in words):
        try:
            decode_status(words)
        except LinkError:
            return
        raise AssertionError("these are not three registers")


@MANY
@given(COMMANDS)
def test_a_command_survives_its_registers(command: GripperCommand) -> None:
    assert decode_command(encode_command(command)) == command


@MANY
@given(st.sampled_from(STATUS_NAMES), st.binary(max_size=40))
def test_a_text_is_the_value_of_its_variable_or_an_error_by_name(name: str, line: bytes) -> None:
    try:
        value = decode_reply(name, line)
    except LinkError:
        return
    assert 0 <= value <= 255
    assert line.split()[0] == name.encode()


@MANY
@given(st.fixed_dictionaries(dict.fromkeys(STATUS_NAMES, BYTE)))
def test_values_of_the_text_server_are_a_status_or_an_error_by_name(values: dict[str, int]) -> None:
    try:
        status = status_of(values)
    except LinkError:
        return
    assert status.position == values["POS"]
