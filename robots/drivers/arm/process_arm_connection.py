"""The connection to a real arm whose controller has a control process: starts it, commands it, and replaces it."""

from __future__ import annotations

import asyncio
import os
import socket
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress

from msgspec.structs import replace

from engine.cell.drivers import DeviceReport, RoundTrip
from engine.errors import CONNECT_AGAIN, FlexcellError, RobotError
from robots.control.commanding.arm_commands import ArmCommand, ConfigureArm, MotionCommand
from robots.control.commanding.commanded_arm_port import CommandedArmPort
from robots.control.commanding.motion_registry import MotionRegistry
from robots.control.motion_event import AnyMotionEvent, SetPointJumped
from robots.control.set_point_watch import report_jump
from robots.drivers.arm.arm_connection import NORMAL, ControllerFacts
from robots.drivers.arm.arm_process_messages import (
    CloseController,
    ControllerEnabled,
    ControllerGone,
    ControllerOpened,
    EnableController,
    FromArmProcess,
    MotionProblem,
    OpenController,
    SafetyState,
    ToArmProcess,
)
from robots.drivers.arm.arm_state_layout import ArmProcessState, ArmStateLayout
from robots.drivers.arm.controller_inputs import ControllerInputs
from robots.drivers.arm.controller_loop import ENABLE_HINT, NOT_ENABLED
from robots.drivers.arm.controller_outputs import ControllerOutputs
from robots.io.worker_process import WorkerProcess
from robots.model.robot_model import RobotModel
from robots.port import ArmSample
from robots.port.heartbeat import Heartbeat, new_heartbeat_file
from robots.port.loop_heartbeat import LoopHeartbeat
from robots.port.shared_file import new_shared_file
from robots.port.shared_numbers import SharedNumbers

_START = "from robots.drivers.arm.arm_process_main import main; main()"
_START_LIMIT_S = 180.0
_ENABLE_LIMIT_S = 20.0
_END_S = 6.0
_EXIT_S = 0.3
_RETRY_S = 0.5
_READING_PERIOD_S = 0.02
_LOST = "the connection was lost, and motion was not permitted since"

NewStopLine = Callable[[str], socket.socket]
_Process = WorkerProcess[ToArmProcess, FromArmProcess]


class ProcessArmConnection:
    """Implements `robots.drivers.arm.arm_connection.ArmConnection`.

    A process is never repaired: after a loss another one is started, which only reads.

    Args:
        request: What the process is asked to open.
        model: The arm.
        address: Of the controller, for messages.
        about: What a report says of the driver.
        silence_s: How long the process may be silent until it is ended.
        new_stop_line: Makes the line on which the process receives STOP; None without one.
        stop_past_process: Stops the arm on a path that the process has no part in, within a second; called in a thread
            when the process of an arm that may move is lost.
        outputs: Digital outputs of its controller; None for as many as the model has.
    """

    def __init__(
        self,
        request: OpenController,
        *,
        model: RobotModel,
        address: str,
        about: DeviceReport,
        silence_s: float,
        new_stop_line: NewStopLine | None,
        stop_past_process: Callable[[], object] = lambda: None,
        outputs: int | None = None,
    ) -> None:
        self._request = request
        self._address = address
        self._about = about
        self._silence_s = silence_s
        self._new_stop_line = new_stop_line
        self._stop_past_process = stop_past_process
        self._name = name = request.arm.name
        self._layout = ArmStateLayout(model.dof)
        self._process: _Process | None = None
        self._shared: SharedNumbers | None = None
        self._heartbeat: Heartbeat | None = None
        self._pulse: LoopHeartbeat | None = None
        self._opened: ControllerOpened | None = None
        self._recovery: asyncio.Task[None] | None = None
        self._closing = asyncio.Event()
        self._enabling = asyncio.Lock()
        self._gone: ControllerGone | None = None
        self._changed: Callable[[], None] = lambda: None
        self._lost_reason = ""
        self._stopped_by = ""
        self._board = MotionRegistry(on_lost=lambda _reason: None, at_rest_when_lost=False)
        self._port = CommandedArmPort(
            self,
            self._board,
            arm=name,
            joints=model.arm_joints,
            limits=model.limits,
            has_settings=lambda settings: bool(self.problem) or self.state().has_settings(settings),
        )
        self._outputs = ControllerOutputs(
            name,
            count=model.digital_outputs if outputs is None else outputs,
            values=lambda: self.state().outputs,
            ask=self._request_answer,
        )
        self._inputs = ControllerInputs(
            count=model.digital_inputs, values=lambda: self.state().inputs, lost_reason=lambda: self._lost_reason
        )
        self._forbid(NOT_ENABLED, ENABLE_HINT)

    @property
    def port(self) -> CommandedArmPort:
        """Measures and commands the arm."""
        return self._port

    @property
    def outputs(self) -> ControllerOutputs | None:
        """The digital outputs of its controller, read back; None without any."""
        return self._outputs if self._outputs.count else None

    @property
    def inputs(self) -> ControllerInputs | None:
        """The digital inputs of its controller; None without any."""
        return self._inputs if self._inputs.count else None

    @property
    def problem(self) -> str:
        """Why the arm may not move at present; empty if it may."""
        return self._lost_reason or self._board.closed_reason

    @property
    def lost_reason(self) -> str:
        """Why the connection is lost; empty while it is connected."""
        return self._lost_reason

    @property
    def process_id(self) -> int:
        """The id of the control process, 0 while there is none."""
        return self._process.pid if self._process is not None else 0

    def facts(self) -> ControllerFacts:
        """Return what the controller says of itself; the last of it after a loss."""
        state, opened = self.state(), self._opened
        return ControllerFacts(
            readings=state.readings,
            age_s=time.monotonic() - state.read_at_s,
            firmware=opened.identity.firmware if opened is not None else "",
            safety=self._stopped_by or NORMAL,
            speed_scaling=state.speed_scaling,
        )

    def when_changed(self, callback: Callable[[], None]) -> None:
        """Call `callback` when `problem`, `lost_reason` or `safety` of the facts changes."""
        self._changed = callback

    def state(self) -> ArmProcessState:
        """Return the latest state; the last one after a loss."""
        if self._shared is None:
            raise RobotError("the arm is not connected", where=self._name)
        return self._layout.read(self._shared.read())

    def sample(self) -> ArmSample:
        """Return the latest measurement; the last one after a loss."""
        return self.state().sample

    def progress(self, motion: int) -> float | None:
        """Return the progress of a motion; None if the arm does not execute this motion."""
        state = self.state()
        return state.progress if state.motion == motion else None

    def send(self, command: ArmCommand | MotionCommand) -> None:
        """Send a command; raises RobotError when the process is lost."""
        self._live().send(command)

    async def open(self) -> None:
        """Connect and return with the first measurement; raises RobotError with the cause."""
        self._closing.clear()
        await self._start()

    async def enable(self) -> None:
        """Permit motion; raises RobotError with the cause."""
        async with self._enabling:
            await self._enable()

    async def _enable(self) -> None:
        if self._lost_reason:
            raise RobotError(self._lost_reason, where=self._address, hint=CONNECT_AGAIN)
        process = self._live()
        # The client library waits for seconds, and holds back the heartbeats meanwhile.
        self._end_pulse()
        try:
            answer = await self._answer(process, EnableController(), limit_s=_ENABLE_LIMIT_S, hung="enabling hangs: ")
        finally:
            if process is self._process and not process.lost_reason:
                self._begin_pulse()
        assert isinstance(answer, ControllerEnabled)
        # The process says before its answer that motion is permitted; a stop since then counts.
        if self.problem:
            raise RobotError(self.problem, where=self._address)

    async def report(self, *, readings: int) -> DeviceReport:
        """Read this many times and return what the controller says."""
        times_s: list[float] = []
        last = self.state()
        while len(times_s) < readings:
            await asyncio.sleep(_READING_PERIOD_S)
            if self._lost_reason:
                raise RobotError(self._lost_reason, where=self._address)
            state = self.state()
            if state.readings > last.readings:
                times_s.append((state.read_at_s - last.read_at_s) / (state.readings - last.readings))
                last = state
        opened = self._opened
        joints = zip(self._port.joint_names, last.sample.position_rad.tolist(), strict=True)
        return replace(
            self._about,
            state="; ".join(dict.fromkeys(each for each in (self._stopped_by, self.problem) if each)) or "enabled",
            fault="" if self.problem in {"", NOT_ENABLED} else self.problem,
            firmware=opened.identity.firmware if opened is not None else "",
            readings={f"{name}_rad": value for name, value in joints} | {"speed_scaling": last.speed_scaling},
            inputs=last.inputs[: self._inputs.count],
            outputs=last.outputs[: self._outputs.count],
            round_trip=RoundTrip.of(times_s),
        )

    async def close(self) -> None:
        """Bring the arm to rest and end the process."""
        self._closing.set()
        recovery, self._recovery = self._recovery, None
        if recovery is not None:
            await asyncio.wait((recovery,))
        process, self._process = self._process, None
        if process is None:
            return
        try:
            process.end_reason = "the connection was closed"
            if not process.lost_reason:
                # The pulses go on until it has ended, so that the arm brakes as a cancelled motion does.
                process.send(CloseController())
                await process.wait_closed(_END_S)
        finally:
            # Even if this is cancelled while it waits, no process may be left behind.
            self._end_pulse()
            process.end(grace_s=_EXIT_S)

    async def _start(self) -> None:
        with ExitStack() as ours:
            state_fd = new_shared_file("flexcell-arm")
            ours.callback(os.close, state_fd)
            heartbeat_fd = new_heartbeat_file()
            ours.callback(os.close, heartbeat_fd)
            descriptors = [state_fd, heartbeat_fd]
            if self._new_stop_line is not None:
                descriptors.append(ours.enter_context(self._new_stop_line(self._name)).fileno())
            await self._start_process(descriptors)

    async def _start_process(self, descriptors: Sequence[int]) -> None:
        """Start a process on descriptors of state, heartbeat and, optionally, stop line."""
        self._gone, self._stopped_by = None, ""
        process = _Process(
            _START,
            FromArmProcess,
            what=f"the control process of {self._name}",
            hint=CONNECT_AGAIN,
            on_notice=self._notice,
            on_lost=lambda reason: self._handle_loss(process, reason),
        )
        try:
            await process.start(*descriptors)
            answer = await self._answer(process, self._request, limit_s=_START_LIMIT_S)
            assert isinstance(answer, ControllerOpened)
            self._opened = answer
            self._shared = SharedNumbers(descriptors[0], self._layout.size)
            # Read once, so that a consistent state exists if the process dies in mid-write.
            self._shared.read()
            self._heartbeat = Heartbeat(descriptors[1])
            self._process = process
            self._begin_pulse()
            process.send(ConfigureArm(arm=self._name, settings=self._port.settings))
        except BaseException:
            # On any error, cancellation included, no process may be left behind.
            self._process = None
            self._end_pulse()
            process.end()
            raise

    async def _answer(
        self, process: _Process, request: ToArmProcess, *, limit_s: float, hung: str = ""
    ) -> FromArmProcess:
        """Return the answer to a request; raises RobotError with the cause, which begins with `hung` without one."""
        try:
            async with asyncio.timeout(limit_s):
                return await asyncio.shield(process.ask(request).answer)
        except TimeoutError as error:
            process.kill(
                f"{hung}the control process of {self._name} did not answer within {limit_s:g} s, and was killed"
            )
            raise RobotError(process.lost_reason, where=self._address, hint=CONNECT_AGAIN) from error
        except FlexcellError as error:
            message = self._gone.reason if self._gone is not None else error.message
            raise RobotError(message, where=self._address, hint=error.hint) from error

    async def _request_answer(self, request: ToArmProcess) -> FromArmProcess:
        return await self._answer(self._live(), request, limit_s=_ENABLE_LIMIT_S)

    def _notice(self, message: FromArmProcess) -> None:
        match message:
            case MotionProblem():
                if message.problem:
                    self._forbid(message.problem, message.hint)
                else:
                    self._permit()
            case SafetyState():
                self._stopped_by = message.stopped_by
                self._changed()
            case ControllerGone():
                self._gone = message
            case _ if isinstance(message, AnyMotionEvent):
                if isinstance(message, SetPointJumped):
                    report_jump(message)
                self._board.happened(message)
            case _:
                pass

    def _handle_loss(self, process: _Process, reason: str) -> None:
        """Fail the motion, whose end nobody sees, and read again as soon as that is possible."""
        if process is not self._process or self._closing.is_set():
            return
        gone = self._gone
        cause = gone.reason if gone is not None else reason
        self._end_pulse()
        self._process = None
        self._lost_reason = f"{self._name} at {self._address}: {cause}"
        self._board.lost(self._lost_reason)
        was_enabled = not self._board.closed_reason
        self._forbid(_LOST, ENABLE_HINT)
        self._recovery = asyncio.get_running_loop().create_task(
            self._recover(process, stop_first=was_enabled), name=f"reading {self._name} again"
        )

    async def _recover(self, lost: _Process, *, stop_first: bool) -> None:
        """Stop the arm by the second path, then read again as soon as that is possible; motion stays forbidden."""
        if stop_first:
            await asyncio.to_thread(self._stop_past_process)
        lost.end(grace_s=_EXIT_S)
        while not self._closing.is_set():
            attempt = asyncio.create_task(self._start())
            closing = asyncio.create_task(self._closing.wait())
            await asyncio.wait({attempt, closing}, return_when=asyncio.FIRST_COMPLETED)
            closing.cancel()
            if not attempt.done():
                attempt.cancel()
            # Also without free descriptors: the arm is read again once there are some.
            with suppress(RobotError, OSError, asyncio.CancelledError):
                await attempt
                self._lost_reason = ""
                self._board.found()
                self._changed()
                return
            with suppress(TimeoutError):
                await asyncio.wait_for(self._closing.wait(), _RETRY_S)

    def _begin_pulse(self) -> None:
        self._end_pulse()
        if self._heartbeat is not None:
            self._pulse = LoopHeartbeat(self._heartbeat, limit_s=self._silence_s, on_silence=self._end_silent)
            self._pulse.begin()

    def _end_pulse(self) -> None:
        pulse, self._pulse = self._pulse, None
        if pulse is not None:
            pulse.end()

    def _end_silent(self, silent_s: float) -> None:
        """Kill a process whose loop stands still, so that its end is certain; the watchdog stops the arm."""
        if self._process is not None:
            self._process.kill(
                f"process silent: the control process of {self._name} has not run for {silent_s:.1f} s, and was killed"
            )

    def _live(self) -> _Process:
        """Return the process for a message to it; raises RobotError when it is lost."""
        if self._process is None:
            raise RobotError(self._lost_reason or "the arm is not connected", where=self._name, hint=CONNECT_AGAIN)
        if self._pulse is not None:
            self._pulse.pulse()
        return self._process

    def _forbid(self, problem: str, hint: str) -> None:
        self._board.closed_reason, self._board.closed_hint = problem, hint
        self._changed()

    def _permit(self) -> None:
        self._board.closed_reason = ""
        self._changed()
