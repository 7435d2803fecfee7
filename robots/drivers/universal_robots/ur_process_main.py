"""The process that owns the client library of a controller: it reads, moves, and tells the watchdog that it is alive.

The library crashes after a lost link, keeps the interpreter's lock while it waits, and prints to the standard output.
So it lives here, is used for asynchronous motions only, and is never asked to reconnect: the process ends instead.
"""

from __future__ import annotations

import importlib
import os
import select
import signal
import socket
import sys
import time
from dataclasses import dataclass
from typing import Any, NoReturn, cast

from engine.host.child_process import set_parent_death_signal
from robots.drivers.universal_robots.ur_messages import (
    HEARTBEAT_S,
    ConnectController,
    ControllerConnected,
    ControllerHeartbeat,
    EnableMotion,
    FromUrProcess,
    LibraryFailure,
    LinkLost,
    MotionEnabled,
    MoveJointsRequest,
    SixNumbers,
    StopMotion,
    ToUrProcess,
    UrMotionReport,
)
from robots.io.message_socket import MessageSocket, PeerGone

_TICK_S = HEARTBEAT_S / 2
_REACHED_RAD = 1e-3
_RESTING_RAD_S = 1e-3
_START_S = 0.2
"""A motion that has not begun after this time, will not."""
_Mailbox = MessageSocket[ToUrProcess, FromUrProcess]


@dataclass
class _Motion:
    """The motion under way."""

    number: int
    target: SixNumbers
    start_s: float
    is_stopped: bool = False


class _Refusal(Exception):
    """The library has returned False."""


class _Session:
    """The interfaces of the library, used by this thread alone."""

    def __init__(self, mailbox: _Mailbox) -> None:
        self._mailbox = mailbox
        self._host = ""
        self._receive: Any = None
        self._control: Any = None
        self._motion: _Motion | None = None
        self._last_time_s = 0.0
        self._tick_time_s = 0.0

    def handle(self, number: int, message: ToUrProcess) -> None:
        """Carry out a request; what the library raises or refuses is the answer."""
        try:
            match message:
                case ConnectController(host=host):
                    self._host = host
                    self._receive = importlib.import_module("rtde_receive").RTDEReceiveInterface(host)
                    self._mailbox.send(ControllerConnected(), number=number)
                case EnableMotion():
                    self._enable(message)
                    self._mailbox.send(MotionEnabled(), number=number)
                case MoveJointsRequest():
                    self._start(number, message)
                case StopMotion(deceleration_rad_s2=deceleration):
                    self._stop(deceleration)
        except PeerGone:
            raise
        # Whatever the library raises: it has no errors of its own.
        except Exception as error:
            self._mailbox.send(LibraryFailure(message=str(error)), number=number)

    def tick(self, *, is_heartbeat: bool) -> None:
        """Kick the watchdog, look after the motion, and report."""
        if self._receive is None:
            return
        time_s = self._receive.getTimestamp()
        is_advancing, self._tick_time_s = time_s > self._tick_time_s, time_s
        if not self._receive.isConnected():
            self._end_lost()
        # While nothing comes in, the control interface would wait for seconds, and the heartbeats with it.
        if is_advancing and self._control is not None:
            try:
                if self._control.isProgramRunning():
                    self._control.kickWatchdog()
            except RuntimeError:
                self._end_lost()
            self._check_motion()
        if is_heartbeat:
            self._mailbox.send(self._heartbeat())

    def _end_lost(self) -> NoReturn:
        """End this process: the destructors of the library crash after a lost link."""
        self._mailbox.send(LinkLost())
        os._exit(0)

    def _enable(self, request: EnableMotion) -> None:
        """Set everything that a controller forgets, in the order in which a motion needs it."""
        if not self._is_safe():
            raise _Refusal("the safety system has stopped the arm")
        if self._control is None:
            self._control = importlib.import_module("rtde_control").RTDEControlInterface(self._host)
        elif not self._control.isProgramRunning():
            self._control.reuploadScript()
            end_s = time.monotonic() + 5.0
            while not self._control.isProgramRunning():
                if time.monotonic() > end_s:
                    raise _Refusal("Failed to start control script")
                self._control.waitPeriod(self._control.initPeriod())
        _accept(self._control.setTcp(list(request.tcp_offset)), "setTcp")
        _accept(self._control.setPayload(request.payload_kg, list(request.payload_cog_m)), "setPayload")
        # The last: from here on there has to be a kick in each of its periods.
        _accept(self._control.setWatchdog(request.watchdog_hz), "setWatchdog")

    def _start(self, number: int, request: MoveJointsRequest) -> None:
        if self._control is None or self._motion is not None:
            raise _Refusal("a motion is under way" if self._motion is not None else "motion is not enabled")
        self._motion = _Motion(number, request.q_rad, time.monotonic())
        # A False is explained by the state of the controller: the report of the motion has it.
        if not self._control.moveJ(list(request.q_rad), request.speed_rad_s, request.acceleration_rad_s2, True):
            self._end_motion()

    def _stop(self, deceleration: float) -> None:
        if self._control is not None and self._motion is not None:
            self._motion.is_stopped = True
            self._control.stopJ(deceleration, True)

    def _check_motion(self) -> None:
        motion = self._motion
        if motion is None:
            return
        is_at_rest = max(abs(speed) for speed in self._receive.getActualQd()) < _RESTING_RAD_S
        if not self._is_safe() or not self._control.isProgramRunning():
            if is_at_rest:
                self._end_motion()
        elif is_at_rest and self._control.getAsyncOperationProgress() < 0:
            has_begun = self._is_reached(motion) or time.monotonic() - motion.start_s > _START_S
            if has_begun or motion.is_stopped:
                self._end_motion()

    def _is_reached(self, motion: _Motion) -> bool:
        q = cast("list[float]", self._receive.getActualQ())
        return max(abs(angle - goal) for angle, goal in zip(q, motion.target, strict=True)) < _REACHED_RAD

    def _is_safe(self) -> bool:
        return bool(self._receive.getSafetyStatusBits() & 1)

    def _end_motion(self) -> None:
        motion, self._motion = self._motion, None
        assert motion is not None
        report = UrMotionReport(
            is_reached=self._is_reached(motion),
            is_stopped=motion.is_stopped,
            safety_bits=self._receive.getSafetyStatusBits(),
            robot_mode=self._receive.getRobotMode(),
            is_program_running=self._control.isProgramRunning(),
        )
        self._mailbox.send(report, number=motion.number)

    def _heartbeat(self) -> ControllerHeartbeat:
        receive = self._receive
        time_s = receive.getTimestamp()
        is_fresh, self._last_time_s = time_s > self._last_time_s, time_s
        return ControllerHeartbeat(
            controller_time_s=time_s,
            is_fresh=is_fresh,
            q_rad=_six(receive.getActualQ()),
            qd_rad_s=_six(receive.getActualQd()),
            tcp_pose=_six(receive.getActualTCPPose()),
            safety_bits=receive.getSafetyStatusBits(),
            robot_mode=receive.getRobotMode(),
            digital_outputs=receive.getActualDigitalOutputBits(),
            speed_scaling=receive.getSpeedScaling(),
        )


def main() -> None:
    """Serve the socket whose descriptor is the first argument until the other end closes it."""
    # Ctrl-C reaches the whole process group; the parent decides when this one ends.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    connection = socket.socket(fileno=int(sys.argv[1]))
    set_parent_death_signal(connection)
    # The library prints; nobody may take that for an answer.
    os.dup2(2, 1)
    try:
        _serve(connection)
    except PeerGone:
        os._exit(0)


def _serve(connection: socket.socket) -> None:
    mailbox = _Mailbox(connection, ToUrProcess)
    session = _Session(mailbox)
    due_s = time.monotonic()
    ticks = 0
    while True:
        readable, _, _ = select.select([connection], [], [], max(0.0, due_s - time.monotonic()))
        if readable:
            for number, message in mailbox.receive():
                session.handle(number, message)
        if time.monotonic() >= due_s:
            ticks += 1
            session.tick(is_heartbeat=ticks % 2 == 0)
            due_s = max(due_s + _TICK_S, time.monotonic())


def _accept(result: object, what: str) -> None:
    if result is not True:
        raise _Refusal(f"{what} was refused")


def _six(values: list[float]) -> SixNumbers:
    a, b, c, d, e, f = values
    return a, b, c, d, e, f
