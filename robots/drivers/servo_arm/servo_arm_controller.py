"""A servo arm that follows joint set points over a serial line."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from robots.drivers.arm.joint_controller import ControllerIdentity, ControllerLost, ControllerReading, MotionRefused
from robots.drivers.servo_arm.servo_arm_options import ServoArmOptions, ServoCalibration
from robots.drivers.servo_arm.servo_lines import (
    ASK,
    GO,
    PICK,
    PLACE,
    STOP,
    BoardReply,
    decode_reply,
    encode_set_point,
)
from robots.io.wire.link_error import LinkError
from robots.io.wire.serial_stream import SerialStream, shown
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.io.wire.wire_tap import NO_TAP, WireTap
from robots.port import Array

CLAW_OUTPUT = 0
_LONGEST_LINE = 256
_DECIMALS = 1
_ASKED_AGAIN_PERIODS = 5.0
# Limits in radians and in degrees differ by rounding.
_AT_LIMIT_DEG = 0.05
_NOT_ENABLED = "motion is not enabled"
_RESTARTED = "the board has restarted, as by a reset or a dip of its supply: where its servos are is not known"
_CHECK = "check cable and supply of the board, `device` and `baud`, and that the sketch flexcell_servo_arm runs on it"
_WRITTEN = "positions are those that the board writes to its servos, which report none"
_COMMANDED = (
    "positions are those that were commanded: the board answers nothing, so that nothing shows whether the arm moves"
)


def new_servo_arm_controller(options: bytes, capture: WireCapture = NO_CAPTURE) -> ServoArmController:
    """Return the controller of encoded options, not yet connected."""
    return ServoArmController(msgspec.json.decode(options, type=ServoArmOptions), tap=capture.tap("servo_lines"))


class ServoArmController:
    """Implements `robots.drivers.arm.joint_controller.JointController`."""

    def __init__(self, options: ServoArmOptions, *, tap: WireTap = NO_TAP) -> None:
        self._options = options
        self._servos = options.servos
        self._line = SerialStream(options.device, baud=options.baud, timeout_s=options.stale_s, tap=tap)
        self._buffer = bytearray()
        self._angles_deg = tuple(servo.home_deg for servo in options.servos)
        self._previous: ControllerReading | None = None
        self._stopped_by = _NOT_ENABLED
        self._is_enabled = False
        self._is_asked = False
        self._answered_s = self._asked_s = self._tick_s = 0.0
        self._garbage = b""
        self._claw = False

    @property
    def period_s(self) -> float:
        """Time between two set points."""
        return self._options.period_s

    @property
    def _answers(self) -> bool:
        return self._options.sketch == "flexcell"

    def connect(self) -> ControllerIdentity:
        """Open the line, which resets most boards, and wait until the board has started; raises ControllerLost."""
        options = self._options
        try:
            self._line.open()
        except LinkError as error:
            raise _lost(str(error)) from error
        self._tick_s = self._answered_s = time.monotonic()
        started = self._await(lambda reply: reply.started, time.monotonic() + options.boot_s)
        if not self._answers:
            return ControllerIdentity(firmware="unknown sketch without answers", notes=(_COMMANDED,))
        # A board that opening does not reset says no READY, and answers all the same.
        self._send(ASK)
        reply = self._await(lambda reply: bool(reply.angles_deg), time.monotonic() + options.stale_s)
        if reply is None:
            raise _lost(f"the board does not answer{self._received()}")
        self._is_asked = False
        sketch = "sketch flexcell_servo_arm" + (", started" if started is not None else ", running already")
        return ControllerIdentity(firmware=sketch, notes=(_WRITTEN,))

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        """Let the board accept set points; after its start it holds its servos at their home angles.

        Raises:
            MotionRefused: it refuses.
            ControllerLost: it does not answer.
        """
        if self._answers:
            self._send(GO)
            limit_s = time.monotonic() + self._options.stale_s
            reply = self._await(lambda reply: bool(reply.error) or (bool(reply.angles_deg) and not reply.halt), limit_s)
            if reply is None:
                raise _lost(f"the board does not answer GO{self._received()}")
            if reply.error:
                raise MotionRefused(f"the board refuses to be enabled: {reply.error}")
            self._is_asked = False
        self._previous = None
        self._stopped_by, self._is_enabled = "", True

    def read(self) -> ControllerReading:
        """Wait for the next period, and return what the board says, or, where it says nothing, what was commanded.

        An answer that is late by less than `stale_s` leaves the reading as it was.

        Raises:
            ControllerLost: the link is cut, or nothing valid came for `stale_s`.
        """
        now_s = time.monotonic()
        self._tick_s = min(max(self._tick_s + self.period_s, now_s), now_s + self.period_s)
        # An answer that got lost is not waited for until the connection counts as lost.
        if self._answers and (not self._is_asked or now_s - self._asked_s > _ASKED_AGAIN_PERIODS * self.period_s):
            self._send(ASK)
        while True:
            late_s = now_s + 2.0 * self.period_s if self._answers and self._is_asked else self._tick_s
            reply = self._next(late_s)
            if reply is None:
                break
            self._take(reply)
        silent_s = time.monotonic() - self._answered_s
        if self._answers and silent_s > self._options.stale_s:
            raise _lost(f"no valid answer for {silent_s:.2f} s{self._received()}")
        return self._reading()

    def command(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Send the set point of the next period, rounded to what the board takes.

        Raises:
            MotionRefused: it is not enabled, or a servo does not turn that far.
            ControllerLost: the link is cut.
        """
        if self._stopped_by:
            raise MotionRefused(self._stopped_by)
        angles_deg = list(servo_angles(position_rad, self._servos))
        for number, (angle, servo) in enumerate(zip(angles_deg, self._servos, strict=True), start=1):
            if not servo.lower_deg - _AT_LIMIT_DEG <= angle <= servo.upper_deg + _AT_LIMIT_DEG:
                turns = f"it turns from {servo.lower_deg:g}° to {servo.upper_deg:g}°"
                raise MotionRefused(f"servo {number} cannot turn to {angle:.1f}°: {turns}")
            angles_deg[number - 1] = min(servo.upper_deg, max(servo.lower_deg, angle))
        self._send(encode_set_point(angles_deg, decimals=_DECIMALS if self._answers else 0))
        if not self._answers:
            self._angles_deg = tuple(float(round(angle)) for angle in angles_deg)

    def stop(self) -> None:
        """Hold the servos where they are; a board that answers nothing follows the last set point, which stays."""
        self._is_enabled = False
        self._stopped_by = self._stopped_by or "stopped: " + _NOT_ENABLED
        if self._answers and self._line.is_open:
            try:
                self._line.write(STOP)
            except LinkError as error:
                raise _lost(str(error)) from error

    def set_output(self, output: int, *, on: bool) -> None:
        """Close the claw (on) or open it (off): output 0, and the only one.

        Raises:
            MotionRefused: there is no such output, or motion is not enabled.
            ControllerLost: the link is cut.
        """
        if output != CLAW_OUTPUT:
            raise MotionRefused(f"the board has no output {output}, only {CLAW_OUTPUT}, its claw")
        if self._stopped_by:
            raise MotionRefused(self._stopped_by)
        self._send(PICK if on else PLACE)
        if not self._answers:
            self._claw = on

    @property
    def output_problem(self) -> str:
        """Nothing: a line that is not answered loses the connection."""
        return ""

    def close(self) -> None:
        """Disconnect; the servos hold where they are."""
        try:
            if self._line.is_open and self._is_enabled:
                self.stop()
        except ControllerLost:
            pass  # a board whose line is gone holds its servos by its watchdog
        finally:
            self._line.close()

    def _send(self, line: bytes) -> None:
        self._asked_s, self._is_asked = time.monotonic(), True
        try:
            self._line.write(line)
        except LinkError as error:
            raise _lost(str(error)) from error

    def _await(self, condition: Callable[[BoardReply], bool], limit_s: float) -> BoardReply | None:
        """Return the first line that meets a condition; None if none comes until `limit_s`."""
        while (reply := self._next(limit_s)) is not None:
            if condition(reply):
                self._note_angles(reply)
                return reply
        return None

    def _take(self, reply: BoardReply) -> None:
        """Apply a line that came while the board was read."""
        if reply.started:
            self._stop_by(_RESTARTED)
            return
        self._is_asked = False
        if reply.error:
            self._answered_s = time.monotonic()
            self._stop_by(f"the board refused a line: {reply.error}")
        else:
            self._note_angles(reply)
            if reply.halt:
                self._stop_by(reply.halt)

    def _stop_by(self, cause: str) -> None:
        """Note why the board does not move; the first cause stays until it is enabled again."""
        if self._is_enabled:
            self._is_enabled, self._stopped_by = False, cause

    def _note_angles(self, reply: BoardReply) -> None:
        self._answered_s, self._garbage = time.monotonic(), b""
        if reply.angles_deg:
            self._angles_deg = reply.angles_deg
        if reply.claw_closes is not None:
            self._claw = reply.claw_closes

    def _reading(self) -> ControllerReading:
        now_s, previous = time.monotonic(), self._previous
        position = joint_angles(self._angles_deg, self._servos)
        velocity = np.zeros(len(self._servos))
        if previous is not None and now_s > previous.time_s:
            velocity = (position - previous.position_rad) / (now_s - previous.time_s)
        self._previous = ControllerReading(
            time_s=now_s,
            position_rad=position,
            velocity_rad_s=velocity,
            effort_nm=np.zeros(len(self._servos)),
            stopped_by=self._stopped_by,
            outputs=(self._claw,),
        )
        return self._previous

    def _received(self) -> str:
        return f", but bytes that are no answer: {shown(self._garbage)}" if self._garbage else ""

    def _next(self, limit_s: float) -> BoardReply | None:
        """Return the next line that means something; None if none comes until `limit_s`."""
        while True:
            line, end, rest = bytes(self._buffer).partition(b"\n")
            if end:
                self._buffer = bytearray(rest)
                reply = decode_reply(line.strip(), servos=len(self._servos))
                if reply is not None:
                    return reply
                self._garbage = line
                continue
            if len(self._buffer) > _LONGEST_LINE:
                self._garbage = bytes(self._buffer)
                self._buffer.clear()
            try:
                received = self._line.read(limit_s)
            except LinkError as error:
                raise _lost(str(error)) from error
            if not received:
                return None
            self._buffer.extend(received)


def servo_angles(position_rad: Array, servos: Sequence[ServoCalibration]) -> tuple[float, ...]:
    """Return the angles of servos, degrees, at joint angles."""
    joints = zip(position_rad.tolist(), servos, strict=True)
    return tuple(servo.scale * math.degrees(angle) + servo.offset_deg for angle, servo in joints)


def joint_angles(angles_deg: Sequence[float], servos: Sequence[ServoCalibration]) -> Array:
    """Return the joint angles, radians, at the angles of servos."""
    turned = zip(angles_deg, servos, strict=True)
    return np.array([math.radians((angle - servo.offset_deg) / servo.scale) for angle, servo in turned])


def _lost(reason: str) -> ControllerLost:
    return ControllerLost(f"{reason}; {_CHECK}")
