"""An FR3 that follows joint set points at 1 kHz, through libfranka.

The library keeps the interpreter's lock while it waits, and a robot that falls silent blocks it for a second: it lives
in the control process of its arm. A motion of the robot is active as long as it is enabled, and holds in between.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import msgspec
import numpy as np

from robots.drivers.arm.joint_controller import (
    ControllerFailure,
    ControllerIdentity,
    ControllerLost,
    ControllerReading,
    MotionRefused,
)
from robots.drivers.franka.fr3_limits import limit_violation
from robots.drivers.franka.franka_faults import (
    FrankaFault,
    FrankaMode,
    library_fault,
    named_errors,
    remedy,
    reported_errors,
    state_fault,
)
from robots.drivers.franka.franka_options import FrankaOptions
from robots.drivers.franka.franka_tool import IDENTITY, end_effector_frame, total_load
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.port import Array

T = TypeVar("T")
PERIOD_S = 0.001
# From as many lost set points on the robot has ended the motion by itself.
_MOST_PERIODS = 20
_LOST = frozenset(
    {FrankaFault.LINK_CUT, FrankaFault.CONTROLLER_SILENT, FrankaFault.UNREACHABLE_CONTROLLER, FrankaFault.FCI_REFUSED}
)


def new_franka_controller(options: bytes, _capture: WireCapture = NO_CAPTURE) -> FrankaJointController:
    """Return the controller of encoded options, not yet connected; `pylibfranka` opens its own connections."""
    return FrankaJointController(msgspec.json.decode(options, type=FrankaOptions))


class FrankaJointController:
    """Implements `robots.drivers.arm.joint_controller.JointController`.

    Args:
        options: Its options.
        load_library: Returns the module `pylibfranka`.
    """

    def __init__(
        self,
        options: FrankaOptions,
        *,
        load_library: Callable[[], Any] = lambda: importlib.import_module("pylibfranka"),
    ) -> None:
        self._options = options
        self._load_library = load_library
        self._library: Any = None
        self._robot: Any = None
        self._motion: Any = None
        self._state: Any = None
        self._sent_rad: Array | None = None
        self._sent_periods = 1
        self._stopped_by, self._remedy = "", ""

    @property
    def period_s(self) -> float:
        """Time between two set points."""
        return PERIOD_S

    def connect(self) -> ControllerIdentity:
        """Connect and read; raises ControllerLost with the cause."""
        options = self._options
        try:
            self._library = library = self._load_library()
            real_time = library.RealtimeConfig
            config = real_time.kEnforce if options.real_time == "enforce" else real_time.kIgnore
            self._robot = library.Robot(options.host, config)
            self._state = self._robot.read_once()
        # Whatever the library or its loading raises: not all of its errors have a Python type.
        except Exception as error:
            raise _lost(library_fault(str(error)), str(error)) from error
        return ControllerIdentity(firmware=f"FCI through libfranka {library.__version__}")

    def read(self) -> ControllerReading:
        """Return the next measurement; raises ControllerLost when none came within a second."""
        periods = 1
        if self._motion is not None:
            periods = self._read_motion()
        if self._motion is None:
            self._state = self._ask(self._robot.read_once)
        state = self._state
        fault = None if self._stopped_by else state_fault(_mode(state), _errors(state))
        is_commanded = self._motion is not None
        if fault is not None and is_commanded:
            self._end_motion(named_errors(fault, _errors(state)), remedy(fault))
        return ControllerReading(
            time_s=state.time.to_sec(),
            position_rad=np.array(state.q),
            velocity_rad_s=np.array(state.dq),
            effort_nm=np.array(state.tau_J),
            # libfranka reports what the tool exerts on its environment.
            wrench=-np.array(state.O_F_ext_hat_K),
            stopped_by=self._stopped_by or (named_errors(fault, _errors(state)) if fault is not None else ""),
            remedy=self._remedy or (remedy(fault) if fault is not None else ""),
            periods=periods,
            held_rad=np.array(state.q_d) if is_commanded else None,
        )

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        """Recover from an error, set thresholds, stiffness, load and frames, and start to hold the arm.

        A robot that was held until now is not recovered: a change of the tool comes here without a person.

        Raises:
            MotionRefused: the robot is stopped by a person, guided or locked, or refuses.
            ControllerLost: it does not answer.
        """
        was_held = self._motion is not None
        self._finish_motion()
        self._state = state = self._ask(self._robot.read_once)
        mode = _mode(state)
        fault = state_fault(mode, ())
        if fault is not None and mode is not FrankaMode.REFLEX:
            raise _refused(fault, "the robot cannot move")
        stop = state_fault(mode, _errors(state))
        if was_held and stop is not None:
            raise MotionRefused(named_errors(stop, _errors(state)), hint=remedy(stop))
        if mode is FrankaMode.REFLEX or _errors(state):
            self._ask(self._robot.automatic_error_recovery)
        self._set_up(tcp_xyz_m, load_kg=load_kg, load_com_m=load_com_m)
        mode_of_control = self._library.ControllerMode.JointImpedance
        self._motion = self._ask(lambda: self._robot.start_joint_position_control(mode_of_control))
        self._sent_rad, self._sent_periods = None, 1
        self._stopped_by = self._remedy = ""
        # From here on there has to be a set point in each period.
        self._hold()

    def command(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Send the set point of the next period; raises MotionRefused, ControllerLost."""
        if self._motion is None:
            raise MotionRefused(self._stopped_by or "motion is not enabled", hint=self._remedy)
        before, self._sent_rad = self._sent_rad, position_rad.copy()
        if before is not None:
            # That between two set points, not the one of the plan: the robot judges what it gets.
            violation = limit_violation(position_rad, (position_rad - before) / (self._sent_periods * PERIOD_S))
            if violation:
                raise _refused(FrankaFault.MOTION_LIMITS, violation)
        try:
            self._motion.writeOnce(self._library.JointPositions(position_rad.tolist()))
        # Whatever the library raises: not all of its errors have a Python type.
        except Exception as error:
            self._motion = None
            raise self._failure(error) from error

    def stop(self) -> None:
        """End the motion of the robot, which brakes."""
        if self._motion is None:
            return
        self._motion = None
        try:
            self._robot.stop()
        # Whatever the library raises: a robot that is lost or has stopped already stops by itself.
        except Exception:
            self._stopped_by = self._stopped_by or "the robot did not acknowledge a stop"

    def set_output(self, output: int, *, on: bool) -> None:
        """Refuse: the Franka Control Interface has no outputs; raises MotionRefused."""
        raise MotionRefused(f"there is no output {output}: the Franka Control Interface has none")

    @property
    def output_problem(self) -> str:
        """Nothing: it has no outputs."""
        return ""

    def close(self) -> None:
        """Disconnect; `stop` has ended the motion."""
        self._robot = None

    def _read_motion(self) -> int:
        """Take the next state of the active motion; returns the periods since the last one."""
        try:
            self._state, passed = self._motion.readOnce()
        # Whatever the library raises: not all of its errors have a Python type.
        except Exception as error:
            self._motion = None
            self._note_end(self._failure(error))
            return 1
        self._sent_periods = min(_MOST_PERIODS, max(1, round(passed.to_sec() / PERIOD_S)))
        return self._sent_periods

    def _note_end(self, failure: ControllerFailure) -> None:
        """Note why the robot has ended its motion: a mode that a person has chosen says more than the library."""
        if isinstance(failure, ControllerLost):
            raise failure
        self._state = self._ask(self._robot.read_once)
        fault = state_fault(_mode(self._state), ())
        if fault is None or fault is FrankaFault.REFLEX:
            self._stopped_by, self._remedy = str(failure), failure.hint
        else:
            self._stopped_by, self._remedy = named_errors(fault, ()), remedy(fault)

    def _hold(self) -> None:
        """Answer the first state with the set point that the robot holds."""
        self._read_motion()
        if self._motion is None:
            raise MotionRefused(self._stopped_by, hint=self._remedy)
        self.command(np.array(self._state.q_d), np.zeros(7))

    def _finish_motion(self) -> None:
        """End the motion in which the robot holds, at rest."""
        motion, self._motion = self._motion, None
        if motion is None:
            return
        last = self._library.JointPositions(
            list(self._state.q_d) if self._sent_rad is None else self._sent_rad.tolist()
        )
        last.motion_finished = True
        self._ask(lambda: motion.writeOnce(last))

    def _end_motion(self, cause: str, hint: str) -> None:
        self._stopped_by, self._remedy = cause, hint
        self.stop()

    def _set_up(self, tcp_xyz_m: Array, *, load_kg: float, load_com_m: Array) -> None:
        """Set what the robot forgets when its client has changed."""
        robot, options = self._robot, self._options
        load = total_load(load_kg, load_com_m, options)
        frame = end_effector_frame(self._state.F_T_NE, tcp_xyz_m=tcp_xyz_m, options=options)
        self._ask(
            lambda: robot.set_collision_behavior(
                list(options.contact_torque_nm),
                list(options.reflex_torque_nm),
                list(options.contact_force_n),
                list(options.reflex_force_n),
            )
        )
        self._ask(lambda: robot.set_joint_impedance(list(options.joint_stiffness_nm_rad)))
        self._ask(lambda: robot.set_EE(frame))
        self._ask(lambda: robot.set_K(list(IDENTITY)))
        self._ask(lambda: robot.set_load(load.mass_kg, list(load.com_m), list(load.inertia_kg_m2)))

    def _ask(self, call: Callable[[], T]) -> T:
        try:
            return call()
        # Whatever the library raises: not all of its errors have a Python type.
        except Exception as error:
            raise self._failure(error) from error

    def _failure(self, error: Exception) -> ControllerFailure:
        """Return what an error of the library means."""
        message = str(error).partition("\n")[0]
        fault = library_fault(message)
        if isinstance(error, self._library.NetworkException) or fault in _LOST:
            cause = fault if fault in _LOST else FrankaFault.LINK_CUT
            return _lost(cause, message)
        errors = reported_errors(message)
        return MotionRefused(named_errors(fault, errors), hint=remedy(fault)) if errors else _refused(fault, message)


def _mode(state: Any) -> FrankaMode:
    return FrankaMode(int(state.robot_mode))


def _errors(state: Any) -> Sequence[str]:
    """Return the names of the current errors."""
    errors = state.current_errors
    return reported_errors(str(errors)) if errors else ()


def _refused(fault: FrankaFault, message: str) -> MotionRefused:
    return MotionRefused(f"{fault.value}: {message}", hint=remedy(fault))


def _lost(fault: FrankaFault, message: str) -> ControllerLost:
    return ControllerLost(f"{fault.value}: {message}", hint=remedy(fault))
