"""A Universal Robots controller that follows joint set points, through the client library `ur-rtde`.

The library crashes after a lost link, keeps the interpreter's lock while it waits, and prints: it lives in the control
process of its arm and is never asked to reconnect. Only its real-time commands are used, which wait for no answer.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from robots.drivers.arm.joint_controller import ControllerIdentity, ControllerReading, MotionRefused
from robots.drivers.universal_robots.control_state import PROGRAM_RUNS
from robots.drivers.universal_robots.script_port import ScriptPort
from robots.drivers.universal_robots.ur_conversions import (
    OUTPUTS,
    base_link_wrench,
    digital_values,
    output_program,
    payload_with_load,
    tool_centre,
)
from robots.drivers.universal_robots.ur_dashboard import ask_dashboard
from robots.drivers.universal_robots.ur_faults import (
    UrFault,
    controller_words,
    dashboard_fault,
    library_fault,
    lost,
    refused,
    remedy,
    safety_fault,
    stop_words,
)
from robots.drivers.universal_robots.ur_options import DASHBOARD_S, UrOptions
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.port import Array

_SCRIPT_PORT_S = 0.5
# The library waits for 3 s and more until its script takes a command, and gives up.
_MOST_TRIES = 5
_POLL_S = 0.0005
_PAUSED = 4
_SERVO_STOP_RAD_S2 = 4.0
_CB3_PERIOD_S, _E_SERIES_PERIOD_S = 0.008, 0.002
_VARIABLES = [
    "timestamp", "actual_q", "actual_qd", "actual_TCP_force", "actual_digital_output_bits", "actual_digital_input_bits",
    "robot_mode", "safety_status_bits", "robot_status_bits", "speed_scaling", "runtime_state",
]  # fmt: skip


def new_ur_controller(options: bytes, capture: WireCapture = NO_CAPTURE) -> UrJointController:
    """Return the controller of encoded options, not yet connected."""
    return UrJointController(msgspec.json.decode(options, type=UrOptions), capture)


class UrJointController:
    """Implements `robots.drivers.arm.joint_controller.JointController`.

    Args:
        options: Where the controller is.
        capture: Captures dashboard and outputs; the library opens its own connections, which nobody can capture here.
    """

    def __init__(self, options: UrOptions, capture: WireCapture = NO_CAPTURE) -> None:
        self._options = options
        self._host = options.host
        self._dashboard_tap = capture.tap("ur_dashboard")
        self._receive: Any = None
        self._control: Any = None
        self._period_s = _CB3_PERIOD_S
        self._time_s = 0.0
        self._is_enabled = False
        self._is_servoing = False
        # Whether a program runs that is ours: after its end it may be anybody's.
        self._runs_ours = False
        scripts = capture.tap("ur_secondary")
        self._scripts = ScriptPort(options.host, options.ports.script, limit_s=_SCRIPT_PORT_S, tap=scripts)

    @property
    def period_s(self) -> float:
        """Time between two set points."""
        return self._period_s

    def connect(self) -> ControllerIdentity:
        """Read the controller; raises ControllerLost with the cause."""
        version = self._ask("PolyscopeVersion", limit_s=2.0)
        serial_number = self._ask("get serial number", limit_s=2.0)
        self._period_s = _E_SERIES_PERIOD_S if " 5." in f" {version.removeprefix('URSoftware ')}" else _CB3_PERIOD_S
        try:
            library = importlib.import_module("rtde_receive")
            self._receive = library.RTDEReceiveInterface(self._host, 1.0 / self._period_s, _VARIABLES)
        # Whatever the library raises: it has no errors of its own.
        except Exception as error:
            raise lost(library_fault(str(error)), str(error)) from error
        return ControllerIdentity(firmware=version, serial_number=serial_number)

    def read(self) -> ControllerReading | None:
        """Return the next measurement, None without one within two periods; raises ControllerLost."""
        receive = self._receive
        limit_s = time.monotonic() + 2.0 * self._period_s
        while (time_s := receive.getTimestamp()) == self._time_s:
            if not receive.isConnected():
                raise lost(UrFault.LINK_CUT, "the library has lost the controller")
            if time.monotonic() > limit_s:
                return None
            time.sleep(_POLL_S)
        self._time_s = time_s
        self._scripts.advance()
        fault = self._fault()
        return ControllerReading(
            time_s=time_s,
            position_rad=np.array(receive.getActualQ()),
            velocity_rad_s=np.array(receive.getActualQd()),
            effort_nm=np.zeros(6),
            wrench=base_link_wrench(receive.getActualTCPForce()),
            stopped_by=stop_words(fault) if fault is not None else "",
            remedy=remedy(fault) if fault is not None else "",
            speed_scaling=float(receive.getSpeedScaling()),
            outputs=digital_values(receive.getActualDigitalOutputBits()),
            inputs=digital_values(receive.getActualDigitalInputBits()),
        )

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        """Start the control script where it does not run, then set tool, payload and watchdog.

        Raises:
            MotionRefused: the safety system, another client or local control forbids it, or the script does not take
                them within `start_s`.
        """
        end_s = time.monotonic() + self._options.start_s
        fault = safety_fault(self._receive.getSafetyStatusBits(), self._receive.getRobotMode())
        if fault is not None:
            raise refused(fault, "the controller cannot move")
        # The library would wait for the script for minutes.
        if self._receive.getRuntimeState() == _PAUSED:
            raise refused(UrFault.PROGRAM_PAUSED, "a program is paused at the controller")
        try:
            self._start_script(end_s)
            self._end_servoing(end_s)
            control, tcp = self._control, tool_centre(self._options, tcp_xyz_m)
            self._have_taken("setTcp", lambda: control.setTcp(tcp), end_s)
            mass_kg, com_m = payload_with_load(self._options, load_kg, load_com_m)
            self._have_taken("setPayload", lambda: control.setPayload(mass_kg, com_m), end_s)
            # The last: from here on there has to be a set point in each of its periods.
            self._have_taken("setWatchdog", lambda: control.setWatchdog(self._options.watchdog_hz), end_s)
        except MotionRefused:
            raise
        # Whatever the library raises: it has no errors of its own.
        except Exception as error:
            fault = self._dashboard_fault() or library_fault(str(error))
            raise refused(fault, str(error)) from error
        self._is_enabled = True

    def command(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Send the set point of the next period; raises MotionRefused when the program has ended."""
        if not self._is_enabled:
            raise refused(UrFault.PROGRAM_ENDED, "a set point was not taken")
        options = self._options
        self._is_servoing = True
        try:
            is_sent = self._control.servoJ(
                position_rad.tolist(), 0.0, 0.0, self._period_s, options.lookahead_s, options.gain
            )
        # Whatever the library raises: it has no errors of its own.
        except Exception as error:
            raise lost(UrFault.LINK_CUT, str(error)) from error
        if not is_sent:
            self._is_enabled = False
            raise refused(self._dashboard_fault() or self._end_fault(), "a set point was not taken")

    def stop(self) -> None:
        """End the program by the dashboard, on a connection that the library knows nothing of."""
        self._is_enabled = False
        if self._runs_ours:
            self._runs_ours = False
            self._ask("stop")

    def set_output(self, output: int, *, on: bool) -> None:
        """Set an output by a program beside the main one; raises MotionRefused where there is no such output."""
        if not 0 <= output < OUTPUTS:
            raise MotionRefused(f"there is no output {output}", hint=f"its outputs are 0 to {OUTPUTS - 1}")
        self._scripts.send(output_program(output, on=on))

    @property
    def output_problem(self) -> str:
        """Why the output that was set last is not; empty where it is, or still may be."""
        return self._scripts.problem

    def close(self) -> None:
        """Leave the program to `stop`: the library's own end waits, and crashes after a lost link."""
        self._is_enabled = False
        self._scripts.close()

    def _fault(self) -> UrFault | None:
        """Return why the arm does not move; also which stop has ended the program."""
        receive = self._receive
        fault = safety_fault(receive.getSafetyStatusBits(), receive.getRobotMode())
        if not self._runs():
            self._runs_ours = False
            if fault is None and self._is_enabled:
                fault = self._dashboard_fault() or UrFault.PROGRAM_ENDED
        elif fault is None and self._is_enabled and receive.getRuntimeState() == _PAUSED:
            fault = UrFault.PROGRAM_PAUSED
        if fault is not None:
            self._is_enabled = False
        return fault

    def _start_script(self, end_s: float) -> None:
        if self._control is None:
            self._control = importlib.import_module("rtde_control").RTDEControlInterface(self._host)
        elif not self._control.isProgramRunning():
            if self._is_enabled:
                # Ended since the last reading; a change of the tool comes here without a person.
                self._is_enabled = False
                raise refused(self._dashboard_fault() or UrFault.PROGRAM_ENDED, "the control script has ended")
            self._is_servoing = False
            self._control.reuploadScript()
        self._runs_ours = True
        while not (self._control.isProgramRunning() and self._runs()):
            if time.monotonic() > end_s:
                raise refused(UrFault.PROGRAM_NOT_READY, f"the control script does not start; {self._words()}")
            time.sleep(self._period_s)

    def _have_taken(self, what: str, command: Callable[[], object], end_s: float) -> None:
        """Repeat a command until the script takes it, or has ended, or its time is over; raises MotionRefused."""
        tries = 0
        while tries < _MOST_TRIES and (tries == 0 or time.monotonic() < end_s):
            tries += 1
            if command() is True:
                return
            receive = self._receive
            fault = safety_fault(receive.getSafetyStatusBits(), receive.getRobotMode())
            if fault is None and not self._runs():
                fault = self._dashboard_fault() or UrFault.PROGRAM_ENDED
            if fault is not None:
                raise refused(fault, f"{what} was refused; {self._words()}")
            time.sleep(self._period_s)
        times = "once" if tries == 1 else f"{tries} times"
        raise refused(UrFault.PROGRAM_NOT_READY, f"{what} was refused {times}; {self._words()}")

    def _runs(self) -> bool:
        return bool(self._receive.getRobotStatus() & PROGRAM_RUNS)

    def _words(self) -> str:
        receive = self._receive
        return controller_words(
            receive.getRobotMode(),
            receive.getSafetyStatusBits(),
            is_running=self._runs(),
            is_paused=receive.getRuntimeState() == _PAUSED,
        )

    def _end_fault(self) -> UrFault:
        """Return how the program has ended: what the library knows may be newer than what was read last."""
        receive, limit_s = self._receive, time.monotonic() + 2.0 * self._period_s
        while receive.getTimestamp() == self._time_s and time.monotonic() < limit_s:
            time.sleep(_POLL_S)
        return UrFault.PROGRAM_PAUSED if receive.getRuntimeState() == _PAUSED else UrFault.PROGRAM_ENDED

    def _end_servoing(self, end_s: float) -> None:
        if self._is_servoing:
            self._is_servoing = False
            self._have_taken("servoStop", lambda: self._control.servoStop(_SERVO_STOP_RAD_S2), end_s)

    def _dashboard_fault(self) -> UrFault | None:
        return dashboard_fault(self._ask("safetystatus"))

    def _ask(self, command: str, *, limit_s: float = DASHBOARD_S) -> str:
        return ask_dashboard(self._host, command, limit_s=limit_s, tap=self._dashboard_tap)
