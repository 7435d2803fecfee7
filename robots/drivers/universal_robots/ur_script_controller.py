"""A Universal Robots controller that follows joint set points, through RTDE and the control program of this project.

No library: the program is uploaded when a person permits motion, follows the set points in its input registers, and
stops the arm and ends when no new one comes. Readings and set points have connections of their own, so that reading
owns no register.
"""

from __future__ import annotations

import secrets
import time
from collections import deque
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import cast

import msgspec
import numpy as np

from robots.drivers.arm.joint_controller import ControllerIdentity, ControllerLost, ControllerReading, MotionRefused
from robots.drivers.universal_robots.control_program import (
    INPUT_TYPES,
    INPUTS,
    STATE_OUTPUTS,
    ControlRequest,
    control_program,
)
from robots.drivers.universal_robots.control_state import PROGRAM_RUNS, ProgramWatch
from robots.drivers.universal_robots.rtde_client import RtdeClient, RtdeInputsInUse, RtdeVersionError
from robots.drivers.universal_robots.rtde_codec import RtdeValue
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
    lost,
    refused,
    remedy,
    safety_fault,
)
from robots.drivers.universal_robots.ur_options import DASHBOARD_S, PROGRAM_END_S, UrOptions
from robots.io.wire.link_error import LinkError
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.port import Array

_CONNECT_S = 2.0
_SCRIPT_PORT_S = 0.5
_CB3_PERIOD_S, _E_SERIES_PERIOD_S = 0.008, 0.002
_E_SERIES = 5
# A set point may be farther off the arm than a motion, which fails before.
_DISTANCE_TOLERANCES = 2.0
_NUMBERS = 1 << 30
_SAME_M, _SAME_KG = 1e-4, 1e-3
_VARIABLES = (
    "timestamp", "actual_q", "actual_qd", "actual_TCP_force", "actual_digital_output_bits", "actual_digital_input_bits",
    "robot_mode", "safety_status_bits", "robot_status_bits", "runtime_state", "speed_scaling", *STATE_OUTPUTS,
)  # fmt: skip
_READ_BACK = ("tcp_offset", "payload")


def new_ur_script_controller(options: bytes, capture: WireCapture = NO_CAPTURE) -> UrScriptController:
    """Return the controller of encoded options, not yet connected."""
    return UrScriptController(msgspec.json.decode(options, type=UrOptions), capture)


class UrScriptController:
    """Implements `robots.drivers.arm.joint_controller.JointController`."""

    def __init__(self, options: UrOptions, capture: WireCapture = NO_CAPTURE) -> None:
        self._options = options
        self._host = options.host
        self._dashboard_tap, self._input_tap = capture.tap("ur_dashboard"), capture.tap("ur_inputs")
        self._readings = RtdeClient(options.host, options.ports.rtde, limit_s=_CONNECT_S, tap=capture.tap("ur_outputs"))
        self._inputs: RtdeClient | None = None
        scripts = capture.tap("ur_script")
        self._scripts = ScriptPort(options.host, options.ports.script, limit_s=_SCRIPT_PORT_S, tap=scripts)
        self._period_s = _CB3_PERIOD_S
        self._is_e_series = False
        self._names: tuple[str, ...] = ()
        self._values: Mapping[str, RtdeValue] = {}
        self._program = ProgramWatch()
        self._is_started = self._is_enabled = False
        self._numbers = {"set point": 0, "settings": 0, "output": 0}
        self._set_point = [0.0] * 6
        self._settings = [0.0] * 10
        # Number, output and value of the request in the registers.
        self._output = (0, 0, False)
        self._outputs: deque[tuple[int, bool]] = deque()

    @property
    def period_s(self) -> float:
        """Time between two set points."""
        return self._period_s

    def connect(self) -> ControllerIdentity:
        """Read the controller; raises ControllerLost with the cause."""
        try:
            version = self._readings.connect()
            self._is_e_series = version[0] >= _E_SERIES
            self._period_s = _E_SERIES_PERIOD_S if self._is_e_series else _CB3_PERIOD_S
            self._names = self._readings.choose_outputs(
                _VARIABLES, optional=_READ_BACK, frequency_hz=1.0 / self._period_s
            )
        except RtdeVersionError as error:
            raise lost(UrFault.WRONG_VERSION, str(error)) from error
        except LinkError as error:
            raise lost(UrFault.UNREACHABLE_CONTROLLER, str(error)) from error
        firmware = self._ask("PolyscopeVersion", limit_s=_CONNECT_S) or ".".join(map(str, version))
        return ControllerIdentity(firmware=firmware, serial_number=self._ask("get serial number", limit_s=_CONNECT_S))

    def read(self) -> ControllerReading | None:
        """Return the newest measurement, None without one within two periods; raises ControllerLost."""
        if not self._receive():
            return None
        self._scripts.advance()
        fault, words = self._fault()
        return ControllerReading(
            time_s=self._number("timestamp"),
            position_rad=np.array(self._values["actual_q"]),
            velocity_rad_s=np.array(self._values["actual_qd"]),
            effort_nm=np.zeros(6),
            wrench=base_link_wrench(cast("tuple[float, ...]", self._values["actual_TCP_force"])),
            stopped_by=f"{fault.value}: {words}" if fault is not None else "",
            remedy=remedy(fault) if fault is not None else "",
            speed_scaling=self._number("speed_scaling"),
            outputs=digital_values(self._integer("actual_digital_output_bits")),
            inputs=digital_values(self._integer("actual_digital_input_bits")),
        )

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        """Start the control program where it does not run, then set tool and payload, and read them back.

        Raises:
            MotionRefused: the safety system, another client or local control forbids it, or the program does not take
                them within `start_s`.
            ControllerLost: it does not answer.
        """
        end_s = time.monotonic() + self._options.start_s
        fault = self._safety_fault()
        if fault is not None:
            raise refused(fault, "the controller cannot move")
        if self._program.is_paused:
            raise refused(UrFault.PROGRAM_PAUSED, "a program is paused at the controller")
        if not self._program.runs:
            self._start_program(end_s)
        self._is_enabled = False
        tcp = tool_centre(self._options, tcp_xyz_m)
        mass_kg, com_m = payload_with_load(self._options, load_kg, load_com_m)
        self._settings = [*tcp, mass_kg, *com_m]
        number = self._next("settings")
        self._await(
            lambda: self._program.settings == number and self._reads_back(tcp, mass_kg),
            end_s,
            otherwise=lambda: f"tool and payload are not set: {self._read_back()}",
        )
        self._is_enabled = True

    def command(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Send the set point of the next period; raises MotionRefused when the program has ended."""
        if not self._is_enabled:
            raise refused(UrFault.PROGRAM_ENDED, "a set point was not taken")
        if not np.isfinite(position_rad).all():
            raise refused(UrFault.REFUSED, "a set point is no number")
        self._set_point = position_rad.tolist()
        self._send(ControlRequest.FOLLOW)
        behind_s = (self._numbers["set point"] - self._program.set_point) * self._period_s
        # Each set point answers a measurement: those on their way say how old all that is read must be.
        if behind_s > self._options.stale_s:
            raise lost(UrFault.LINK_SLOW, f"set points arrive later than {self._options.stale_s:g} s")

    def stop(self) -> None:
        """End the program: by its input register, and by the dashboard where it still runs 0.3 s later."""
        self._is_enabled = False
        self._drop_outputs()
        if not self._program.is_loaded:
            return
        with suppress(ControllerLost):
            limit_s = time.monotonic() + PROGRAM_END_S
            while self._program.is_loaded and time.monotonic() < limit_s:
                self._send(ControlRequest.END)
                self._receive()
        # Where it does not run any more, the program that runs may be anybody's.
        if self._program.runs:
            self._ask("stop")

    def set_output(self, output: int, *, on: bool) -> None:
        """Set an output by the control program, or by one of its own where that does not run."""
        if not 0 <= output < OUTPUTS:
            raise MotionRefused(f"there is no output {output}", hint=f"its outputs are 0 to {OUTPUTS - 1}")
        if self._is_enabled:
            self._outputs.append((output, on))
        else:
            self._scripts.send(output_program(output, on=on))

    @property
    def output_problem(self) -> str:
        """Why the output that was set last is not; empty where it is, or still may be."""
        return self._scripts.problem

    def close(self) -> None:
        """Disconnect; the program was ended by `stop`."""
        self._is_enabled = False
        self._readings.close()
        if self._inputs is not None:
            self._inputs.close()
        self._scripts.close()

    def _fault(self) -> tuple[UrFault | None, str]:
        """Return why the arm does not move, with the words of its program; also which stop has ended that."""
        fault, words = self._safety_fault(), "the controller has stopped the arm"
        if fault is None and self._is_enabled and not self._program.runs:
            if self._program.is_paused:
                fault = UrFault.PROGRAM_PAUSED
            else:
                fault = dashboard_fault(self._ask("safetystatus"))
                if fault is None:
                    fault, words = UrFault.PROGRAM_ENDED, self._program.end_words()
        if fault is not None and self._is_enabled:
            self._is_enabled = False
            self._drop_outputs()
            # A paused program, resumed by a person or a safeguard, would follow the last set point of its registers.
            self._send(ControlRequest.END)
        return fault, words

    def _drop_outputs(self) -> None:
        """Withdraw the requests that were not executed: nobody waits for them when a program runs again."""
        self._outputs.clear()
        _, output, on = self._output
        self._output = (self._program.output, output, on)

    def _safety_fault(self) -> UrFault | None:
        return safety_fault(self._integer("safety_status_bits"), self._integer("robot_mode"))

    def _start_program(self, end_s: float) -> None:
        if self._is_e_series and self._ask("is in remote control", limit_s=_CONNECT_S) == "false":
            raise refused(UrFault.LOCAL_CONTROL, "the controller takes no programs")
        self._own_inputs()
        options, session = self._options, 1 + secrets.randbelow(_NUMBERS)
        self._program.begin(session)
        self._numbers = dict.fromkeys(self._numbers, 0)
        self._drop_outputs()
        # Before the program starts: the registers have to be those of its session.
        self._send(ControlRequest.REST)
        self._scripts.send(
            control_program(
                session=session,
                step_s=self._period_s,
                silence_limit_s=1.0 / options.watchdog_hz,
                distance_limit_rad=_DISTANCE_TOLERANCES * options.path_tolerance_rad,
                lookahead_s=options.lookahead_s,
                servo_gain=options.gain,
            )
        )
        self._await(
            lambda: self._program.runs,
            end_s,
            otherwise=lambda: "the control program does not start",
        )

    def _own_inputs(self) -> None:
        """Become the only client that writes the input registers."""
        if self._inputs is not None:
            return
        inputs = RtdeClient(self._host, self._options.ports.rtde, limit_s=_CONNECT_S, tap=self._input_tap)
        try:
            inputs.connect()
            inputs.own_inputs(INPUTS, INPUT_TYPES)
        except RtdeInputsInUse as error:
            inputs.close()
            raise refused(UrFault.IN_USE, str(error)) from error
        except LinkError as error:
            inputs.close()
            raise lost(UrFault.LINK_CUT, str(error)) from error
        self._inputs = inputs

    def _await(self, condition: Callable[[], bool], end_s: float, *, otherwise: Callable[[], str]) -> None:
        """Read, and tell the program that this process is alive, until the condition is met; raises MotionRefused."""
        while not condition():
            if self._receive():
                self._scripts.advance()
                self._send(ControlRequest.REST)
            fault = self._safety_fault()
            if fault is not None:
                raise refused(fault, "the controller has stopped")
            if self._scripts.problem:
                raise refused(UrFault.REFUSED, self._scripts.problem)
            if self._program.has_ended:
                raise refused(UrFault.PROGRAM_ENDED, f"{otherwise()}; {self._program.end_words()}")
            if time.monotonic() > end_s:
                raise refused(UrFault.PROGRAM_NOT_READY, f"{otherwise()}; {self._words()}")

    def _receive(self) -> bool:
        """Take the newest measurement; False without one within two periods."""
        try:
            # Not before: between `connect` and the first reading the process may load for a minute.
            if not self._is_started:
                self._readings.start()
                self._is_started = True
            values = self._readings.latest(2.0 * self._period_s)
        except LinkError as error:
            raise lost(UrFault.LINK_CUT, str(error)) from error
        if values is None:
            return False
        self._values = dict(zip(self._names, values, strict=True))
        self._program.update(self._values)
        return True

    def _send(self, request: ControlRequest) -> None:
        """Write all inputs, as a new set point."""
        if self._outputs and self._program.output == self._output[0]:
            self._output = (self._next("output"), *self._outputs.popleft())
        number, output, on = self._output
        integers = [
            self._program.session, self._next("set point"), int(request), self._numbers["settings"],
            number, output, int(on),
        ]  # fmt: skip
        inputs = self._inputs
        if inputs is None:
            return
        try:
            inputs.write([*integers, *self._set_point, *self._settings])
        except LinkError as error:
            raise lost(UrFault.LINK_CUT, str(error)) from error

    def _next(self, what: str) -> int:
        self._numbers[what] = number = (self._numbers[what] + 1) % _NUMBERS
        return number

    def _words(self) -> str:
        return controller_words(
            self._integer("robot_mode"),
            self._integer("safety_status_bits"),
            is_running=bool(self._integer("robot_status_bits") & PROGRAM_RUNS),
            is_paused=self._program.is_paused,
        )

    def _reads_back(self, tcp: list[float], mass_kg: float) -> bool:
        """Whether a controller that reports tool and payload reports these."""
        values = self._values
        return bool(np.allclose(values.get("tcp_offset", tcp), tcp, atol=_SAME_M)) and bool(
            np.isclose(cast("float", values.get("payload", mass_kg)), mass_kg, atol=_SAME_KG)
        )

    def _read_back(self) -> str:
        reported = {name: self._values[name] for name in _READ_BACK if name in self._values}
        return ", ".join(f"{name} reads back as {value}" for name, value in reported.items()) or "no answer"

    def _number(self, name: str) -> float:
        return cast("float", self._values[name])

    def _integer(self, name: str) -> int:
        return cast("int", self._values[name])

    def _ask(self, command: str, *, limit_s: float = DASHBOARD_S) -> str:
        port = self._options.ports.dashboard
        return ask_dashboard(self._host, command, limit_s=limit_s, port=port, tap=self._dashboard_tap)
