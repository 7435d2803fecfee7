"""Any bytes in either direction: no crash, no motion, an error by name."""

from __future__ import annotations

import socket
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.drivers.abb.emulation.controller_sessions import (
    EmulatedGripperSwitch,
    GripperSession,
    MotionSession,
    SessionClosed,
)
from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.simple_message import (
    ByteOrder,
    Frame,
    JointPosition,
    OperatingMode,
    RobotStatus,
    SimpleMessageCodec,
    TrajectoryPoint,
    Tristate,
)
from robots.drivers.abb.state_transport import StateTransport
from robots.drivers.emulation.wire_faults import WireFaults
from robots.io.wire.link_error import LinkError
from tests.tiers import examples

MANY = settings(max_examples=examples(200, nightly=25_000), deadline=None)
ORDER = st.sampled_from(["little", "big"])
INT32 = st.integers(-(2**31), 2**31 - 1)
FLOAT32 = st.floats(width=32, allow_nan=False, allow_infinity=False)
ANY_FLOAT32 = st.floats(width=32)
TEN = st.tuples(*[FLOAT32] * 10)
TRISTATE = st.sampled_from(Tristate)
STATES = st.builds(
    RobotStatus,
    drives_powered=TRISTATE,
    e_stopped=TRISTATE,
    error_code=INT32,
    in_error=TRISTATE,
    in_motion=TRISTATE,
    mode=st.sampled_from(OperatingMode),
    motion_possible=TRISTATE,
)
CHUNKS = st.lists(st.binary(max_size=80), max_size=8)
FRAMES = st.builds(
    Frame, kind=st.sampled_from([1, 10, 11, 13, 14, 15]), comm=INT32, reply=INT32, data=st.binary(max_size=140)
)


def split(codec: SimpleMessageCodec, data: bytes) -> Frame:
    (frame,) = codec.split(bytearray(data))
    return frame


@MANY
@given(ORDER, INT32, TEN, FLOAT32, FLOAT32)
def test_a_point_survives_its_frame(
    order: ByteOrder, sequence: int, joints: tuple[float, ...], velocity: float, duration_s: float
) -> None:
    codec = SimpleMessageCodec(order)
    point = TrajectoryPoint(sequence=sequence, joints_rad=joints, velocity=velocity, duration_s=duration_s)
    assert codec.decode_point(split(codec, codec.encode_point(point))) == point


@MANY
@given(ORDER, INT32, TEN, STATES)
def test_measurements_and_states_survive_their_frames(
    order: ByteOrder, sequence: int, joints: tuple[float, ...], status: RobotStatus
) -> None:
    codec, position = SimpleMessageCodec(order), JointPosition(sequence=sequence, joints_rad=joints)
    assert codec.decode_joint_position(split(codec, codec.encode_joint_position(position))) == position
    assert codec.decode_status(split(codec, codec.encode_status(status))) == status


@MANY
@given(FRAMES)
def test_a_frame_is_a_message_or_an_error_by_name(frame: Frame) -> None:
    codec = SimpleMessageCodec()
    for decode in (codec.decode_reply, codec.decode_joint_position, codec.decode_status, codec.decode_point):
        reason = "garbage: "
        try:
            decode(frame)
        except LinkError as error:
            reason = str(error)
        assert reason.startswith("garbage: ")


@MANY
@given(CHUNKS)
def test_bytes_of_a_controller_are_frames_or_an_error_by_name(chunks: list[bytes]) -> None:
    codec, received, reason = SimpleMessageCodec(), bytearray(), "garbage: "
    try:
        for chunk in chunks:
            received += chunk
            for frame in codec.split(received):
                assert len(frame.data) <= 1012
    except LinkError as error:
        reason = str(error)
    assert reason.startswith("garbage: ")


@MANY
@given(CHUNKS)
def test_what_any_server_sends_is_a_reading_or_an_error_by_name(chunks: list[bytes]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        transport = StateTransport(*server.getsockname(), byte_order="little", timeout_s=5.0)
        transport.open()
        client, _ = server.accept()
        with client:
            client.sendall(b"".join(chunks))
        with pytest.raises(LinkError, match=r"^(garbage|link cut): "):
            transport.read()
        transport.close()


class FrozenTime:
    """A controller that has all the time to move that it wants."""

    def __init__(self) -> None:
        self.now_s = 0.0
        self.controller = EmulatedController(lambda: self.now_s, axes=np.zeros(6), stop_s=0.2)
        self.session = MotionSession(self.controller, WireFaults(), byte_order="little")

    def travel_after(self, chunks: list[bytes]) -> float:
        """Feed bytes, let time pass, and return how far the axes went."""
        with suppress(SessionClosed):
            for chunk in chunks:
                self.session.feed(chunk)
                self.now_s += 0.5
        self.now_s += 0.5
        self.controller.advance()
        return self.controller.travel_rad


@MANY
@given(CHUNKS)
def test_no_bytes_move_a_controller(chunks: list[bytes]) -> None:
    assert FrozenTime().travel_after(chunks) == 0.0


@MANY
@given(st.lists(FRAMES, max_size=6))
def test_no_frame_moves_a_controller_without_the_end_of_a_download(frames: list[Frame]) -> None:
    device, codec = FrozenTime(), SimpleMessageCodec()
    travel = device.travel_after([codec.encode_frame(frame) for frame in frames])
    assert travel == 0.0 or device.controller.started > 0


@MANY
@given(st.lists(st.tuples(st.sampled_from([-1, 1, -3, -4]), st.tuples(*[ANY_FLOAT32] * 12)), max_size=5))
def test_any_numbers_in_a_download_leave_the_axes_finite(points: list[tuple[int, tuple[float, ...]]]) -> None:
    device, codec = FrozenTime(), SimpleMessageCodec()
    frames = [
        TrajectoryPoint(sequence=sequence, joints_rad=values[:10], duration_s=values[11]) for sequence, values in points
    ]
    for point in frames:
        device.controller.take(codec.decode_point(_unchecked(point)))
    device.travel_after([])
    assert np.isfinite(device.controller.axes).all()


@MANY
@given(CHUNKS)
def test_no_bytes_switch_a_gripper(chunks: list[bytes]) -> None:
    gripper = EmulatedGripperSwitch("ok")
    session = GripperSession(gripper)
    for chunk in chunks:
        session.feed(chunk)
    assert gripper.switched == 0


def _unchecked(point: TrajectoryPoint) -> Frame:
    """Return the frame of a point with values that our own encoder refuses."""
    numbers = np.array([*point.joints_rad, point.velocity, point.duration_s], dtype="<f4").tobytes()
    return Frame(kind=11, comm=2, data=np.array(point.sequence, dtype="<i4").tobytes() + numbers)
