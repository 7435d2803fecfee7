"""The control process of a real arm: owns its controller, and the library behind it."""

from __future__ import annotations

import gc
import importlib
import logging
import os
import signal
import socket
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import cast

import numpy as np

from engine.errors import FlexcellError
from engine.stop import StopLine
from robots.drivers.arm.arm_process_loop import ArmProcessLoop
from robots.drivers.arm.arm_process_messages import (
    ControllerOpened,
    FromArmProcess,
    OpenController,
    ToArmProcess,
)
from robots.drivers.arm.arm_state_layout import ArmStateLayout
from robots.drivers.arm.controller_loop import ControllerLoop
from robots.drivers.arm.joint_controller import ControllerFailure, JointController
from robots.io.message_socket import MessageSocket, PeerGone
from robots.io.process_log import log_nonblocking
from robots.io.real_time_schedule import take_real_time_schedule
from robots.io.request_failure import RequestFailure
from robots.io.wire.wire_capture import WireCapture
from robots.model.transform import RigidTransform
from robots.port.control_process import EngineMonitor
from robots.port.heartbeat import Heartbeat
from robots.port.shared_numbers import SharedNumbers
from robots.port.stop_monitor import StopMonitor

_Channel = MessageSocket[ToArmProcess, FromArmProcess]


def main() -> None:
    """Run on the descriptors of socket, state, heartbeat and, optionally, stop line; ends the process."""
    # Ctrl-C reaches the whole process group; the parent brings the arm to rest first.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    # The parent reports the jumps of set points: writing could block this loop.
    logging.getLogger("flexcell.set_points").disabled = True
    # Libraries print; nobody may take that for an answer.
    os.dup2(2, 1)
    connection_fd, state_fd, heartbeat_fd, *stop_fd = (int(argument) for argument in sys.argv[1:])
    connection = socket.socket(fileno=connection_fd)
    channel: _Channel = MessageSocket(connection, ToArmProcess)
    code = 1
    try:
        number, request = channel.wait()
        if isinstance(request, OpenController):
            line = StopLine(socket.socket(fileno=stop_fd[0])) if stop_fd else None
            capture = WireCapture(Path(request.capture) if request.capture else None, device=request.arm.name)
            try:
                _serve(request, capture, number, channel, connection, descriptors=(state_fd, heartbeat_fd), line=line)
            finally:
                capture.close()
        code = 0
    except PeerGone:
        code = 0
    except Exception as error:
        log_nonblocking(f"{type(error).__name__}: {error}", of="arm process")
    # Destructors of client libraries crash after a lost link.
    os._exit(code)


def _serve(
    request: OpenController,
    capture: WireCapture,
    number: int,
    channel: _Channel,
    connection: socket.socket,
    *,
    descriptors: tuple[int, int],
    line: StopLine | None,
) -> None:
    try:
        controller = new_controller(request, capture)
        identity = controller.connect()
        model, base = request.arm.robot(), RigidTransform.from_pose(request.arm.base)
        arm = ControllerLoop(
            name=request.arm.name,
            model=model,
            base=base,
            controller=controller,
            gravity_m_s2=np.array(request.gravity_m_s2),
            stale_s=request.stale_s,
        )
        arm.read_first()
    except ControllerFailure as error:
        channel.send(RequestFailure(message=str(error), hint=error.hint), number=number)
        return
    except FlexcellError as error:
        channel.send(RequestFailure.of(error), number=number)
        return
    state_fd, heartbeat_fd = descriptors
    layout = ArmStateLayout(model.dof)
    log = partial(log_nonblocking, of=request.arm.name)
    loop = ArmProcessLoop(
        arm,
        controller,
        channel,
        engine=EngineMonitor(Heartbeat(heartbeat_fd), arm, limit_s=request.engine_silence_s, log=log),
        stop=StopMonitor(line, arm),
        shared=SharedNumbers(state_fd, layout.size),
        layout=layout,
    )
    loop.publish()
    signal.signal(signal.SIGTERM, loop.request_end)
    take_real_time_schedule()
    gc.collect()
    gc.freeze()
    # A collection in mid-period would be late by milliseconds; the loop makes no cycles.
    gc.disable()
    channel.send(ControllerOpened(identity=identity), number=number)
    connection.setblocking(False)
    loop.run()
    connection.setblocking(True)
    channel.flush()
    controller.close()


def new_controller(request: OpenController, capture: WireCapture) -> JointController:
    """Return the controller of a request, not yet connected."""
    module, _, attribute = request.controller.partition(":")
    maker = cast("Callable[[bytes, WireCapture], JointController]", getattr(importlib.import_module(module), attribute))
    return maker(request.options, capture)
