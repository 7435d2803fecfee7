"""An IRC5 that follows joint set points by Externally Guided Motion."""

from __future__ import annotations

import math
import time
from collections import deque

import msgspec
import numpy as np

from robots.drivers.abb.abb_faults import REMEDIES, AbbFault, AbbLinkError
from robots.drivers.abb.egm.egm_messages import EgmMeasurement, MciState, MotorState, RapidState
from robots.drivers.abb.egm.egm_options import PERIOD_S, EgmOptions
from robots.drivers.abb.egm.egm_socket import EgmSocket
from robots.drivers.arm.joint_controller import ControllerIdentity, ControllerLost, ControllerReading, MotionRefused
from robots.io.wire.wire_capture import NO_CAPTURE, WireCapture
from robots.model.joint_map import JointMap
from robots.port import Array

_CONNECT_S = 3.0
_WRAP_MS = 1 << 32
_VELOCITY_S = 0.04
_HELD_DEG = 1.0
_STEADY = 10
"""So many measurements in a row must say that set points are followed, before motion counts as started."""


class EgmProcessOptions(msgspec.Struct, frozen=True, kw_only=True):
    """What the control process of the arm is told: the option `egm`, and the axes of the arm."""

    host: str
    egm: EgmOptions
    matrix: tuple[tuple[float, ...], ...]
    offset_rad: tuple[float, ...]


def new_egm_controller(options: bytes, capture: WireCapture = NO_CAPTURE) -> EgmController:
    """Return the controller of encoded options, not yet connected."""
    return EgmController(msgspec.json.decode(options, type=EgmProcessOptions), capture)


class EgmController:
    """Implements `robots.drivers.arm.joint_controller.JointController`.

    It answers a measurement with a set point only while motion is enabled. A controller without answers for its
    `CommTimeout` ends guided motion at rest, and its program starts it again, at rest.
    """

    def __init__(self, options: EgmProcessOptions, capture: WireCapture = NO_CAPTURE) -> None:
        self._options = options.egm
        axes = len(options.offset_rad)
        self._map = JointMap(
            matrix=options.matrix,
            offset_rad=options.offset_rad,
            lower_rad=(-math.inf,) * axes,
            upper_rad=(math.inf,) * axes,
        )
        self._socket = EgmSocket(
            options.host, address=options.egm.address, port=options.egm.port, tap=capture.tap("egm")
        )
        self._host = options.host
        self._last: EgmMeasurement | None = None
        self._time_s = 0.0
        self._velocity: Array = np.zeros(axes)
        self._track: deque[tuple[float, Array]] = deque()
        self._is_enabled = False
        self._good_s = 0.0

    @property
    def period_s(self) -> float:
        """Time between two set points."""
        return PERIOD_S

    @property
    def output_problem(self) -> str:
        """Nothing: outputs are switched elsewhere."""
        return ""

    def connect(self) -> ControllerIdentity:
        """Listen, and return with the first measurement; raises ControllerLost."""
        try:
            self._socket.open()
            first = self._receive(_CONNECT_S)
        except AbbLinkError as error:
            raise _lost(error) from error
        if first is None:
            raise _lost(
                AbbLinkError(
                    AbbFault.SILENT, self._socket.garbage or f"nothing of {self._host} came to {self._socket.address}"
                )
            )
        return ControllerIdentity(notes=("EGM",))

    def enable(self, *, tcp_xyz_m: Array, load_kg: float, load_com_m: Array) -> None:
        """Begin to answer, with what the controller holds, and return once it follows.

        Raises:
            MotionRefused: it says why it does not move, or a load is given.
            ControllerLost: it is silent.
        """
        if load_kg:
            raise MotionRefused("the load cannot be set from here", hint="define it in the tooldata of the controller")
        self._is_enabled = False
        end_s, steady = time.monotonic() + self._options.start_s, 0
        # What is answered becomes a set point: one measurement that cannot be must not.
        resting_deg = np.median([self._next_measurement().measured_deg for _ in range(_STEADY)], axis=0)
        while steady < _STEADY:
            measurement = self._next_measurement()
            fault = _fault(measurement)
            if fault is not None:
                raise MotionRefused(f"{fault[0].value}: {fault[1]}", hint=REMEDIES[fault[0]])
            if time.monotonic() > end_s:
                cause = AbbFault.EGM_STOPPED
                raise MotionRefused(
                    f"{cause.value}: guided motion does not start within {self._options.start_s:g} s",
                    hint=REMEDIES[cause],
                )
            off_deg = float(np.abs(np.subtract(measurement.measured_deg, resting_deg)).max())
            if not off_deg < _HELD_DEG:
                steady = 0
                continue
            self._answer(held_deg(measurement) or measurement.measured_deg)
            steady = steady + 1 if measurement.mci is MciState.RUNNING else 0
        self._is_enabled = True

    def read(self) -> ControllerReading | None:
        """Return the newest measurement, None without one within two periods; raises ControllerLost."""
        try:
            measurement = self._receive(2.0 * PERIOD_S)
        except AbbLinkError as error:
            raise _lost(error) from error
        if measurement is None:
            silent_s = time.monotonic() - self._good_s
            if self._socket.garbage and silent_s > self._options.stale_s / 2.0:
                raise ControllerLost(
                    f"{self._socket.garbage}, and no measurement for {silent_s:.2f} s",
                    hint="check that the program FlexcellEgm runs, and nothing else sends to this port",
                )
            return None
        fault = _fault(measurement, is_enabled=self._is_enabled)
        held = held_deg(measurement)
        return ControllerReading(
            time_s=self._time_s,
            position_rad=self._model(measurement.measured_deg),
            velocity_rad_s=self._velocity,
            effort_nm=np.zeros(len(self._velocity)),
            stopped_by=f"{fault[0].value}: {fault[1]}" if fault is not None else "",
            remedy=f"{REMEDIES[fault[0]]}, then enable motion" if fault is not None else "",
            held_rad=self._model(held) if held is not None else None,
        )

    def command(self, position_rad: Array, velocity_rad_s: Array) -> None:
        """Answer the last measurement with a set point.

        Raises:
            MotionRefused: motion is not enabled, or it is no set point.
            ControllerLost: nothing can be sent.
        """
        if not self._is_enabled:
            raise MotionRefused(f"{AbbFault.EGM_STOPPED.value}: set points are not sent", hint="enable motion")
        if not np.isfinite(position_rad).all():
            raise MotionRefused("a set point is no number")
        axes = self._map.to_device(np.asarray(position_rad))
        self._answer(tuple(np.degrees(axes).tolist()))

    def stop(self) -> None:
        """Answer no more: the controller holds the last set point, and ends guided motion by its `CommTimeout`."""
        self._is_enabled = False

    def set_output(self, output: int, *, on: bool) -> None:
        """Refuse: raises MotionRefused."""
        raise MotionRefused(f"there is no output {output} over EGM", hint="a gripper has a port of its own")

    def close(self) -> None:
        """Stop listening."""
        self._is_enabled = False
        self._socket.close()

    def _next_measurement(self) -> EgmMeasurement:
        """Return a measurement; raises ControllerLost where none comes in time."""
        try:
            measurement = self._receive(self._options.stale_s)
        except AbbLinkError as error:
            raise _lost(error) from error
        if measurement is None:
            silent = self._socket.garbage or f"no measurement within {self._options.stale_s:g} s"
            raise _lost(AbbLinkError(AbbFault.SILENT, silent))
        return measurement

    def _receive(self, limit_s: float) -> EgmMeasurement | None:
        measurement = self._socket.receive(limit_s)
        if measurement is None:
            return None
        self._good_s = time.monotonic()
        last, self._last = self._last, measurement
        if last is not None:
            elapsed_s = ((measurement.time_ms - last.time_ms) % _WRAP_MS) / 1e3
            # A clock that has begun anew tells no time.
            self._time_s += elapsed_s if elapsed_s < 1.0 else PERIOD_S
        self._note_velocity(self._model(measurement.measured_deg))
        return measurement

    def _note_velocity(self, position_rad: Array) -> None:
        """Take the mean over some periods: an axis stands still for one in which no set point came."""
        track = self._track
        track.append((self._time_s, position_rad))
        while len(track) > 2 and self._time_s - track[1][0] >= _VELOCITY_S:
            track.popleft()
        begin_s, begin_rad = track[0]
        if self._time_s > begin_s:
            self._velocity = (position_rad - begin_rad) / (self._time_s - begin_s)

    def _answer(self, planned_deg: tuple[float, ...]) -> None:
        try:
            self._socket.send(planned_deg)
        except AbbLinkError as error:
            raise _lost(error) from error

    def _model(self, axes_deg: tuple[float, ...]) -> Array:
        return self._map.to_model(np.radians(axes_deg))


def _fault(measurement: EgmMeasurement, *, is_enabled: bool = False) -> tuple[AbbFault, str] | None:
    """Return why the controller does not move, as its measurement says; what it leaves open is no permission."""
    if measurement.motors is not MotorState.ON:
        return AbbFault.DRIVES_OFF, "the motors are off"
    if measurement.rapid is not RapidState.RUNNING:
        return AbbFault.PROGRAM_STOPPED, "RAPID is stopped"
    if is_enabled and measurement.mci is not MciState.RUNNING:
        return AbbFault.EGM_STOPPED, "the controller follows no set points: none came in time, or it refused one"
    return None


def held_deg(measurement: EgmMeasurement) -> tuple[float, ...] | None:
    """Return the angles that the controller holds; None where what it says of them cannot be: motion begins there."""
    planned = measurement.planned_deg
    if planned is None:
        return None
    off_deg = max(abs(each - there) for each, there in zip(planned, measurement.measured_deg, strict=True))
    return planned if off_deg < _HELD_DEG else None


def _lost(error: AbbLinkError) -> ControllerLost:
    return ControllerLost(str(error), hint=f"{REMEDIES[error.fault]}; only reading is restored by itself")
