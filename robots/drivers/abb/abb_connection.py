"""The connection to an ABB controller: reads by itself, moves once a person has enabled it, and names each fault."""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Callable
from contextlib import suppress

from engine.cell.drivers import DeviceReport
from engine.errors import RobotError
from robots.drivers.abb.abb_faults import REMEDIES, AbbFault, status_fault
from robots.drivers.abb.abb_motion import MAY_MOVE
from robots.drivers.abb.abb_options import AbbOptions
from robots.drivers.abb.abb_port import AbbPort
from robots.drivers.abb.abb_report import Cause, abb_report, cause_of, fault_named, safety_text
from robots.drivers.abb.gripper_switch import GripperSwitch
from robots.drivers.abb.motion_link import Done, MotionLink
from robots.drivers.abb.rws.rws_inputs import rws_inputs
from robots.drivers.abb.rws.rws_monitor import RwsMonitor
from robots.drivers.abb.simple_message import RobotStatus, TrajectoryPoint
from robots.drivers.abb.state_collector import StateCollector
from robots.drivers.abb.state_transport import STATE_PERIOD_S, AbbReading, StateTransport
from robots.drivers.arm.arm_connection import ControllerFacts
from robots.drivers.fresh_link import FreshLink, FreshReading, LinkTiming
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.model.joint_map import JointMap
from robots.port import InputPort, MotionEnd, MotionReport, OutputPort
from robots.port.heartbeat import ENGINE_SILENCE_S

_REPORT_LIMIT_S = 20.0
_CLOSE_LIMIT_S = 10.0
_FOREIGN_S = 1.0
_READY_S = 10.0
_NOT_ENABLED = "motion is not enabled"
_log = logging.getLogger("flexcell.devices")

AbbLink = FreshLink[AbbReading, None]


class AbbConnection:
    """Implements `robots.drivers.arm.arm_connection.ArmConnection`.

    Args:
        name: The arm, for messages.
        options: Where the controller is, and its times.
        joint_names: Of the model.
        joint_map: From the joints of the model to the axes of the controller.
        about: What a report says of the driver.
        engine_silence_s: Silence of the event loop after which the arm is stopped.
        capture: Captures its connections.
        rws: Its Robot Web Services, not yet connected; None without them.
    """

    def __init__(
        self,
        name: str,
        options: AbbOptions,
        *,
        joint_names: tuple[str, ...],
        joint_map: JointMap,
        about: DeviceReport,
        engine_silence_s: float = ENGINE_SILENCE_S,
        capture: WireCapture = NO_CAPTURE,
        rws: RwsMonitor | None = None,
    ) -> None:
        self._name = name
        self._options = options
        self._about = about
        self._engine_silence_s = engine_silence_s
        self._motion_tap = capture.tap("simple_message_motion")
        self._state = StateTransport(
            options.host,
            options.state_port,
            byte_order=options.byte_order,
            timeout_s=max(3 * STATE_PERIOD_S, options.stale_s / 2.0),
            tap=capture.tap("simple_message_state"),
        )
        gripper = options.gripper
        self._switch = (
            GripperSwitch(options.host, gripper, timeout_s=options.timeout_s, tap=capture.tap("gripper_text"))
            if gripper is not None
            else None
        )
        self._rws = rws
        if rws is not None:
            rws.when_changed(self._rws_changed)
        self._inputs = rws_inputs(rws, lost_reason=lambda: self.lost_reason)
        self._port = AbbPort(
            name,
            joint_names=joint_names,
            joint_map=joint_map,
            min_duration_s=options.min_duration_s,
            max_deviation_rad=options.max_deviation_rad,
            patience_s=options.patience_s,
            has_loads=options.loads == "defined_there",
            blocked=lambda: self.lost_reason or self._problem,
            download=self._download,
            stop=self._stop,
            arm=self._arm,
            panel_speed=lambda: rws.permitted_share if rws is not None else 1.0,
        )
        self._links: tuple[AbbLink, MotionLink] | None = None
        self._problem = "not connected"
        self._lost = ""
        self._fault: AbbFault | None = None
        self._withdrawals = 0
        self._is_vague = False
        self._changed: Callable[[], None] = lambda: None
        self._collector = StateCollector()
        self._readings = 0
        self._safety = ""

    @property
    def port(self) -> AbbPort:
        """Measures and commands the arm."""
        return self._port

    @property
    def outputs(self) -> OutputPort | None:
        """The gripper switch as output 0; None where the options have none."""
        return self._switch

    @property
    def inputs(self) -> InputPort | None:
        """The signals of `rws.inputs`; None without any."""
        return self._inputs

    @property
    def problem(self) -> str:
        """Why the arm may not move at present, by name and with what to do; empty if it may."""
        return self._problem

    @property
    def lost_reason(self) -> str:
        """Why the controller is not read; empty while it is. A stale reading is none."""
        if self._lost or self._links is None:
            return self._lost
        link = self._links[0]
        stale = link.age_s() > self._options.stale_s
        return link.lost_reason or (f"no state message for {link.age_s():.2f} s" if stale else "")

    @property
    def fault(self) -> AbbFault | None:
        """What withdrew the permission to move last; None while the arm may move, and before it was enabled."""
        return self._fault

    def facts(self) -> ControllerFacts:
        """Return what the controller tells; without Robot Web Services no firmware, and no speed."""
        age_s, rws = self._links[0].age_s() if self._links is not None else math.inf, self._rws
        return ControllerFacts(
            readings=self._readings,
            age_s=age_s,
            safety=self._safety,
            firmware=rws.firmware if rws is not None else "",
            speed_scaling=rws.speed_share if rws is not None else None,
        )

    def when_changed(self, callback: Callable[[], None]) -> None:
        """Call `callback`, on the event loop, when `problem` or `lost_reason` changes."""
        self._changed = callback

    async def open(self) -> None:
        """Connect to the state port and return with the first measurement; commands nothing."""
        options = self._options
        link: AbbLink = FreshLink(self._state, self, LinkTiming(period_s=0.001, stale_s=options.stale_s))
        try:
            await link.start()
            if self._rws is not None:
                await self._rws.open()
        except BaseException as error:
            # Also when it is cancelled while connecting: the thread must not outlive this call.
            await link.close()
            if not isinstance(error, RobotError):
                raise
            what = f"the controller does not answer: {error.statement}"
            raise RobotError(what, where=self._name, hint=error.hint) from error
        motion = MotionLink(
            options.host,
            options.motion_port,
            self,
            byte_order=options.byte_order,
            timeout_s=options.timeout_s,
            silence_s=self._engine_silence_s,
            tap=self._motion_tap,
        )
        self._links = (link, motion)
        self._set_problem(_NOT_ENABLED)

    async def enable(self) -> None:
        """Connect the motion port, and the gripper's, and permit motion.

        The stop request that tests the motion server also clears a path that the controller may still have. With
        Robot Web Services it then switches the motors on and starts the program at main, as far as that is needed.
        Tool, payload and limits are those of the controller.
        """
        link, motion = self._opened()
        if self._port.motion is not None:
            raise RobotError("a motion is active", where=self._name, hint="wait for its end, or cancel it")
        rws = self._rws if self._rws is not None and not self._rws.lost_reason else None
        if rws is not None:
            await rws.require_recoverable()
        self._require_rest(link.fresh().status, recoverable=rws is not None)
        # An arm that may move already may not while its motion port is replaced, nor if that fails.
        self._set_problem(self._problem or _NOT_ENABLED)
        withdrawals = self._withdrawals
        await motion.connect()
        if rws is not None:
            await rws.recover()
            await self._recovered(link)
        if self._switch is not None:
            await asyncio.to_thread(self._switch.connect)
        self._require_rest(link.fresh().status)
        if self._withdrawals != withdrawals:
            raise RobotError(self._problem, where=self._name)
        self._fault, self._is_vague = None, False
        self._set_problem("")

    async def report(self, *, readings: int) -> DeviceReport:
        """Wait for this many state messages and return what they say; there is no round trip, as nobody asks."""
        link, _ = self._opened()
        try:
            collected = await self._collector.collect(readings, limit_s=_REPORT_LIMIT_S)
        except TimeoutError:
            raise RobotError(
                f"fewer than {readings} state messages within {_REPORT_LIMIT_S:g} s",
                where=self._name,
                hint=self._state.remedy,
            ) from None
        link.fresh()
        return abb_report(self._about, collected, rws=self._rws)

    async def close(self) -> None:
        """Bring the arm to rest, if the link allows it, and disconnect."""
        if self._links is None:
            return
        link, motion_link = self._links
        motion = self._port.motion
        try:
            if motion is not None and not self._lost:
                motion.cancel()
                async with asyncio.timeout(_CLOSE_LIMIT_S):
                    await motion.report()
        except TimeoutError:
            raise RobotError(f"rest was not confirmed; {MAY_MOVE}", where=self._name) from None
        finally:
            self._links = None
            await motion_link.close()
            await link.close()
            if self._rws is not None:
                await self._rws.close()
            if self._switch is not None:
                self._switch.close("disconnected")

    def read(self, reading: FreshReading[AbbReading]) -> None:
        """Apply a reading: follow the motion, and note what forbids one."""
        self._readings += 1
        motion = self._port.motion
        self._port.take(reading)
        self._judge(reading)
        self._note_safety(reading.value.status)
        if motion is not None and not self._problem:
            self._judge_end(motion.result)
        self._collector.take(reading)

    def lost(self, reason: str) -> None:
        """Request a stop while the motion port lives, and say that nobody sees whether the robot obeys."""
        self._lost = f"{self._name} at {self._state.address}: {reason}"
        moving = self._port.motion is not None
        if moving and self._links is not None:
            self._links[1].stop().add_done_callback(lambda sent: sent.exception())
        detail = f"{reason}; {MAY_MOVE}" if moving else reason
        self._port.fail(detail, at_rest=False)
        self._forbid(fault_named(reason), "the connection was lost, and motion was not enabled since")
        self._changed()

    def found(self) -> None:
        """Note that readings are back, and nothing else."""
        self._lost = ""
        _log.warning("%s reads again; it may not move: %s", self._name, self._problem)
        self._changed()

    def motion_link_lost(self, reason: str) -> None:
        """Fail the motion, and try once to request a stop over a new connection."""
        fault = fault_named(reason)
        if self._port.may_move and self._links is not None:
            self._links[1].connect().add_done_callback(self._note_late_stop)
        if self._port.motion is not None:
            self._port.fail(f"{reason}; {MAY_MOVE}", at_rest=False)
        self._forbid(fault, f"the motion port is lost: {reason}")

    def stopped_by_silence(self, silent_s: float) -> None:
        """Note that the arm was stopped because nobody could have noticed a STOP."""
        if self._port.motion is not None:
            self._port.motion.note_stop(f"{AbbFault.ENGINE_SILENT.value} for {silent_s:.2f} s; the arm was stopped")

    def _note_late_stop(self, sent: Done) -> None:
        error = sent.exception()
        if error is None:
            _log.warning("%s: a stop was requested over a new connection", self._name)
        else:
            _log.error("%s: no stop request arrives (%s); %s", self._name, error, MAY_MOVE)

    def _judge(self, reading: FreshReading[AbbReading]) -> None:
        """Find out whether the arm may still move; a fault withdraws the path that the controller has."""
        status, motion = reading.value.status, self._port.motion
        fault = cause_of(status, self._rws)
        if fault is not None:
            is_vague = self._rws is not None and not self._problem and self._rws.fault != fault
            self._withdraw(fault)
            if is_vague and self._rws is not None:
                self._is_vague = True
                self._rws.read_now()
        elif (
            status.in_motion
            and motion is None
            and not self._problem
            and reading.asked_s - self._port.idle_since_s > _FOREIGN_S
        ):
            self._forbid(AbbFault.FOREIGN_MOTION, "the arm moves, and not by our command")

    def _withdraw(self, fault: Cause) -> None:
        """Stop the motion, and withdraw the permission and the path, for what the controller says of itself."""
        motion = self._port.motion
        if motion is not None:
            motion.abort(f"{fault[0].value}: {fault[1]}")
        elif not self._problem:
            # The controller would go on with a path that it still has when it is switched on again.
            self._stop().add_done_callback(lambda sent: sent.exception())
        if not self._problem:
            self._forbid(fault[0], fault[1])

    def _rws_changed(self) -> None:
        """Withdraw the permission for a cause that Robot Web Services tell, or name the one that is known better."""
        fault = self._rws.fault if self._rws is not None else None
        if self._links is None or self._links[0].latest is None:
            return
        self._note_safety(self._links[0].latest.value.status)
        if fault is None:
            return
        if self._is_vague and self._problem:
            self._is_vague = False
            if self._port.motion is not None:
                self._port.motion.explain(f"{fault[0].value}: {fault[1]}")
            self._forbid(fault[0], fault[1])
        elif not self._problem:
            self._withdraw(fault)

    def _note_safety(self, status: RobotStatus) -> None:
        safety = safety_text(status, self._rws)
        if safety != self._safety:
            self._safety = safety
            self._changed()

    async def _recovered(self, link: AbbLink) -> None:
        """Return once the state messages agree that the controller can move, or when they should long have."""
        with suppress(TimeoutError):
            async with asyncio.timeout(_READY_S):
                while status_fault(link.fresh().status) is not None:
                    await self._collector.collect(1, limit_s=_READY_S)

    def _judge_end(self, result: MotionReport | None) -> None:
        """Withdraw the permission where the controller did not do what it was asked."""
        if result is None or result.end is not MotionEnd.FAILED:
            return
        for fault in (AbbFault.OFF_THE_PATH, AbbFault.NOT_AT_TARGET):
            if result.reason.startswith(fault.value):
                self._forbid(fault, result.reason.removeprefix(f"{fault.value}: "))

    def _require_rest(self, status: RobotStatus, *, recoverable: bool = False) -> None:
        fault = status_fault(status) if not recoverable else None
        if fault is None and status.in_motion:
            fault = (AbbFault.FOREIGN_MOTION, "the arm moves; it has to be at rest")
        if fault is not None:
            raise RobotError(
                f"the arm cannot be enabled: {fault[0].value}: {fault[1]}", where=self._name, hint=REMEDIES[fault[0]]
            )

    def _forbid(self, fault: AbbFault, detail: str) -> None:
        self._fault = fault
        self._is_vague = False
        self._withdrawals += 1
        if self._switch is not None:
            self._switch.close(f"{fault.value}, and motion was not enabled since")
        text = detail if detail.startswith(("the connection", "the motion port")) else f"{fault.value}: {detail}"
        self._set_problem(f"{text} ({REMEDIES[fault]}, then enable motion)")

    def _set_problem(self, problem: str) -> None:
        if problem == self._problem:
            return
        self._problem = problem
        if problem and problem != _NOT_ENABLED:
            _log.error("%s may not move: %s", self._name, problem)
        self._changed()

    def _download(self, points: list[TrajectoryPoint]) -> Done:
        return self._opened()[1].download(points)

    def _stop(self) -> Done:
        return self._opened()[1].stop()

    def _arm(self, *, armed: bool) -> None:
        if self._links is not None:
            self._links[1].arm(armed=armed)

    def _opened(self) -> tuple[AbbLink, MotionLink]:
        if self._links is None:
            raise RobotError("the controller is not connected", where=self._name)
        return self._links
