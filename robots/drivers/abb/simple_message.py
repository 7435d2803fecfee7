"""The frames of simple_message that an ABB IRC5 uses: lengths, headers and three kinds of data; knows no socket."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Literal

from robots.io.wire.link_error import LinkError

ByteOrder = Literal["little", "big"]
"""RAPID packs little-endian; big is what the `_bswap` variant of simple_message speaks."""

JOINTS = 10
"""Joints of a message: six axes in radians, then four external axes."""
START_DOWNLOAD, END_DOWNLOAD, STOP = -1, -3, -4
"""Sequence numbers: the first point, the last point, which starts the motion, and the request to stop."""

_HEADER_BYTES = 12
_MOST_BYTES = 1024
_SHOWN_BYTES = 16


class MessageType(IntEnum):
    """MSG_TYPE."""

    JOINT_POSITION = 10
    TRAJECTORY_POINT = 11
    STATUS = 13


class CommType(IntEnum):
    """COMM_TYPE."""

    TOPIC = 1
    SERVICE_REQUEST = 2
    SERVICE_REPLY = 3


class ReplyCode(IntEnum):
    """REPLY_CODE; 0 in everything that is no reply."""

    INVALID = 0
    SUCCESS = 1
    FAILURE = 2


class Tristate(IntEnum):
    """What a controller says of itself, if it knows."""

    UNKNOWN = -1
    NO = 0
    YES = 1


class OperatingMode(IntEnum):
    """The mode selector."""

    UNKNOWN = -1
    MANUAL = 1
    AUTO = 2


@dataclass(frozen=True, kw_only=True)
class Frame:
    """One message with undecoded data."""

    kind: int
    comm: int
    reply: int = ReplyCode.INVALID
    data: bytes = b""


@dataclass(frozen=True, kw_only=True)
class JointPosition:
    """Measured angles of the axes as the controller counts them, ten values."""

    sequence: int
    joints_rad: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class TrajectoryPoint:
    """One point of a download: `duration_s` is the time of the move to it; the velocity is not used by ABB."""

    sequence: int
    joints_rad: tuple[float, ...]
    velocity: float = 0.0
    duration_s: float


@dataclass(frozen=True, kw_only=True)
class RobotStatus:
    """The status of a controller."""

    drives_powered: Tristate
    e_stopped: Tristate
    error_code: int
    in_error: Tristate
    in_motion: Tristate
    mode: OperatingMode
    motion_possible: Tristate


class SimpleMessageCodec:
    """Encodes and decodes data and frames in one byte order."""

    def __init__(self, byte_order: ByteOrder = "little") -> None:
        mark = "<" if byte_order == "little" else ">"
        self._length = struct.Struct(f"{mark}i")
        self._header = struct.Struct(f"{mark}3i")
        self._joint_position = struct.Struct(f"{mark}i{JOINTS}f")
        self._point = struct.Struct(f"{mark}i{JOINTS}f2f")
        self._status = struct.Struct(f"{mark}7i")

    def encode_frame(self, frame: Frame) -> bytes:
        """Return the bytes of a frame with its length before it."""
        header = self._header.pack(frame.kind, frame.comm, frame.reply)
        return self._length.pack(_HEADER_BYTES + len(frame.data)) + header + frame.data

    def encode_joint_position(self, position: JointPosition) -> bytes:
        """Return the frame of a measurement; raises ValueError for other than ten finite float32 values."""
        data = self._pack(self._joint_position, position.sequence, *_ten(position.joints_rad))
        return self.encode_frame(Frame(kind=MessageType.JOINT_POSITION, comm=CommType.TOPIC, data=data))

    def encode_point(self, point: TrajectoryPoint, *, comm: CommType = CommType.SERVICE_REQUEST) -> bytes:
        """Return the frame of a point of a download; raises ValueError for values that are no finite float32."""
        rates = (point.velocity, point.duration_s)
        data = self._pack(self._point, point.sequence, *_ten(point.joints_rad), *_finite(rates))
        return self.encode_frame(Frame(kind=MessageType.TRAJECTORY_POINT, comm=comm, data=data))

    def encode_reply(self, code: ReplyCode) -> bytes:
        """Return the reply to a point."""
        return self.encode_frame(Frame(kind=MessageType.TRAJECTORY_POINT, comm=CommType.SERVICE_REPLY, reply=code))

    def encode_status(self, status: RobotStatus) -> bytes:
        """Return the frame of a status."""
        data = self._status.pack(
            status.drives_powered,
            status.e_stopped,
            status.error_code,
            status.in_error,
            status.in_motion,
            status.mode,
            status.motion_possible,
        )
        return self.encode_frame(Frame(kind=MessageType.STATUS, comm=CommType.TOPIC, data=data))

    def decode_joint_position(self, frame: Frame) -> JointPosition:
        """Return the measurement in a frame; raises LinkError for anything else."""
        values = self._unpack(self._joint_position, frame, MessageType.JOINT_POSITION, CommType.TOPIC)
        return JointPosition(sequence=values[0], joints_rad=_measured(values[1:]))

    def decode_point(self, frame: Frame) -> TrajectoryPoint:
        """Return the point in a frame, whose values may be not finite; raises LinkError for anything else."""
        values = self._unpack(self._point, frame, MessageType.TRAJECTORY_POINT, None)
        return TrajectoryPoint(
            sequence=values[0], joints_rad=values[1 : 1 + JOINTS], velocity=values[-2], duration_s=values[-1]
        )

    def decode_reply(self, frame: Frame) -> ReplyCode:
        """Return the code of the reply to a point; raises LinkError for anything else."""
        expected = (MessageType.TRAJECTORY_POINT, CommType.SERVICE_REPLY)
        if (frame.kind, frame.comm) != expected or frame.reply not in (ReplyCode.SUCCESS, ReplyCode.FAILURE):
            raise LinkError(f"garbage: {_words(frame)} is no reply to a trajectory point")
        return ReplyCode(frame.reply)

    def decode_status(self, frame: Frame) -> RobotStatus:
        """Return the status in a frame; raises LinkError for anything else, also for values without a meaning."""
        values = self._unpack(self._status, frame, MessageType.STATUS, CommType.TOPIC)
        try:
            return RobotStatus(
                drives_powered=Tristate(values[0]),
                e_stopped=Tristate(values[1]),
                error_code=values[2],
                in_error=Tristate(values[3]),
                in_motion=Tristate(values[4]),
                mode=OperatingMode(values[5]),
                motion_possible=Tristate(values[6]),
            )
        except ValueError as error:
            raise LinkError(f"garbage: the status {list(values)} has a value without a meaning: {error}") from error

    def split(self, received: bytearray) -> list[Frame]:
        """Remove the complete frames from the front of `received` and return them.

        Raises:
            LinkError: a length is none of a frame; the bytes after it cannot be understood.
        """
        frames: list[Frame] = []
        while len(received) >= self._length.size:
            (length,) = self._length.unpack_from(received)
            if not _HEADER_BYTES <= length <= _MOST_BYTES:
                shown = bytes(received[:_SHOWN_BYTES]).hex(" ")
                raise LinkError(f"garbage: {length} is no length of a message: {shown}")
            end = self._length.size + length
            if len(received) < end:
                break
            kind, comm, reply = self._header.unpack_from(received, self._length.size)
            data = bytes(received[self._length.size + _HEADER_BYTES : end])
            frames.append(Frame(kind=kind, comm=comm, reply=reply, data=data))
            del received[:end]
        return frames

    def _pack(self, layout: struct.Struct, *values: float) -> bytes:
        try:
            return layout.pack(*values)
        except (struct.error, OverflowError) as error:
            raise ValueError(f"{values} cannot be sent: {error}") from error

    def _unpack(self, layout: struct.Struct, frame: Frame, kind: MessageType, comm: CommType | None) -> tuple[Any, ...]:
        if frame.kind != kind or comm not in (None, frame.comm) or len(frame.data) < layout.size:
            raise LinkError(f"garbage: {_words(frame)} is no {kind.name}")
        return layout.unpack_from(frame.data)


def _ten(joints_rad: tuple[float, ...]) -> tuple[float, ...]:
    if len(joints_rad) != JOINTS:
        raise ValueError(f"expected {JOINTS} joints, got {len(joints_rad)}")
    return _finite(joints_rad)


def _finite(values: tuple[float, ...]) -> tuple[float, ...]:
    if not all(map(math.isfinite, values)):
        raise ValueError(f"{values} has a value that is not finite")
    return values


def _measured(joints_rad: tuple[float, ...]) -> tuple[float, ...]:
    if not all(map(math.isfinite, joints_rad)):
        raise LinkError(f"garbage: the angles {joints_rad} are not finite")
    return joints_rad


def _words(frame: Frame) -> str:
    return f"a message of type {frame.kind}, comm {frame.comm}, reply {frame.reply} with {len(frame.data)} bytes"
