"""The packets as typed structs: doubles, flags and modes, in SI units, in the order in which they are sent.

`orientation` has the four numbers of a quaternion as they are on the wire, see `quaternion_order.py`; joints are
radians.
"""

from __future__ import annotations

import math

import msgspec

from robots.reconcell.control_mode import ControlMode
from robots.reconcell.packet_errors import PacketRefused

Doubles = tuple[float, ...]

JOINTS = 6
KERNELS = 184
"""Values in the longest packet, 1472 bytes; this limit is one of the interface, not of the primitives."""
OFFSET_CENTERS = 100
_UNIT_TOLERANCE = 1e-3


class Packet(msgspec.Struct, frozen=True, kw_only=True):
    """Base of all packets; one that holds a senseless value cannot be made, and its ValueError says why."""


class ModeSelection(Packet, frozen=True, kw_only=True):
    """Port 10000: starts what the packets before it describe."""

    mode: int

    def __post_init__(self) -> None:
        if self.mode not in {each.value for each in ControlMode}:
            raise PacketRefused("wrong mode byte", f"{self.mode} is no mode", hint=f"one of {_modes()}")


class DirectJoints(Packet, frozen=True, kw_only=True):
    """Port 20000: one set point of direct joint control."""

    joints: Doubles


class DmpHeader(Packet, frozen=True, kw_only=True):
    """Ports 25000 and 25100: the first packet of a movement primitive; `kernels` is N.

    Of a Cartesian one, `goal` and `y0` are position and quaternion, else joints.
    """

    kernels: float
    a_z: float
    a_x: float
    tau: float
    goal: Doubles
    y0: Doubles
    dy0: Doubles

    def __post_init__(self) -> None:
        if not (self.kernels.is_integer() and 1 <= self.kernels <= KERNELS):
            raise ValueError(f"N is {self.kernels:g}: a whole number from 1 to {KERNELS}")
        for name, value in (("a_z", self.a_z), ("a_x", self.a_x), ("tau", self.tau)):
            if not value > 0.0:
                raise ValueError(f"{name} is {value:g}: it must be above 0")
        if len(self.goal) == JOINTS + 1:
            for name, row in (("goal", self.goal), ("y0", self.y0)):
                _check_quaternion(name, row[3:])


class KernelRow(Packet, frozen=True, kw_only=True):
    """One row of numbers for the kernels: centres, variances or weights; what is beyond N is not used."""

    values: Doubles


class DmpExecution(Packet, frozen=True, kw_only=True):
    """Ports 25009 and 25109: execute the loaded primitive, or end it and begin again."""

    execute: float
    reset: float

    def __post_init__(self) -> None:
        _check_flags(execute=self.execute, reset=self.reset)


class PhaseHold(Packet, frozen=True, kw_only=True):
    """Ports 25010 and 25110: the phase of the primitive stands still as long as this is 1."""

    stopped: float

    def __post_init__(self) -> None:
        _check_flags(stopped=self.stopped)


class TrapezoidGoal(Packet, frozen=True, kw_only=True):
    """Port 26000: the target of a trapezoidal motion and its speed, 1 for all that the arm can."""

    joints: Doubles
    speed: float

    def __post_init__(self) -> None:
        if not 0.0 < self.speed <= 1.0:
            raise ValueError(f"the speed is {self.speed:g}: above 0, at most 1")


class LineGoal(Packet, frozen=True, kw_only=True):
    """Port 27000, 64 bytes: the target of a line and its travel time."""

    position_m: Doubles
    orientation: Doubles
    duration_s: float

    def __post_init__(self) -> None:
        _check_quaternion("the orientation", self.orientation)
        if not self.duration_s > 0.0:
            raise ValueError(f"the travel time is {self.duration_s:g} s: it must be above 0")


class OutputBits(Packet, frozen=True, kw_only=True):
    """Port 11000: all digital outputs as one number, output k is its bit k."""

    value: float

    def __post_init__(self) -> None:
        if not (self.value.is_integer() and 0.0 <= self.value < 2.0**53):
            raise ValueError(f"{self.value:g} is no set of bits")


class ToolParameters(Packet, frozen=True, kw_only=True):
    """Port 12000: the tool and what the sensor at the wrist measures without a load."""

    xyz_m: Doubles
    orientation: Doubles
    com_m: Doubles
    mass_kg: float
    force_offset_n: Doubles
    torque_offset_nm: Doubles

    def __post_init__(self) -> None:
        _check_quaternion("the rotation", self.orientation)
        if self.mass_kg < 0.0:
            raise ValueError(f"the mass is {self.mass_kg:g} kg")


class RobotStatePacket(Packet, frozen=True, kw_only=True):
    """Port 15000: what is measured and commanded."""

    joints: Doubles
    desired_joints: Doubles
    velocity_rad_s: Doubles
    desired_velocity_rad_s: Doubles
    position_m: Doubles
    orientation: Doubles
    sensor_wrench: Doubles
    tool_wrench: Doubles
    outputs: float
    inputs: float


class RobotFlags(Packet, frozen=True, kw_only=True):
    """Port 15001: modes and flags."""

    received_mode: int
    sent_mode: int
    idle: int
    error: int
    running: int
    received: int
    finished: int


class DirectFlags(Packet, frozen=True, kw_only=True):
    """Port 15002: 1 in the first packet after a set point was received."""

    received: int


class TrajectoryFlags(Packet, frozen=True, kw_only=True):
    """Ports 15003 and 15004: of trapezoidal motions and of lines."""

    received: int
    finished: int


class DmpFlags(Packet, frozen=True, kw_only=True):
    """Ports 15005 and 15006: of Cartesian and joint primitives; `phase` falls from 1."""

    received: float
    loaded_id: float
    execute: float
    reset: float
    phase: float
    finished: float


def _modes() -> str:
    return ", ".join(f"{each.value} ({each.name.lower()})" for each in ControlMode)


def _check_flags(**flags: float) -> None:
    for name, value in flags.items():
        if value not in {0.0, 1.0}:
            raise ValueError(f"{name} is {value:g}: a flag is 0 or 1")


def _check_quaternion(name: str, values: Doubles) -> None:
    length = math.hypot(*values)
    if abs(length - 1.0) > _UNIT_TOLERANCE:
        raise ValueError(f"the quaternion of {name} has length {length:.4g} instead of 1")
