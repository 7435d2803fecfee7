"""What the proxy adds to the arm of franky-sim, which judges nothing: reflexes, stops by a person, lost set points.

A motion that is aborted is really stopped in the simulated robot, by its own request for that.
"""

from __future__ import annotations

import asyncio
import struct
from collections.abc import Callable, Sequence

from robots.drivers.franka.emulation.command_link import Write
from robots.drivers.franka.emulation.robot_state_bytes import (
    RobotStateFields,
    is_robot_state,
    read_robot_state,
    write_errors,
    write_wrench,
)
from robots.drivers.franka.franka_faults import FrankaMode

ROBOT_HEADER = struct.Struct("<III")
_MOVE, _STOP_MOVE, _SET_COLLISION_BEHAVIOR, _RECOVER = 1, 2, 3, 10
_STARTED, _NOT_POSSIBLE, _REFLEX_ABORTED, _USER_STOPPED = 1, 5, 8, 9
_OUR_STOP = 0xFFFFFF00
_REST_RAD_S = 0.01
_REFLEX_TORQUES = struct.Struct("<7d")
_REFLEX_TORQUES_AT = ROBOT_HEADER.size + 8 * 21


class ArmRules:
    """Implements `LinkRules` for the arm.

    Args:
        lost_packets: Set points lost in a row that end a motion, 0 for any number.
    """

    def __init__(self, *, lost_packets: int) -> None:
        self.lost_packets = lost_packets
        self.wrench: Sequence[float] | None = None
        self.latest: RobotStateFields | None = None
        self.settings = 0
        """How often a client has set the thresholds."""
        self.reflex_torque_nm: tuple[float, ...] = ()
        self.recoveries = 0
        self._mode: FrankaMode | None = None
        self._errors: tuple[str, ...] = ()
        self._motion = 0
        self._is_moving = False
        self._abort_status = 0
        self._missed = 0
        self._to_robot: Write = lambda _bytes: None
        self._to_client: Write = lambda _bytes: None
        self._waiting: list[tuple[Callable[[], bool], asyncio.Future[None]]] = []

    @property
    def mode(self) -> FrankaMode:
        """The mode that clients see."""
        if self._mode is not None:
            return self._mode
        return self.latest.mode if self.latest is not None else FrankaMode.IDLE

    @property
    def is_controlled(self) -> bool:
        """Whether a client's motion is active."""
        return self._is_moving

    @property
    def is_at_rest(self) -> bool:
        """Whether no joint moves."""
        return self.latest is not None and max(map(abs, self.latest.dq)) < _REST_RAD_S

    def stop_by(self, mode: FrankaMode, errors: Sequence[str] = ()) -> None:
        """Show a mode with errors, and abort the motion."""
        self._mode, self._errors = mode, tuple(errors)
        if self._is_moving:
            self._abort_status = _USER_STOPPED if mode is FrankaMode.USER_STOPPED else _REFLEX_ABORTED
            self._to_robot(ROBOT_HEADER.pack(_STOP_MOVE, _OUR_STOP, ROBOT_HEADER.size))

    def release(self) -> None:
        """End a mode that a person causes."""
        self._mode, self._errors = None, ()

    async def until(self, condition: Callable[[], bool]) -> None:
        """Wait for a state that meets a condition."""
        if not condition():
            future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
            self._waiting.append((condition, future))
            await future

    def connected(self, *, to_robot: Write, to_client: Write) -> None:
        """Note a client, and how it and the robot are written to."""
        self._to_robot, self._to_client = to_robot, to_client

    def disconnected(self) -> None:
        """Note that the client has gone, and its motion with it."""
        self._is_moving, self._abort_status = False, 0
        self._to_robot = self._to_client = lambda _bytes: None

    def request(self, code: int, number: int, message: bytes) -> bool:
        """Refuse motions and recoveries in modes that do not permit them."""
        if code == _MOVE:
            if self._mode is not None:
                self._refuse(code, number, _NOT_POSSIBLE)
                return False
            self._motion, self._abort_status = number, 0
        elif code == _RECOVER:
            if self._mode not in (None, FrankaMode.REFLEX):
                self._refuse(code, number, 1)
                return False
            self.recoveries += 1
            self.release()
        elif code == _SET_COLLISION_BEHAVIOR:
            self.settings += 1
            self.reflex_torque_nm = _REFLEX_TORQUES.unpack_from(message, _REFLEX_TORQUES_AT)
        return True

    def reply(self, code: int, number: int, message: bytes) -> bytes:
        """Keep our own stop from the client, and give a motion the end that it had."""
        if code == _STOP_MOVE and number == _OUR_STOP:
            return b""
        if code != _MOVE or number != self._motion:
            return message
        status = message[ROBOT_HEADER.size]
        self._is_moving = status == _STARTED
        self._missed = 0
        if not self._is_moving and self._abort_status:
            return message[: ROBOT_HEADER.size] + bytes((self._abort_status,)) + message[ROBOT_HEADER.size + 1 :]
        return message

    def state(self, datagram: bytes) -> bytes:
        """Show mode, errors and forces."""
        if not is_robot_state(datagram):
            return datagram
        self.latest = read_robot_state(datagram)
        self._missed += 1
        if self._is_moving and 0 < self.lost_packets < self._missed and self._mode is None:
            self.stop_by(FrankaMode.REFLEX, ("communication_constraints_violation",))
        for condition, future in self._waiting:
            if not future.done() and condition():
                future.set_result(None)
        self._waiting = [waiting for waiting in self._waiting if not waiting[1].done()]
        if self._mode is None and self.wrench is None:
            return datagram
        shown = bytearray(datagram)
        if self._mode is not None:
            write_errors(shown, mode=self._mode, errors=self._errors)
        if self.wrench is not None:
            write_wrench(shown, self.wrench)
        return bytes(shown)

    def command(self) -> None:
        """Note a set point."""
        self._missed = 0

    def _refuse(self, code: int, number: int, status: int) -> None:
        self._to_client(ROBOT_HEADER.pack(code, number, ROBOT_HEADER.size + 1) + bytes((status,)))
