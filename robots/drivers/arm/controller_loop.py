"""The control loop of a real arm: the motions of a simulated one, and set points instead of torques."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from dataclasses import replace as replace_fields

import numpy as np
from msgspec.structs import replace

from engine.skills.arm_control import ControlSettings
from robots.control.arm_control_loop import ArmControlLoop
from robots.control.commanding.arm_command_handler import ArmCommandHandler
from robots.control.commanding.arm_commands import (
    ArmCommand,
    CancelMotion,
    ConfigureArm,
    FollowTrajectory,
    HoldMotion,
    MotionCommand,
    ResumeMotion,
    StartGuiding,
    StartStream,
    StopAll,
    TrackForce,
)
from robots.control.motion_event import AnyMotionEvent, MotionFinished
from robots.drivers.arm.arm_state_layout import NO_TOOL, ArmProcessState, tool_numbers
from robots.drivers.arm.joint_controller import ControllerLost, ControllerReading, JointController, MotionRefused
from robots.drivers.arm.reading_check import invalid_value
from robots.drivers.arm.sent_set_point import SentSetPoint
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.port import ArmSample, Array, MotionEnd, MotionReport

_REST_RAD_S = 0.01
_STEP_S = 0.001
_STILL_MOVING_AFTER_S = 3.0
# Measured joints differ by their noise from one reading to the next.
_MOVED_RAD = 1e-4
# A brake that is released lets an arm sag a little.
_ENABLED_NEAR_RAD = 0.1
_ENABLED_READINGS = 5
NOT_ENABLED = "motion is not enabled"
_INVALID_HINT = "check the versions of controller and client library; only reading is restored by itself"
ENABLE_HINT = "look at the arm, then permit motion: `flexcell run --enable REASON`, or the skill enable_device"


@dataclass(kw_only=True)
class _Interruption:
    """A motion that the controller has ended, until the arm is measured at rest."""

    motion: int
    progress: float
    cause: str
    since_s: float


class ControllerLoop:
    """Implements `robots.port.control_process.ControlledDevices` for one arm.

    A set point is sent for each measurement: an arm that is measured late moves slower on its path, and never
    makes up for lost time, unless its controller has gone on by itself meanwhile.

    Args:
        name: Name of the arm.
        model: Its model.
        base: Pose of its base link in the world.
        controller: Connected; used by this loop only.
        gravity_m_s2: Gravity in the world, (3,).
        stale_s: How long the controller may say nothing new.
        clock: The monotonic clock.
    """

    def __init__(
        self,
        *,
        name: str,
        model: RobotModel,
        base: RigidTransform,
        controller: JointController,
        gravity_m_s2: Array,
        stale_s: float,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._name = name
        self._joints = model.arm_joints
        self._base = base
        self._controller = controller
        # Set points change by the limits of the arm in steps of a millisecond, as in simulation; the last is sent.
        self._set_points = max(1, round(controller.period_s / _STEP_S))
        self._stale_s = stale_s
        self._clock = clock
        kinematics = ArmKinematics(model, base=base)
        self._tool_link = kinematics.tool_link_at_flange()
        self.control = control = ArmControlLoop(
            name=name,
            kinematics=kinematics,
            gravity_m_s2=gravity_m_s2,
            touching=lambda: "",
            on_jump="stop",
        )
        self._commands = ArmCommandHandler(control, model=model, measured_rad=lambda: control.state.position)
        self._settings = ControlSettings()
        self._wants_tool = False
        self._tool = NO_TOOL
        self._unreported: list[AnyMotionEvent] = []
        self._interruption: _Interruption | None = None
        self._sent = SentSetPoint(model.arm_joints, model.limits.velocity_rad_s)
        self._reading: ControllerReading | None = None
        self._read_at_s = clock()
        self.readings = 0
        self.problem, self.hint = NOT_ENABLED, ENABLE_HINT

    @property
    def outputs(self) -> tuple[bool, ...]:
        """The digital outputs as the controller reads them back."""
        return self._reading.outputs if self._reading is not None else ()

    @property
    def stopped_by(self) -> str:
        """Why the controller does not move, by name; empty while it can."""
        return self._reading.stopped_by if self._reading is not None else ""

    @property
    def at_rest(self) -> bool:
        """Whether no motion is active and the last measured speeds are at rest."""
        if self.control.motion.number or self._unreported or self._interruption is not None:
            return False
        return not self.control.has_unreported_end and self._is_resting

    @property
    def _is_resting(self) -> bool:
        return bool((np.abs(self.control.state.velocity) < _REST_RAD_S).all())

    def brake(self, cause: str) -> None:
        """Bring the motion to rest within its limits; it ends as FAILED with `cause`."""
        self.control.motion.stop(f"{cause}; {self._name} came to rest by itself")

    def take(self, command: ArmCommand | MotionCommand) -> None:
        """Apply a command from the next period on; a motion that may not start ends with the cause."""
        motion = self.control.motion
        match command:
            case HoldMotion():
                motion.hold(command.motion, request=command.request)
            case ResumeMotion():
                motion.resume(command.motion, request=command.request)
            case CancelMotion():
                motion.cancel(command.motion)
            case StopAll():
                motion.stop()
            case StartGuiding():
                self._refuse(command.motion, "the controller is not guided by hand over this driver")
            case FollowTrajectory() | TrackForce() | StartStream() if self.problem:
                self._refuse(command.motion, self.problem)
            case ConfigureArm():
                self._configure(command.settings)
            case _:
                self._commands.take(command)

    def enable(self) -> None:
        """Permit motion from the measured position on.

        Raises:
            MotionRefused: the controller cannot move, or the arm is not at rest.
            ControllerLost: it does not answer.
        """
        # Holding the measured position would drop an active motion without its end, and jerk a moving arm.
        if self.control.motion.number or self._interruption is not None:
            raise MotionRefused("a motion is active", hint="wait for its end, or cancel it")
        if not self._is_resting:
            raise MotionRefused("the arm moves, and not by our command", hint="bring it to rest, then enable it")
        try:
            reading = self._set_tool()
        except MotionRefused as error:
            # Where motion was permitted before: its tool may be half set, or its program gone.
            if not self.problem:
                self._interrupt(str(error), error.hint)
                self._controller.stop()
            raise
        # A controller that holds a set point gets this one again: the measured joints are a jump away from it.
        start_rad = reading.position_rad if reading.held_rad is None else reading.held_rad
        self._begin_at(start_rad)
        self.problem = self.hint = ""

    def step(self) -> list[AnyMotionEvent]:
        """Wait for the next measurement, advance the set point, send it, and return the events.

        Raises:
            ControllerLost: the controller cannot be reached, or was silent for too long.
        """
        events, self._unreported = self._unreported, []
        reading = self._read()
        if reading is None:
            return events
        control, step_s = self.control, self._controller.period_s * reading.periods
        steps = self._set_points * reading.periods
        control.motion.controller_pace = min(1.0, max(0.0, reading.speed_scaling))
        control.measure(
            reading.position_rad, reading.velocity_rad_s, wrench=self._world_wrench(reading.wrench), step_s=step_s
        )
        if reading.stopped_by and not self.problem:
            self._interrupt(reading.stopped_by, reading.remedy)
        if self.problem:
            self._follow_measured(reading.position_rad)
            return [*events, *self._end_interrupted()]
        for _ in range(steps):
            events.extend(control.advance(step_s / steps))
        try:
            self._command(step_s)
            if self._wants_tool and not control.motion.number:
                held_rad = self._set_tool().held_rad
                if held_rad is not None:
                    self._begin_at(held_rad)
        except MotionRefused as error:
            self._interrupt(str(error), error.hint)
            self._controller.stop()
        return events

    def _begin_at(self, position_rad: Array) -> None:
        self.control.initialize(position_rad, reflex=self.control.reflex)
        self._sent.forget()

    def _command(self, step_s: float) -> None:
        """Send the set point; raises MotionRefused where no motion leads there from the last one."""
        motion = self.control.motion
        self._sent.require_next(motion.position, step_s=step_s)
        self._controller.command(motion.position, motion.velocity)
        self._sent.note(motion.position)

    def state(self) -> ArmProcessState:
        """Return the present state; something was measured."""
        control, reading = self.control, self._reading
        assert reading is not None
        sample = ArmSample(
            time_s=reading.time_s,
            position_rad=control.state.position,
            velocity_rad_s=control.state.velocity,
            effort_nm=reading.effort_nm,
            desired_rad=control.motion.position,
            external_nm=control.state.external_nm,
            wrench=control.state.wrench,
            reflex=control.reflex,
        )
        return ArmProcessState(
            sample=sample,
            motion=control.motion.number,
            progress=control.motion.progress,
            speed_scaling=reading.speed_scaling,
            outputs=reading.outputs,
            inputs=reading.inputs,
            read_at_s=self._read_at_s,
            readings=self.readings,
            tool=self._tool,
        )

    def abandon(self, cause: str) -> list[AnyMotionEvent]:
        """Return the end of the motion of a controller that is lost; the arm may still be moving."""
        motion = self.control.motion
        interrupted = self._interruption
        number, progress = (
            (interrupted.motion, interrupted.progress) if interrupted is not None else (motion.number, motion.progress)
        )
        if not number:
            return []
        self.control.initialize(self.control.state.position)
        self._interruption = None
        return [_failure(number, f"{cause}; {self._name} may still be moving", progress=progress, at_rest=False)]

    def _read(self) -> ControllerReading | None:
        reading, now_s = self._controller.read(), self._clock()
        if reading is None:
            silent_s = now_s - self._read_at_s
            if silent_s > self._stale_s:
                raise ControllerLost(
                    f"controller silent: it has said nothing new for {silent_s:.2f} s",
                    hint="check the controller; only reading is restored by itself",
                )
            return None
        # Before anybody sees it: client libraries check nothing.
        problem = invalid_value(reading, self._joints)
        if problem:
            raise ControllerLost(f"invalid reading of {self._name}: {problem}", hint=_INVALID_HINT)
        self._reading, self._read_at_s = reading, now_s
        self.readings += 1
        return reading

    def _await_reading(self) -> ControllerReading:
        """Return the first reading after a long call."""
        self._read_at_s = self._clock()
        while True:
            reading = self._read()
            if reading is not None:
                return reading

    def _settled_reading(self) -> ControllerReading:
        """Return the newest of some readings with the median of their joints: one that is wrong counts nothing."""
        readings = [self._await_reading() for _ in range(_ENABLED_READINGS)]
        held = [each.held_rad for each in readings if each.held_rad is not None]
        return replace_fields(
            readings[-1],
            position_rad=np.median([each.position_rad for each in readings], axis=0),
            held_rad=np.median(held, axis=0) if len(held) == len(readings) else None,
        )

    def read_first(self) -> None:
        """Wait for the first measurement and hold it as the set point; raises ControllerLost."""
        reading = self._await_reading()
        self.control.measure(
            reading.position_rad,
            reading.velocity_rad_s,
            wrench=self._world_wrench(reading.wrench),
            step_s=self._controller.period_s,
        )
        self.control.initialize(reading.position_rad)

    def _configure(self, settings: ControlSettings) -> None:
        before, self._settings = self._settings, settings
        # The controller subtracts the load from the forces that it measures.
        self.control.configure(replace(settings, load_kg=0.0, load_com_m=(0.0, 0.0, 0.0)))
        tool = (settings.tool_xyz_m, settings.load_kg, settings.load_com_m)
        if tool != (before.tool_xyz_m, before.load_kg, before.load_com_m):
            self._wants_tool = True

    def _set_tool(self) -> ControllerReading:
        """Set tool and load at rest, and return the median of the readings after it; raises MotionRefused."""
        self._wants_tool, self._tool = False, NO_TOOL
        settings, before_rad = self._settings, self.control.state.position.copy()
        self._controller.enable(
            tcp_xyz_m=self._at_flange(settings.tool_xyz_m),
            load_kg=settings.load_kg,
            load_com_m=self._at_flange(settings.load_com_m),
        )
        reading = self._settled_reading()
        if reading.stopped_by:
            raise MotionRefused(reading.stopped_by, hint=reading.remedy)
        # Motion begins where it says: what cannot be would have the arm go there.
        off_rad = np.abs(reading.position_rad - before_rad)
        joint = int(off_rad.argmax())
        if not off_rad[joint] < _ENABLED_NEAR_RAD:
            raise MotionRefused(
                f"{self._joints[joint]} is measured {off_rad[joint]:.3g} rad from where it rested before",
                hint="look at the arm and its controller, then enable it again",
            )
        self._tool = tool_numbers(settings)
        return reading

    def _interrupt(self, cause: str, hint: str) -> None:
        """Note that the controller has stopped by itself, or takes no set points: motion has to be enabled again."""
        motion = self.control.motion
        if motion.number:
            self._interruption = _Interruption(
                motion=motion.number, progress=motion.progress, cause=cause, since_s=self._clock()
            )
        self.control.initialize(self.control.state.position)
        self.problem, self.hint = cause, hint or ENABLE_HINT

    def _end_interrupted(self) -> list[AnyMotionEvent]:
        interrupted = self._interruption
        if interrupted is None:
            return []
        is_late = self._clock() - interrupted.since_s > _STILL_MOVING_AFTER_S
        if not self._is_resting and not is_late:
            return []
        self._interruption = None
        at_rest = self._is_resting
        reason = interrupted.cause if at_rest else f"{interrupted.cause}; the arm does not come to rest"
        return [_failure(interrupted.motion, reason, progress=interrupted.progress, at_rest=at_rest)]

    def _follow_measured(self, position_rad: Array) -> None:
        control = self.control
        if (np.abs(control.motion.position - position_rad) > _MOVED_RAD).any():
            control.motion.initialize(position_rad)
            control.watch.restart(position_rad)

    def _refuse(self, motion: int, reason: str) -> None:
        self._unreported.append(_failure(motion, reason, progress=0.0, at_rest=True))

    def _world_wrench(self, wrench: Array | None) -> Array:
        if wrench is None:
            return np.zeros(6)
        rotation = self._base.rotation
        return np.concatenate((rotation @ wrench[:3], rotation @ wrench[3:]))

    def _at_flange(self, point_m: tuple[float, float, float]) -> Array:
        """Return a point of the tool link in the axes of the flange."""
        return self._tool_link.xyz + self._tool_link.rotation @ np.array(point_m)


def _failure(motion: int, reason: str, *, progress: float, at_rest: bool) -> MotionFinished:
    report = MotionReport(end=MotionEnd.FAILED, reason=reason, at_rest=at_rest)
    return MotionFinished(motion=motion, progress=progress, report=report)
