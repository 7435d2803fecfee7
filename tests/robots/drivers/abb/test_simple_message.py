"""The codec against frames that were written by hand from the table of fields."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robots.drivers.abb.abb_faults import AbbFault, status_fault
from robots.drivers.abb.simple_message import (
    END_DOWNLOAD,
    START_DOWNLOAD,
    STOP,
    Frame,
    JointPosition,
    OperatingMode,
    ReplyCode,
    RobotStatus,
    SimpleMessageCodec,
    TrajectoryPoint,
    Tristate,
)
from robots.io.wire.link_error import LinkError

LINES = (Path(__file__).parent / "simple_message_frames.txt").read_text(encoding="utf-8").splitlines()
FRAMES = {
    name: bytes.fromhex(text) for name, _, text in (line.split(" ", 2) for line in LINES if not line.startswith("#"))
}
JOINTS = (0.5, 1.0, -0.25, 2.0, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0)
ZEROS = (0.0,) * 10
POINTS = {
    "start": TrajectoryPoint(sequence=START_DOWNLOAD, joints_rad=JOINTS, velocity=0.1, duration_s=1.5),
    "second": TrajectoryPoint(sequence=1, joints_rad=JOINTS, velocity=0.1, duration_s=1.5),
    "end": TrajectoryPoint(sequence=END_DOWNLOAD, joints_rad=JOINTS, velocity=0.1, duration_s=1.5),
    "stop": TrajectoryPoint(sequence=STOP, joints_rad=ZEROS, duration_s=0.0),
}
MOVING = RobotStatus(
    drives_powered=Tristate.YES,
    e_stopped=Tristate.NO,
    error_code=0,
    in_error=Tristate.NO,
    in_motion=Tristate.YES,
    mode=OperatingMode.AUTO,
    motion_possible=Tristate.YES,
)
STOPPED = RobotStatus(
    drives_powered=Tristate.NO,
    e_stopped=Tristate.YES,
    error_code=5,
    in_error=Tristate.YES,
    in_motion=Tristate.UNKNOWN,
    mode=OperatingMode.MANUAL,
    motion_possible=Tristate.NO,
)
CODEC = SimpleMessageCodec()


def split(data: bytes, codec: SimpleMessageCodec = CODEC) -> Frame:
    """Return the only frame in these bytes."""
    received = bytearray(data)
    (frame,) = codec.split(received)
    assert not received
    return frame


@pytest.mark.parametrize("name", POINTS)
def test_a_point_is_the_frame_of_the_table(name: str) -> None:
    assert CODEC.encode_point(POINTS[name]) == FRAMES[name]
    point = CODEC.decode_point(split(FRAMES[name]))
    assert (point.sequence, point.joints_rad, point.duration_s) == (
        POINTS[name].sequence,
        POINTS[name].joints_rad,
        POINTS[name].duration_s,
    )
    assert point.velocity == pytest.approx(POINTS[name].velocity)


def test_replies_measurements_and_states_are_the_frames_of_the_table() -> None:
    position = JointPosition(sequence=0, joints_rad=JOINTS)
    assert CODEC.encode_reply(ReplyCode.SUCCESS) == FRAMES["success"]
    assert CODEC.encode_reply(ReplyCode.FAILURE) == FRAMES["failure"]
    assert CODEC.encode_joint_position(position) == FRAMES["position"]
    assert CODEC.encode_status(MOVING) == FRAMES["moving"]
    assert CODEC.encode_status(STOPPED) == FRAMES["stopped"]
    assert CODEC.decode_reply(split(FRAMES["success"])) is ReplyCode.SUCCESS
    assert CODEC.decode_reply(split(FRAMES["failure"])) is ReplyCode.FAILURE
    assert CODEC.decode_joint_position(split(FRAMES["position"])) == position
    assert CODEC.decode_status(split(FRAMES["moving"])) == MOVING
    assert CODEC.decode_status(split(FRAMES["stopped"])) == STOPPED


def test_the_other_byte_order_turns_each_number_around() -> None:
    turned = b"".join(FRAMES["end"][at : at + 4][::-1] for at in range(0, len(FRAMES["end"]), 4))
    big = SimpleMessageCodec("big")
    assert big.encode_point(POINTS["end"]) == turned
    assert big.decode_point(split(turned, big)).sequence == END_DOWNLOAD
    with pytest.raises(LinkError, match=r"garbage: 1073741824 is no length of a message: 00 00 00 40"):
        CODEC.split(bytearray(turned))


def test_frames_may_arrive_in_pieces_and_together() -> None:
    stream, received, frames = FRAMES["position"] + FRAMES["moving"] + FRAMES["success"], bytearray(), list[Frame]()
    for byte in stream:
        received.append(byte)
        frames += CODEC.split(received)
    assert frames == CODEC.split(bytearray(stream))
    assert [frame.kind for frame in frames] == [10, 13, 11]


def test_values_that_cannot_be_sent_are_refused() -> None:
    with pytest.raises(ValueError, match="not finite"):
        CODEC.encode_point(TrajectoryPoint(sequence=1, joints_rad=(math.nan, *ZEROS[1:]), duration_s=1.0))
    with pytest.raises(ValueError, match="expected 10 joints, got 6"):
        CODEC.encode_point(TrajectoryPoint(sequence=1, joints_rad=ZEROS[:6], duration_s=1.0))
    with pytest.raises(ValueError, match="cannot be sent"):
        CODEC.encode_point(TrajectoryPoint(sequence=1, joints_rad=(1e300, *ZEROS[1:]), duration_s=1.0))


@pytest.mark.parametrize(
    ("frame", "reason"),
    [
        (Frame(kind=13, comm=1, data=b"\x07" * 28), "value without a meaning"),
        (Frame(kind=13, comm=1, data=bytes(27)), "is no STATUS"),
        (Frame(kind=13, comm=2, data=bytes(28)), "is no STATUS"),
        (Frame(kind=15, comm=1, data=bytes(132)), "is no STATUS"),
    ],
)
def test_what_is_no_status_is_an_error_by_name(frame: Frame, reason: str) -> None:
    with pytest.raises(LinkError, match=f"garbage: .*{reason}"):
        CODEC.decode_status(frame)


def test_a_request_is_no_reply_and_an_angle_that_is_not_finite_no_measurement() -> None:
    with pytest.raises(LinkError, match=r"garbage: .*is no reply to a trajectory point"):
        CODEC.decode_reply(split(FRAMES["stop"]))
    with pytest.raises(LinkError, match=r"garbage: the angles .* are not finite"):
        CODEC.decode_joint_position(Frame(kind=10, comm=1, data=bytes(4) + b"\xff" * 40))


def test_a_status_has_one_cause_and_what_is_unknown_permits_no_motion() -> None:
    assert status_fault(MOVING) is None
    assert status_fault(STOPPED) == (AbbFault.EMERGENCY_STOP, "the emergency stop is active")
    unknown = CODEC.decode_status(Frame(kind=13, comm=1, data=b"\xff" * 28))
    assert status_fault(unknown) == (
        AbbFault.UNKNOWN_STATUS,
        "the controller does not say e_stopped, mode, drives_powered, motion_possible, in_motion",
    )
