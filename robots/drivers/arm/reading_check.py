"""Whether a reading is one of this arm: as many values as it has joints, and all of them numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from robots.drivers.arm.joint_controller import ControllerReading
from robots.port import Array

_WRENCH = ("force x", "force y", "force z", "torque x", "torque y", "torque z")


def invalid_value(reading: ControllerReading, joints: Sequence[str]) -> str:
    """Return the first value of a reading that cannot be measured, with joint and value; empty if all can."""
    # Of a thousand readings a second all are valid: a sum takes a few microseconds, and is finite if they are.
    return "" if _is_valid(reading, len(joints)) else _first_invalid(reading, joints)


def _is_valid(reading: ControllerReading, dof: int) -> bool:
    position, velocity, effort = reading.position_rad, reading.velocity_rad_s, reading.effort_nm
    if not position.shape == velocity.shape == effort.shape == (dof,):
        return False
    total = reading.time_s + reading.speed_scaling + sum(position.tolist()) + sum(velocity.tolist())
    total += sum(effort.tolist())
    if reading.held_rad is not None:
        total += sum(reading.held_rad.tolist()) if reading.held_rad.shape == (dof,) else math.nan
    if reading.wrench is not None:
        total += sum(reading.wrench.tolist()) if reading.wrench.shape == (len(_WRENCH),) else math.nan
    return math.isfinite(total)


def _first_invalid(reading: ControllerReading, joints: Sequence[str]) -> str:
    for values, names, what, unit in _quantities(reading, joints):
        if values.shape != (len(names),):
            return f"it has {values.size} values of {what}, expected {len(names)}"
        is_finite = np.isfinite(values)
        if not is_finite.all():
            first = int(np.argmin(is_finite))
            return f"{what} of {names[first]} is {values[first]} {unit}"
    for name, value in (("time", reading.time_s), ("speed scaling", reading.speed_scaling)):
        if not math.isfinite(value):
            return f"{name} is {value}"
    return ""


def _quantities(reading: ControllerReading, joints: Sequence[str]) -> Iterator[tuple[Array, Sequence[str], str, str]]:
    yield reading.position_rad, joints, "position", "rad"
    yield reading.velocity_rad_s, joints, "velocity", "rad/s"
    yield reading.effort_nm, joints, "effort", "Nm"
    if reading.held_rad is not None:
        yield reading.held_rad, joints, "held set point", "rad"
    if reading.wrench is not None:
        yield reading.wrench, _WRENCH, "wrench", ""
