"""A Franka Hand: requests and their replies on TCP, states on UDP."""

from __future__ import annotations

import select
import time

from robots.drivers.franka_hand.franka_hand_reading import (
    CloseFingers,
    FrankaHandCommand,
    FrankaHandReading,
    HomeFingers,
    MoveFingers,
    StopFingers,
)
from robots.drivers.franka_hand.hand_protocol import (
    HAND_PORT,
    FingerState,
    HandMessage,
    HandReply,
    HandRequest,
    decode_state,
    encode_connect,
    encode_grasp,
    encode_homing,
    encode_move,
    encode_stop,
    take_message,
)
from robots.io.wire.datagram_socket import DatagramSocket
from robots.io.wire.link_error import LinkError
from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

_RECEIVED_BYTES = 4096
# Stops have numbers of their own, apart from those of motions.
_FIRST_STOP = 0x4000_0000
# Whatever stops the fingers is what was to be gripped: the skills judge the opening.
_ANY_WIDTH_M = 0.1


class FrankaHandTransport:
    """Implements `DeviceTransport`.

    Args:
        host: Address of the control cabinet.
        timeout_s: Time limit of a connection, a stop and a state.
        command_tap: Notes the bytes of requests and replies.
        state_tap: Notes the datagrams with states.
    """

    def __init__(
        self, host: str, *, timeout_s: float, command_tap: WireTap = NO_TAP, state_tap: WireTap = NO_TAP
    ) -> None:
        self._host = host
        self._timeout_s = timeout_s
        self._command_tap, self._state_tap = command_tap, state_tap
        self._commands: TcpConnection | None = None
        self._states: DatagramSocket | None = None
        self._buffer = bytearray()
        self._stops = _FIRST_STOP
        self._ended, self._end_status = 0, None
        # Number of the grasp that is the last motion; 0 where that is another one, or nobody knows.
        self._grasp = 0
        self._is_grasping = False

    @property
    def address(self) -> str:
        """The control cabinet and its port."""
        return f"{self._host}:{HAND_PORT}"

    @property
    def remedy(self) -> str:
        """What to check when it does not answer."""
        return "activate FCI in the web interface, check that it shows the hand, and that no other client uses it"

    def open(self) -> None:
        """Connect; commands nothing."""
        self.close()
        try:
            where = (self._host, HAND_PORT)
            self._commands = TcpConnection(where, timeout_s=self._timeout_s, tap=self._command_tap)
            self._states = states = DatagramSocket(self._state_tap)
            states.bind(("", 0))
            states.never_wait()
        except OSError as error:
            self.close()
            raise LinkError(f"cannot connect: {error}") from error
        self._send(encode_connect(0, udp_port=states.port))
        limit_s = time.monotonic() + self._timeout_s
        while (message := self._next(limit_s)).request is not HandRequest.CONNECT:
            pass
        message.require_connection()

    def close(self) -> None:
        """Disconnect."""
        for each in (self._commands, self._states):
            if each is not None:
                each.close()
        self._commands = self._states = None
        self._buffer.clear()
        self._ended, self._end_status = 0, None
        self._grasp, self._is_grasping = 0, False

    def read(self) -> FrankaHandReading:
        """Return the latest state, and the last end of a request."""
        state = self._latest_state()
        self._is_grasping = state.is_grasping
        self._note_replies()
        return FrankaHandReading(state=state, ended=self._ended, end_status=self._end_status)

    def write(self, command: FrankaHandCommand) -> None:
        """Send a command. Only a stop is acknowledged before its end."""
        if not isinstance(command, StopFingers):
            self._grasp = command.number if isinstance(command, CloseFingers) else 0
            self._is_grasping = False
        match command:
            case MoveFingers():
                self._send(encode_move(command.number, width_m=command.width_m, speed_m_s=command.speed_m_s))
            case CloseFingers():
                self._send(
                    encode_grasp(
                        command.number,
                        width_m=0.0,
                        inner_m=_ANY_WIDTH_M,
                        outer_m=_ANY_WIDTH_M,
                        speed_m_s=command.speed_m_s,
                        force_n=command.force_n,
                    )
                )
            case HomeFingers():
                self._send(encode_homing(command.number))
            case StopFingers():
                self._stop()

    def _stop(self) -> None:
        """Stop what the hand executes; fingers that press do not move, and would let go."""
        self._note_replies()
        if self._grasp and (self._grasp == self._ended or self._is_grasping):
            return
        self._stops += 1
        self._send(encode_stop(self._stops))
        limit_s = time.monotonic() + self._timeout_s
        while (message := self._next(limit_s)).number != self._stops:
            self._note_end(message)
        if message.status != HandReply.SUCCESS:
            raise LinkError(f"the hand answered STOP with status {message.status}")

    def _note_replies(self) -> None:
        """Note the ends of requests that have arrived."""
        while self._receive(0.0):
            while (message := take_message(self._buffer)) is not None:
                self._note_end(message)

    def _note_end(self, message: HandMessage) -> None:
        if message.number < _FIRST_STOP:
            self._ended, self._end_status = message.number, message.status

    def _latest_state(self) -> FingerState:
        states = self._states
        if states is None:
            raise LinkError("not connected")
        limit_s, latest = time.monotonic() + self._timeout_s, None
        while True:
            try:
                datagram = states.receive(_RECEIVED_BYTES)
            except BlockingIOError:
                if latest is not None:
                    return latest
                waiting_s = limit_s - time.monotonic()
                if waiting_s <= 0.0 or not select.select([states], [], [], waiting_s)[0]:
                    raise LinkError(f"no state within {self._timeout_s:g} s") from None
                continue
            latest = decode_state(datagram) or latest

    def _next(self, limit_s: float) -> HandMessage:
        while (message := take_message(self._buffer)) is None:
            if not self._receive(limit_s - time.monotonic()):
                raise LinkError(f"no reply within {self._timeout_s:g} s")
        return message

    def _receive(self, waiting_s: float) -> bool:
        """Take bytes of the hand; returns False where none come in time."""
        commands = self._commands
        if commands is None:
            raise LinkError("not connected")
        if not select.select([commands], [], [], max(0.0, waiting_s))[0]:
            return False
        try:
            received = commands.receive(_RECEIVED_BYTES)
        except OSError as error:
            raise LinkError(f"the connection is lost: {error}") from error
        if not received:
            raise LinkError("the hand closed the connection")
        self._buffer.extend(received)
        return True

    def _send(self, message: bytes) -> None:
        if self._commands is None:
            raise LinkError("not connected")
        try:
            self._commands.send(message)
        except OSError as error:
            raise LinkError(f"the connection is lost: {error}") from error
