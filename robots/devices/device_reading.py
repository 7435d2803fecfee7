"""What the sensors of a device tell: the position where it is, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Mapping

from engine.document import DeviceSensor, DeviceSpec
from engine.skills.device_moves import BETWEEN, UNKNOWN, DeviceReading


def sensed_position(device: DeviceSpec, sensors: Mapping[str, bool]) -> str:
    """Return the position that sensors tell, `between` for none of those that they tell, `unknown` without any."""
    sensed = {name: one.sensors for name, one in device.positions.items() if one.sensors}
    at = (name for name, due in sensed.items() if all(sensors[sensor] == on for sensor, on in due.items()))
    return next(at, BETWEEN if sensed else UNKNOWN)


def contradiction(device: DeviceSpec, sensors: Mapping[str, bool]) -> str:
    """Return which two sensors of one axis are on that cannot both be on; empty for none."""
    on = [(name, sensor) for name, sensor in device.sensors.items() if sensor.axis is not None and sensors[name]]
    for index, (name, sensor) in enumerate(on):
        for other_name, other in on[index + 1 :]:
            if sensor.axis == other.axis and _apart(sensor, other):
                return f"the sensors {name} and {other_name} of the axis {sensor.axis} are both on"
    return ""


def is_at(device: DeviceSpec, reading: DeviceReading, position: str) -> bool:
    """Return whether it is at a position: sensed where sensors tell it, else commanded and its time has passed."""
    if reading.moving or reading.problem:
        return False
    if device.positions[position].sensors:
        return reading.sensed == position
    return reading.commanded == position and reading.timed


def has_air(device: DeviceSpec, sensors: Mapping[str, bool]) -> bool:
    """Return whether the pressure switch is on; true without one, as nothing tells."""
    return not device.air_sensor or sensors[device.air_sensor]


def _apart(one: DeviceSensor, other: DeviceSensor) -> bool:
    """Return whether no place of the axis turns both on."""
    return _below(one, other) or _below(other, one)


def _below(low: DeviceSensor, high: DeviceSensor) -> bool:
    return low.at_most is not None and high.at_least is not None and low.at_most < high.at_least
