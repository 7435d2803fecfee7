"""Functions of URScript that take time: motions, and waiting."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from robots.drivers.universal_robots.emulator.arm_motions import (
    Motion,
    UnreachableError,
    move_joints,
    move_tool,
    servo_joints,
    speed_joints,
    speed_tool,
    stop_joints,
    stop_tool,
)
from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.pose_vectors import matrix_of
from robots.drivers.universal_robots.emulator.urscript.urscript_values import UrscriptArguments, UrscriptList
from robots.port.arrays import Array

TimedFunction = Callable[[ControllerState, UrscriptArguments], Motion]


def _sync(_controller: ControllerState, _arguments: UrscriptArguments) -> Motion:
    yield


def _sleep(controller: ControllerState, arguments: UrscriptArguments) -> Motion:
    end_s = controller.time_s + arguments.number(0, "t")
    while controller.time_s < end_s:
        yield


def _joints(controller: ControllerState, arguments: UrscriptArguments, name: str) -> Array:
    """Return the joints of a target that is a list of joints or a pose."""
    value = arguments.value(0, name)
    if not (isinstance(value, UrscriptList) and value.is_pose):
        return arguments.six(0, name)
    q = controller.arm.joints_for(matrix_of(arguments.six(0, name)))
    if q is None:
        raise UnreachableError("the target has no inverse kinematics")
    return q


def _pose(controller: ControllerState, arguments: UrscriptArguments, name: str) -> Array:
    value = arguments.value(0, name)
    if isinstance(value, UrscriptList) and value.is_pose:
        return matrix_of(arguments.six(0, name))
    return controller.arm.kinematics.flange(arguments.six(0, name)) @ controller.arm.tool


def _movej(controller: ControllerState, arguments: UrscriptArguments) -> Motion:
    yield from move_joints(
        controller,
        _joints(controller, arguments, "q"),
        acceleration=arguments.number(1, "a", 1.4),
        speed=arguments.number(2, "v", 1.05),
        time_s=arguments.number(3, "t", 0.0),
    )


def _movel(controller: ControllerState, arguments: UrscriptArguments) -> Motion:
    """`movel`, and `movep` and `servoc` without their blends: the arm stops at each target."""
    yield from move_tool(
        controller,
        _pose(controller, arguments, "pose"),
        acceleration=arguments.number(1, "a", 1.2),
        speed=arguments.number(2, "v", 0.25),
        time_s=arguments.number(3, "t", 0.0) if "r" not in arguments.by_name else 0.0,
    )


def _servoj(controller: ControllerState, arguments: UrscriptArguments) -> Motion:
    yield from servo_joints(
        controller,
        _joints(controller, arguments, "q"),
        time_s=arguments.number(3, "t", 0.008),
        lookahead_s=arguments.number(4, "lookahead_time", 0.1),
    )


def _speedj(controller: ControllerState, arguments: UrscriptArguments) -> Motion:
    yield from speed_joints(
        controller,
        arguments.six(0, "qd"),
        acceleration=arguments.number(1, "a", 1.4),
        time_s=arguments.number(2, "t", 0.0),
    )


def _speedl(controller: ControllerState, arguments: UrscriptArguments) -> Motion:
    yield from speed_tool(
        controller,
        arguments.six(0, "xd"),
        acceleration=arguments.number(1, "a", 1.2),
        time_s=arguments.number(2, "t", 0.0),
    )


TIMED_FUNCTIONS: Mapping[str, TimedFunction] = {
    "sync": _sync,
    "sleep": _sleep,
    "movej": _movej,
    "movel": _movel,
    "movep": _movel,
    "servoc": _movel,
    "servoj": _servoj,
    "speedj": _speedj,
    "speedl": _speedl,
    "stopj": lambda c, a: stop_joints(c, a.number(0, "a", 2.0)),
    "stopl": lambda c, a: stop_tool(c, a.number(0, "a", 20.0)),
}
