"""Validates arm settings: lengths, signs and the upper bounds from the arm's model."""

from __future__ import annotations

import math

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.control.laws.joint_impedance import nominal_stiffness_nm_rad
from robots.model.robot_model import JointLimits

LEAST_SPEED_OVERRIDE = 0.001
"""At a smaller share of its speed a motion would look stalled."""

_LEAST_DAMPING_RATIO, _MOST_DAMPING_RATIO = 0.1, 2.0
# Multiple of a joint's nominal stiffness: still slow compared to a control period of 1 or 2 ms.
_MOST_JOINT_STIFFNESS = 3.0
# The strongest joint reaches its full torque at 1 cm on a lever of 1 m, the weakest at 25 mrad.
_MOST_STIFFNESS_PER_NM = 100.0
_MOST_TURN_STIFFNESS_PER_NM = 40.0
_MOST_UNUSED = 1e9
_GRAVITY_M_S2 = 9.81
_FARTHEST_TOOL_M, _FARTHEST_LOAD_M = 2.0, 1.0


def validate_settings(
    settings: ControlSettings, *, arm: str, joints: tuple[str, ...], limits: JointLimits
) -> ControlSettings:
    """Return `settings` if an arm with these joints can work with them.

    Raises:
        RobotError: names the setting, its value and the valid range; `where` is `arm`.
    """
    try:
        _check_controller(settings, joints, limits)
        _check_tool_and_load(settings, limits)
        _check_thresholds(settings, joints)
        _within("speed_override", settings.speed_override, least=LEAST_SPEED_OVERRIDE, most=1.0)
    except RobotError as error:
        raise RobotError(error.message, where=arm, hint=error.hint) from None
    return settings


def _check_controller(settings: ControlSettings, joints: tuple[str, ...], limits: JointLimits) -> None:
    nominal = nominal_stiffness_nm_rad(limits).tolist()
    if settings.joint_stiffness_nm_rad:
        _count("joint_stiffness_nm_rad", settings.joint_stiffness_nm_rad, joints)
        for joint, value, usual in zip(joints, settings.joint_stiffness_nm_rad, nominal, strict=True):
            most = _MOST_JOINT_STIFFNESS * usual
            _within(f"joint_stiffness_nm_rad of {joint}", value, least=0.0, most=most, above=True)
    for what in ("joint_damping_ratio", "cartesian_damping_ratio"):
        _within(what, getattr(settings, what), least=_LEAST_DAMPING_RATIO, most=_MOST_DAMPING_RATIO)
    push, turn = max(limits.effort_nm) * _MOST_STIFFNESS_PER_NM, min(limits.effort_nm) * _MOST_TURN_STIFFNESS_PER_NM
    if settings.controller != "cartesian_impedance":
        # The default is too stiff for a small arm; it matters only while that controller is in use.
        push = turn = _MOST_UNUSED
    for axis, value in zip(("x", "y", "z", "rx", "ry", "rz"), settings.cartesian_stiffness, strict=True):
        most = turn if axis.startswith("r") else push
        _within(f"cartesian_stiffness along {axis}", value, least=0.0, most=most)
    most = _MOST_JOINT_STIFFNESS * max(nominal)
    if settings.nullspace_stiffness_nm_rad is not None:
        _within("nullspace_stiffness_nm_rad", settings.nullspace_stiffness_nm_rad, least=0.0, most=most)


def _check_tool_and_load(settings: ControlSettings, limits: JointLimits) -> None:
    for value in settings.tool_xyz_m:
        _within("tool_xyz_m", value, least=-_FARTHEST_TOOL_M, most=_FARTHEST_TOOL_M)
    if not abs(math.hypot(*settings.tool_xyzw) - 1.0) < 1e-3:
        raise RobotError(f"tool_xyzw {settings.tool_xyzw} is not a unit quaternion", hint="give x y z w of length 1")
    _within("load_kg", settings.load_kg, least=0.0, most=max(limits.effort_nm) / _GRAVITY_M_S2)
    for value in settings.load_com_m:
        _within("load_com_m", value, least=-_FARTHEST_LOAD_M, most=_FARTHEST_LOAD_M)


def _check_thresholds(settings: ControlSettings, joints: tuple[str, ...]) -> None:
    if settings.collision_torque_nm:
        _count("collision_torque_nm", settings.collision_torque_nm, joints)
        for joint, value in zip(joints, settings.collision_torque_nm, strict=True):
            _within(f"collision_torque_nm of {joint}", value, least=0.0, most=math.inf, above=True)
    if settings.collision_force_n is not None:
        _within("collision_force_n", settings.collision_force_n, least=0.0, most=math.inf, above=True)


def _count(what: str, values: tuple[float, ...], joints: tuple[str, ...]) -> None:
    if len(values) != len(joints):
        raise RobotError(
            f"{what} has {len(values)} values", hint=f"give one for each of the {len(joints)} joints, or none"
        )


def _within(what: str, value: float, *, least: float, most: float, above: bool = False) -> None:
    """Reject a value outside [least, most], or ]least, most] with `above`; infinity and NaN are always outside."""
    if math.isfinite(value) and (value > least if above else value >= least) and value <= most:
        return
    lower = f"more than {least:g}" if above else f"at least {least:g}"
    raise RobotError(f"{what} cannot be {value:g}", hint=lower + (f" and at most {most:g}" if most < math.inf else ""))
