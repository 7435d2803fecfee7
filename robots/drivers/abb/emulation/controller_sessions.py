"""What each port of the controller does with the bytes of its client; knows no socket."""

from __future__ import annotations

from robots.drivers.abb.emulation.emulated_controller import EmulatedController
from robots.drivers.abb.simple_message import ByteOrder, CommType, MessageType, ReplyCode, SimpleMessageCodec
from robots.drivers.emulation.plant import OutputListener, unconnected
from robots.drivers.emulation.wire_faults import WireFaults
from robots.io.wire.link_error import LinkError

_MOST_TEXT = 80


class SessionClosed(Exception):
    """The program of the controller drops its client and restarts."""


class MotionSession:
    """The motion server: takes points of trajectories, replies where a reply is requested, drops what is none."""

    def __init__(self, controller: EmulatedController, faults: WireFaults, *, byte_order: ByteOrder) -> None:
        self._controller = controller
        self._faults = faults
        self._codec = SimpleMessageCodec(byte_order)
        self._received = bytearray()

    def feed(self, received: bytes) -> bytes:
        """Take bytes and return the replies; raises SessionClosed."""
        self._received += received
        replies = b""
        try:
            for frame in self._codec.split(self._received):
                if frame.kind != MessageType.TRAJECTORY_POINT:
                    raise SessionClosed(f"message of type {frame.kind}")
                point = self._codec.decode_point(frame)
                if self._faults.refuse:
                    replies += self._codec.encode_reply(ReplyCode.FAILURE)
                    continue
                self._controller.take(point)
                if frame.comm == CommType.SERVICE_REQUEST:
                    replies += self._codec.encode_reply(ReplyCode.SUCCESS)
        except LinkError as error:
            raise SessionClosed(str(error)) from error
        return replies


class StateSession:
    """The state server: sends the measurement and the status, and takes nothing."""

    def __init__(self, controller: EmulatedController, *, byte_order: ByteOrder) -> None:
        self._controller = controller
        self._codec = SimpleMessageCodec(byte_order)

    def feed(self, received: bytes) -> bytes:
        """Take bytes and do nothing."""
        return b""

    def messages(self) -> bytes:
        """Return both messages."""
        position = self._codec.encode_joint_position(self._controller.joint_position())
        return position + self._codec.encode_status(self._controller.status())


class GripperSession:
    """The texts of a gripper program; a text that is none switches nothing."""

    def __init__(self, gripper: EmulatedGripperSwitch) -> None:
        self._gripper = gripper

    def feed(self, received: bytes) -> bytes:
        """Take a text, which a RAPID program receives in one piece, and return the reply."""
        text = received[:_MOST_TEXT].decode("ascii", errors="replace").strip()
        if text not in ("gripperON", "gripperOFF"):
            return b""
        self._gripper.switch(on=text == "gripperON")
        return self._gripper.reply.encode()


class EmulatedGripperSwitch:
    """Whether the gripper is on, and what its program replies; empty for nothing. It is output 0 of `on_output`."""

    def __init__(self, reply: str, on_output: OutputListener = unconnected) -> None:
        self.reply = reply
        self.on = False
        self.switched = 0
        self._on_output = on_output

    def switch(self, *, on: bool) -> None:
        """Turn it on or off."""
        self.on = on
        self.switched += 1
        self._on_output(0, on=on)
