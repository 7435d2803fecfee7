"""The set points of an emulated arm: one a cycle, the limits of the joints, and rest where none is commanded."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robots.drivers.emulation.kinematic_joints import KinematicJoints
from robots.drivers.emulation.plant import ArmPlant
from robots.drivers.universal_robots.emulator.pose_vectors import inverse_of, matrix_of, pose_of
from robots.drivers.universal_robots.emulator.ur_kinematics import UrKinematics
from robots.drivers.universal_robots.emulator.ur_models import JOINT_RANGE_RAD, ArmGeometry
from robots.port.arrays import Array

START_RAD = (0.0, -np.pi / 2, np.pi / 2, -np.pi / 2, -np.pi / 2, 0.0)
PROGRAM_STOP_RAD_S2 = 10.0
SAFETY_STOP_RAD_S2 = 30.0
"""How a program that ends, and a protective or emergency stop, bring the joints to rest. Not published; plausible."""
_SPEED_TOLERANCE = 1.02


class ArmLimitError(Exception):
    """A set point beyond the limits of a joint: the controller answers with a protective stop."""


class EmulatedArm:
    """`q`, `qd` and `qdd` are set points, `measured_q` and `measured_qd` what the plant makes of them."""

    def __init__(self, geometry: ArmGeometry, *, cycle_s: float, plant: ArmPlant | None = None) -> None:
        self.kinematics = UrKinematics(geometry)
        self.joint_speed_rad_s = np.array(geometry.joint_speed_rad_s)
        self.cycle_s = cycle_s
        self.plant: ArmPlant = plant or KinematicJoints(np.array(START_RAD))
        self.measured_q, self.measured_qd = self.plant.measured()
        self.q: Array = self.measured_q.copy()
        self.qd: Array = np.zeros(6)
        self.qdd: Array = np.zeros(6)
        self.tcp_offset: list[float] = [0.0] * 6
        self._next: Array | None = None
        self._tcp_pose: list[float] | None = None
        self._tcp_speed: list[float] | None = None

    @property
    def is_at_rest(self) -> bool:
        """Whether no joint moves."""
        return not self.qd.any()

    @property
    def tool(self) -> Array:
        """The tool centre point on the flange."""
        return matrix_of(self.tcp_offset)

    def tcp(self) -> Array:
        """Return the tool centre point in the base, as a matrix."""
        return self.kinematics.flange(self.q) @ self.tool

    def set_tcp_offset(self, pose: list[float]) -> None:
        """Place the tool centre point on the flange."""
        self.tcp_offset = pose
        self._tcp_pose = self._tcp_speed = None

    def tcp_pose(self) -> list[float]:
        """Return the tool centre point in the base, as a pose; computed once a cycle."""
        if self._tcp_pose is None:
            self._tcp_pose = pose_of(self.tcp())
        return self._tcp_pose

    def tcp_speed(self) -> list[float]:
        """Return the velocity of the tool centre point in the base."""
        if self.is_at_rest:
            return [0.0] * 6
        if self._tcp_speed is None:
            speed: Array = self.kinematics.jacobian(self.q, self.tool) @ self.qd
            self._tcp_speed = [float(value) for value in speed]
        return self._tcp_speed

    def measured_tcp_pose(self) -> list[float]:
        """Return the tool centre point at the measured joints."""
        if self.measured_q is self.q:
            return self.tcp_pose()
        return pose_of(self.kinematics.flange(self.measured_q) @ self.tool)

    def settle(self) -> None:
        """Take the measured joints as the set point, at rest, where the plant has not followed it."""
        if self.plant.problem:
            self.plant.reset()
            self.q, self.qd = self.plant.measured()[0].copy(), np.zeros(6)
            self._tcp_pose = self._tcp_speed = None

    def joints_for(
        self, tcp: Array, near: Sequence[float] | Array | None = None, tool: Array | None = None
    ) -> Array | None:
        """Return the joints that put the tool centre point there, or None."""
        return self.kinematics.inverse(
            tcp @ inverse_of(self.tool if tool is None else tool), self.q if near is None else near
        )

    def command(self, q: Array) -> None:
        """Set the joints for the end of this cycle; raises ArmLimitError."""
        if not np.isfinite(q).all():
            raise ArmLimitError("a joint set point is no number")
        beyond = np.abs(q) > JOINT_RANGE_RAD
        if beyond.any():
            raise ArmLimitError(f"joint {int(np.argmax(beyond))} would leave its range")
        fast = np.abs(q - self.q) > self.joint_speed_rad_s * self.cycle_s * _SPEED_TOLERANCE
        if fast.any():
            raise ArmLimitError(f"joint {int(np.argmax(fast))} would be faster than it can")
        self._next = q

    def finish_cycle(self, deceleration_rad_s2: float) -> None:
        """Move to the set point of this cycle; brake where there is none."""
        if self._next is None:
            if self.is_at_rest:
                self.qdd = np.zeros(6)
                self._measure()
                return
            self._next = self.q + self.braked(deceleration_rad_s2) * self.cycle_s
        qd = (self._next - self.q) / self.cycle_s
        qd[np.abs(qd) < 1e-9] = 0.0
        self.qdd = (qd - self.qd) / self.cycle_s
        self.q, self.qd, self._next = self._next, qd, None
        self._tcp_pose = self._tcp_speed = None
        self._measure()

    def _measure(self) -> None:
        self.plant.follow(self.q, self.qd)
        self.measured_q, self.measured_qd = self.plant.measured()

    def braked(self, deceleration: float, speed: float | None = None) -> Array:
        """Return the joint velocities one cycle of braking later; `speed` is what the deceleration refers to."""
        fastest = float(np.abs(self.qd).max()) if speed is None else speed
        step = deceleration * self.cycle_s
        return np.zeros(6) if fastest <= step else self.qd * (1.0 - step / fastest)
