"""Functions of URScript that take no time: mathematics, poses, kinematics, settings, registers, inputs and outputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from robots.drivers.universal_robots.emulator.arm_motions import UnreachableError
from robots.drivers.universal_robots.emulator.controller_state import REGISTERS, ControllerState
from robots.drivers.universal_robots.emulator.pose_vectors import (
    interpolate,
    inverse_of,
    matrix_of,
    pose_of,
    rotation_of,
    rotation_vector_of,
)
from robots.drivers.universal_robots.emulator.ur_models import JOINT_RANGE_RAD
from robots.drivers.universal_robots.emulator.urscript.urscript_values import (
    UrscriptArguments,
    UrscriptList,
    UrscriptValue,
    list_value,
    number_of,
    pose_value,
    text_of,
)
from robots.port.arrays import Array

Function = Callable[[ControllerState, UrscriptArguments], UrscriptValue]


def _of_one(function: Callable[[float], float]) -> Function:
    return lambda _c, a: function(a.number(0, "f"))


def _of_two(function: Callable[[float, float], float]) -> Function:
    return lambda _c, a: function(a.number(0, "x"), a.number(1, "y"))


def _matrix(arguments: UrscriptArguments, position: int, name: str) -> Array:
    return matrix_of(arguments.six(position, name))


def _nothing(_controller: ControllerState, _arguments: UrscriptArguments) -> None:
    """Accept a call without an effect: there is no physics behind the arm."""


def _norm(_controller: ControllerState, arguments: UrscriptArguments) -> float:
    value = arguments.value(0, "a")
    if isinstance(value, UrscriptList):
        return math.sqrt(sum(number_of(item) ** 2 for item in value))
    return abs(number_of(value))


def _length(_controller: ControllerState, arguments: UrscriptArguments) -> int:
    value = arguments.value(0, "v")
    return len(value) if isinstance(value, (UrscriptList, str)) else 1


def _pose_sub(_controller: ControllerState, arguments: UrscriptArguments) -> UrscriptValue:
    left, right = _matrix(arguments, 0, "p_to"), _matrix(arguments, 1, "p_from")
    rotation = rotation_vector_of(left[:3, :3] @ right[:3, :3].T)
    return pose_value([*(left[:3, 3] - right[:3, 3]).tolist(), *rotation.tolist()])


def _pose_add(_controller: ControllerState, arguments: UrscriptArguments) -> UrscriptValue:
    left, right = _matrix(arguments, 0, "p_1"), _matrix(arguments, 1, "p_2")
    rotation = rotation_vector_of(left[:3, :3] @ right[:3, :3])
    return pose_value([*(left[:3, 3] + right[:3, 3]).tolist(), *rotation.tolist()])


def _interpolate_pose(_controller: ControllerState, arguments: UrscriptArguments) -> UrscriptValue:
    start, end = _matrix(arguments, 0, "p_from"), _matrix(arguments, 1, "p_to")
    return pose_value(pose_of(interpolate(start, end, arguments.number(2, "alpha"))))


def _rpy_to_rotation_vector(_controller: ControllerState, arguments: UrscriptArguments) -> UrscriptValue:
    roll, pitch, yaw = arguments.three(0, "rpy")
    rotation = rotation_of((0.0, 0.0, yaw)) @ rotation_of((0.0, pitch, 0.0)) @ rotation_of((roll, 0.0, 0.0))
    return list_value(rotation_vector_of(rotation))


def _forward(controller: ControllerState, arguments: UrscriptArguments) -> UrscriptValue:
    arm = controller.arm
    q = arguments.six(0, "q") if arguments.has(0, "q") else arm.q
    tool = _matrix(arguments, 1, "tcp") if arguments.has(1, "tcp") else arm.tool
    return pose_value(pose_of(arm.kinematics.flange(q) @ tool))


def _inverse_or_none(controller: ControllerState, arguments: UrscriptArguments) -> Array | None:
    near = arguments.six(1, "qnear") if arguments.has(1, "qnear") else None
    tool = _matrix(arguments, 4, "tcp") if arguments.has(4, "tcp") else None
    return controller.arm.joints_for(_matrix(arguments, 0, "x"), near, tool)


def _inverse(controller: ControllerState, arguments: UrscriptArguments) -> UrscriptValue:
    q = _inverse_or_none(controller, arguments)
    if q is None:
        raise UnreachableError("get_inverse_kin has no solution")
    return list_value(q)


def _within_limits(controller: ControllerState, arguments: UrscriptArguments) -> bool:
    value = arguments.value(0, "pose")
    if isinstance(value, UrscriptList) and value.is_pose:
        return controller.arm.joints_for(_matrix(arguments, 0, "pose")) is not None
    return bool((np.abs(arguments.six(0, "qvec")) <= JOINT_RANGE_RAD).all())


def _set_tcp(controller: ControllerState, arguments: UrscriptArguments) -> None:
    controller.arm.set_tcp_offset(arguments.six(0, "pose").tolist())


def _set_payload(controller: ControllerState, arguments: UrscriptArguments) -> None:
    controller.payload_kg = arguments.number(0, "m")
    if arguments.has(1, "cog"):
        controller.payload_cog_m = arguments.three(1, "cog")


def _set_target_payload(controller: ControllerState, arguments: UrscriptArguments) -> None:
    _set_payload(controller, arguments)
    if arguments.has(2, "inertia"):
        controller.payload_inertia_kgm2 = tuple(arguments.six(2, "inertia").tolist())


def _write_int(controller: ControllerState, arguments: UrscriptArguments) -> None:
    controller.set_output_int(arguments.index(0, "address", REGISTERS), arguments.integer(1, "value"))


def _write_double(controller: ControllerState, arguments: UrscriptArguments) -> None:
    controller.output_doubles[arguments.index(0, "address", REGISTERS)] = arguments.number(1, "value")


def _digital_output(count: int, shift: int) -> Function:
    def write(controller: ControllerState, arguments: UrscriptArguments) -> None:
        bit = 1 << shift + arguments.index(0, "n", count)
        controller.set_digital_outputs(bit, bit if arguments.value(1, "b") else 0)

    return write


def _digital_input(count: int, shift: int) -> Function:
    return lambda c, a: bool(c.digital_inputs >> shift + a.index(0, "n", count) & 1)


def _watchdog(controller: ControllerState, arguments: UrscriptArguments) -> None:
    action = text_of(arguments.value(2, "action")) if arguments.has(2, "action") else "pause"
    variable = text_of(arguments.value(0, "variable_name"))
    controller.set_watchdog(variable, arguments.number(1, "min_frequency"), action)


def _text_message(controller: ControllerState, arguments: UrscriptArguments) -> None:
    controller.messages.append("".join(text_of(value) for value in arguments.by_position))


FUNCTIONS: Mapping[str, Function] = {
    **{name: _of_one(getattr(math, name)) for name in ("sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "log10")},
    "ceil": _of_one(math.ceil),
    "floor": _of_one(math.floor),
    "d2r": _of_one(math.radians),
    "r2d": _of_one(math.degrees),
    "atan2": _of_two(math.atan2),
    "pow": _of_two(math.pow),
    "norm": _norm,
    "length": _length,
    "to_str": lambda _c, a: text_of(a.value(0, "val")),
    "pose_trans": lambda _c, a: pose_value(pose_of(_matrix(a, 0, "p_from") @ _matrix(a, 1, "p_from_to"))),
    "pose_inv": lambda _c, a: pose_value(pose_of(inverse_of(_matrix(a, 0, "p_from")))),
    "pose_sub": _pose_sub,
    "pose_add": _pose_add,
    "pose_dist": lambda _c, a: float(np.linalg.norm(a.six(0, "p_from")[:3] - a.six(1, "p_to")[:3])),
    "interpolate_pose": _interpolate_pose,
    "rpy2rotvec": _rpy_to_rotation_vector,
    "get_forward_kin": _forward,
    "get_inverse_kin": _inverse,
    "get_inverse_kin_has_solution": lambda c, a: _inverse_or_none(c, a) is not None,
    "is_within_safety_limits": _within_limits,
    "is_steady": lambda c, _a: c.arm.is_at_rest,
    "get_actual_joint_positions": lambda c, _a: list_value(c.arm.measured_q),
    "get_target_joint_positions": lambda c, _a: list_value(c.arm.q),
    "get_actual_joint_positions_history": lambda c, _a: list_value(c.arm.q),
    "get_actual_joint_speeds": lambda c, _a: list_value(c.arm.measured_qd),
    "get_target_joint_speeds": lambda c, _a: list_value(c.arm.qd),
    "get_actual_tcp_pose": lambda c, _a: pose_value(c.arm.measured_tcp_pose()),
    "get_target_tcp_pose": lambda c, _a: pose_value(c.arm.tcp_pose()),
    "get_target_waypoint": lambda c, _a: pose_value(c.arm.tcp_pose()),
    "get_actual_tcp_speed": lambda c, _a: list_value(c.arm.tcp_speed()),
    "get_target_tcp_speed": lambda c, _a: list_value(c.arm.tcp_speed()),
    "get_actual_tool_flange_pose": lambda c, _a: pose_value(pose_of(c.arm.kinematics.flange(c.arm.q))),
    "get_tcp_force": lambda c, _a: list_value(c.tcp_force_n),
    "get_tcp_offset": lambda c, _a: pose_value(c.arm.tcp_offset),
    "get_joint_torques": lambda _c, _a: list_value([0.0] * 6),
    "get_steptime": lambda c, _a: c.arm.cycle_s,
    "get_target_payload": lambda c, _a: c.payload_kg,
    "get_target_payload_cog": lambda c, _a: list_value(c.payload_cog_m),
    "get_target_payload_inertia": lambda c, _a: list_value(c.payload_inertia_kgm2),
    "tool_contact": lambda c, _a: c.contact_steps,
    "set_tcp": _set_tcp,
    "set_payload": _set_payload,
    "set_target_payload": _set_target_payload,
    "read_input_integer_register": lambda c, a: c.input_ints[a.index(0, "address", REGISTERS)],
    "read_input_float_register": lambda c, a: c.input_doubles[a.index(0, "address", REGISTERS)],
    "write_output_integer_register": _write_int,
    "write_output_float_register": _write_double,
    "set_standard_digital_out": _digital_output(8, 0),
    "set_configurable_digital_out": _digital_output(8, 8),
    "set_tool_digital_out": _digital_output(2, 16),
    # Outputs 8 and 9 of the old function are those of the tool.
    "set_digital_out": lambda c, a: (
        _digital_output(8, 0)(c, a)
        if a.integer(0, "n") < 8
        else _digital_output(2, 16)(c, UrscriptArguments([a.integer(0, "n") - 8, a.value(1, "b")], {}))
    ),
    "get_standard_digital_in": _digital_input(8, 0),
    "get_digital_in": _digital_input(8, 0),
    "get_configurable_digital_in": _digital_input(8, 8),
    "get_tool_digital_in": _digital_input(2, 16),
    "get_standard_digital_out": lambda c, a: bool(c.digital_outputs >> a.index(0, "n", 8) & 1),
    "rtde_set_watchdog": _watchdog,
    "textmsg": _text_message,
    "popup": _text_message,
    "protective_stop": lambda c, _a: c.protective_stop("by the program"),
    "get_freedrive_status": lambda _c, _a: 0,
    **dict.fromkeys(
        (
            "zero_ftsensor",
            "force_mode",
            "end_force_mode",
            "force_mode_set_damping",
            "force_mode_set_gain_scaling",
            "teach_mode",
            "end_teach_mode",
            "freedrive_mode",
            "end_freedrive_mode",
            "ft_rtde_input_enable",
            "enable_external_ft_sensor",
            "set_gravity",
        ),
        _nothing,
    ),
}
