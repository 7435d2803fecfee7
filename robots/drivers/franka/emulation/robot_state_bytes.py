"""Where the fields of a robot state are in its datagram (protocol 10), for reading it and for changing its errors."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from robots.drivers.franka.franka_faults import FrankaMode

_HEADER = 8
_SIZE = 1377
_Q, _DQ = _HEADER + 4 * 147, _HEADER + 4 * 161
_F_T_EE, _LOAD = _HEADER + 4 * 32, _HEADER + 4 * 109
_WRENCHES = _HEADER + 4 * 215
# The last bytes: generator and controller mode, errors, reasons of the reflex, robot mode, success rate.
_ERRORS, _REASONS, _MODE = -87, -46, -5
_ERROR_COUNT = 41
ERROR_NAMES = (
    "joint_position_limits_violation", "cartesian_position_limits_violation", "self_collision_avoidance_violation",
    "joint_velocity_violation", "cartesian_velocity_violation", "force_control_safety_violation", "joint_reflex",
    "cartesian_reflex", "max_goal_pose_deviation_violation", "max_path_pose_deviation_violation",
    "cartesian_velocity_profile_safety_violation", "joint_position_motion_generator_start_pose_invalid",
    "joint_motion_generator_position_limits_violation", "joint_motion_generator_velocity_limits_violation",
    "joint_motion_generator_velocity_discontinuity", "joint_motion_generator_acceleration_discontinuity",
    "cartesian_position_motion_generator_start_pose_invalid", "cartesian_motion_generator_elbow_limit_violation",
    "cartesian_motion_generator_velocity_limits_violation", "cartesian_motion_generator_velocity_discontinuity",
    "cartesian_motion_generator_acceleration_discontinuity", "cartesian_motion_generator_elbow_sign_inconsistent",
    "cartesian_motion_generator_start_elbow_invalid", "force_controller_desired_force_tolerance_violation",
    "start_elbow_sign_inconsistent", "communication_constraints_violation", "power_limit_violation",
)  # fmt: skip
"""In the order of the protocol, up to the last that is emulated."""


@dataclass(frozen=True, kw_only=True)
class RobotStateFields:
    """What the side channel tells of a robot state."""

    time_s: float
    q: tuple[float, ...]
    dq: tuple[float, ...]
    mode: FrankaMode
    tcp_m: tuple[float, float, float]
    load_kg: float


def is_robot_state(datagram: bytes) -> bool:
    """Return whether a datagram has the size of a robot state."""
    return len(datagram) == _SIZE


def read_robot_state(datagram: bytes) -> RobotStateFields:
    """Return the fields of a robot state."""
    frame = struct.unpack_from("<16f", datagram, _F_T_EE)
    return RobotStateFields(
        time_s=struct.unpack_from("<Q", datagram)[0] / 1000.0,
        q=struct.unpack_from("<7f", datagram, _Q),
        dq=struct.unpack_from("<7f", datagram, _DQ),
        mode=FrankaMode(datagram[_MODE]),
        tcp_m=(frame[12], frame[13], frame[14]),
        load_kg=struct.unpack_from("<f", datagram, _LOAD)[0],
    )


def write_errors(datagram: bytearray, *, mode: FrankaMode, errors: Iterable[str]) -> None:
    """Set mode, errors and the reasons of a reflex."""
    flags = bytearray(_ERROR_COUNT)
    for name in errors:
        flags[ERROR_NAMES.index(name)] = 1
    end = len(datagram)
    datagram[end + _ERRORS : end + _ERRORS + _ERROR_COUNT] = flags
    datagram[end + _REASONS : end + _REASONS + _ERROR_COUNT] = flags
    datagram[_MODE] = int(mode)


def write_wrench(datagram: bytearray, wrench: Sequence[float]) -> None:
    """Set what the tool exerts on its environment, in the axes of the base and, alike, of the tool."""
    struct.pack_into("<12f", datagram, _WRENCHES, *wrench, *wrench)
