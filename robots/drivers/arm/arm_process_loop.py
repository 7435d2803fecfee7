"""One period after the other in the control process of a real arm: commands, STOP, the engine's silence, the arm."""

from __future__ import annotations

import time
from types import FrameType

import numpy as np

from engine.errors import RobotError
from robots.control.commanding.arm_commands import StopAll
from robots.drivers.arm.arm_process_messages import (
    CloseController,
    ControllerEnabled,
    ControllerGone,
    EnableController,
    FromArmProcess,
    MotionProblem,
    OpenController,
    OutputSet,
    SafetyState,
    SetControllerOutput,
    ToArmProcess,
)
from robots.drivers.arm.arm_state_layout import ArmStateLayout
from robots.drivers.arm.controller_loop import ControllerLoop
from robots.drivers.arm.joint_controller import ControllerFailure, ControllerLost, JointController, MotionRefused
from robots.io.message_socket import ClosedChannel, MessageSocket, PeerGone
from robots.io.request_failure import RequestFailure
from robots.port.control_process import EngineMonitor
from robots.port.shared_numbers import SharedNumbers
from robots.port.stop_monitor import StopMonitor

_SHUTDOWN_S = 4.0
_OUTPUT_LIMIT_S = 1.0


class ArmProcessLoop:
    """Runs until it is asked to end, or the parent or the controller is gone.

    Args:
        arm: The control loop of the arm.
        controller: Its controller.
        channel: To the parent.
        engine: Sees the engine's silence.
        stop: Sees STOP.
        shared: Where the parent reads the latest state.
        layout: How it is written.
    """

    def __init__(
        self,
        arm: ControllerLoop,
        controller: JointController,
        channel: MessageSocket[ToArmProcess, FromArmProcess],
        *,
        engine: EngineMonitor,
        stop: StopMonitor,
        shared: SharedNumbers,
        layout: ArmStateLayout,
    ) -> None:
        self._arm = arm
        self._controller = controller
        self._channel: MessageSocket[ToArmProcess, FromArmProcess] | ClosedChannel[ToArmProcess, FromArmProcess] = (
            channel
        )
        self._engine = engine
        self._stop = stop
        self._shared = shared
        self._layout = layout
        self._values = np.zeros(layout.size)
        self._ending_at_s: float | None = None
        # The parent knows it from the start.
        self._problem = arm.problem
        self._stopped_by = ""
        self._awaited: list[tuple[int, SetControllerOutput, float]] = []

    def request_end(self, _signal: int = 0, _frame: FrameType | None = None) -> None:
        """Bring the arm to rest, then end; also a signal handler."""
        if self._ending_at_s is None:
            self._ending_at_s = time.monotonic() + _SHUTDOWN_S

    def run(self) -> None:
        """Run; the arm is at rest at the end, unless its controller is lost."""
        try:
            self._run_periods()
        except ControllerLost as error:
            self._end_lost(error)
        except PeerGone:
            self._come_to_rest()
        except Exception:
            # For any error: nothing else brings the arm of this process to rest.
            self._come_to_rest()
            raise
        finally:
            self._controller.stop()
            # The last heartbeat: since when the arm is at rest.
            self._engine.look(time.monotonic())

    def publish(self) -> None:
        """Write the present state to shared memory."""
        self._layout.write(self._values, self._arm.state())
        self._shared.write(self._values)

    def _end_lost(self, error: ControllerLost) -> None:
        for event in self._arm.abandon(str(error)):
            self._channel.post(event)
        self._channel.post(ControllerGone(reason=str(error), hint=error.hint))

    def _come_to_rest(self) -> None:
        self._channel = ClosedChannel()
        self._engine.engine_is_gone()
        self.request_end()
        try:
            self._run_periods()
        except ControllerLost:
            # Its watchdog stops the arm; nobody is left to hear of it.
            return

    def _run_periods(self) -> None:
        while not self._is_over():
            self._period()

    def _is_over(self) -> bool:
        if self._ending_at_s is None:
            return False
        self._arm.take(StopAll())
        return self._arm.at_rest or time.monotonic() > self._ending_at_s

    def _period(self) -> None:
        for number, command in self._channel.receive():
            self._take(command, number)
        # Before the check of the engine's silence, so that motions report STOP as their cause.
        self._stop.look()
        if self._stop.cut:
            self.request_end()
        # After the commands: their sender has pulsed before.
        self._engine.look(time.monotonic())
        events = self._arm.step()
        # The state is written before an event is sent, so a listener reads the state at the end.
        self.publish()
        self._report_problem()
        self._report_outputs()
        for event in events:
            self._channel.post(event)
        self._channel.flush()

    def _take(self, command: ToArmProcess, number: int) -> None:
        match command:
            case CloseController():
                self.request_end()
            case EnableController():
                self._enable(number)
            case SetControllerOutput():
                self._set_output(command, number)
            case OpenController():
                raise RobotError("the controller is opened once")
            case _:
                self._arm.take(command)

    def _enable(self, number: int) -> None:
        try:
            self._arm.enable()
        except MotionRefused as error:
            self._fail(error, number)
            return
        self.publish()
        self._report_problem()
        self._channel.post(ControllerEnabled(), number=number)

    def _set_output(self, command: SetControllerOutput, number: int) -> None:
        try:
            self._controller.set_output(command.output, on=command.on)
        except MotionRefused as error:
            self._fail(error, number)
            return
        self._awaited.append((number, command, time.monotonic() + _OUTPUT_LIMIT_S))

    def _report_outputs(self) -> None:
        """Answer those who have set an output, once the controller reads it back."""
        if not self._awaited:
            return
        values, now_s, problem = self._arm.outputs, time.monotonic(), self._controller.output_problem
        waiting = self._awaited
        self._awaited = []
        for number, command, limit_s in waiting:
            if command.output < len(values) and values[command.output] == command.on:
                self._channel.post(OutputSet(), number=number)
            elif problem:
                message = f"output {command.output} is not set: {problem}"
                hint = "check cable and controller, and that its script interfaces are open"
                self._channel.post(RequestFailure(message=message, hint=hint), number=number)
            elif now_s > limit_s:
                message = f"output {command.output} reads back as {'off' if command.on else 'on'}"
                hint = "another program may set it, or its use is fixed in the controller's installation"
                self._channel.post(RequestFailure(message=message, hint=hint), number=number)
            else:
                self._awaited.append((number, command, limit_s))

    def _report_problem(self) -> None:
        if self._arm.problem != self._problem:
            self._problem = self._arm.problem
            self._channel.post(MotionProblem(problem=self._problem, hint=self._arm.hint))
        if self._arm.stopped_by != self._stopped_by:
            self._stopped_by = self._arm.stopped_by
            self._channel.post(SafetyState(stopped_by=self._stopped_by))

    def _fail(self, error: ControllerFailure, number: int) -> None:
        self._channel.post(RequestFailure(message=str(error), hint=error.hint), number=number)
