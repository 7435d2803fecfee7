"""What an FR3 permits near the ends of its joints, where it is less than in the middle."""

from __future__ import annotations

import numpy as np

from robots.port import Array

# Per joint: speed in the middle, then offset, gain and the two ends of the square root by which it falls towards them
# (Franka, robot and interface specifications, limits of the FR3).
_SPEED_RAD_S = np.array((2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26))
_OFFSET_RAD_S = np.array((0.30, 0.20, 0.20, 0.30, 0.35, 0.35, 0.35))
_GAIN_RAD_S2 = np.array((12.0, 5.17, 7.0, 8.0, 34.0, 11.0, 34.0))
_UPPER_RAD = np.array((2.75010, 1.79180, 2.90650, -0.1458, 2.81010, 4.52050, 3.01960))
_LOWER_RAD = np.array((-2.75010, -1.79180, -2.90650, -3.0481, -2.81010, 0.54092, -3.01960))


def upper_velocity_rad_s(position_rad: Array) -> Array:
    """Return the greatest permitted velocity at joint angles, (7,); 0 at the upper ends."""
    return _speed(_UPPER_RAD - position_rad)


def lower_velocity_rad_s(position_rad: Array) -> Array:
    """Return the least permitted velocity, which is negative; 0 at the lower ends."""
    return -_speed(position_rad - _LOWER_RAD)


def limit_violation(position_rad: Array, velocity_rad_s: Array) -> str:
    """Return which joint exceeds what the robot permits there; empty if none does."""
    upper, lower = upper_velocity_rad_s(position_rad), lower_velocity_rad_s(position_rad)
    beyond = (velocity_rad_s > upper) | (velocity_rad_s < lower)
    if not beyond.any():
        return ""
    joint = int(np.argmax(beyond))
    permitted = upper[joint] if velocity_rad_s[joint] > 0.0 else lower[joint]
    return (
        f"joint {joint + 1} would move at {velocity_rad_s[joint]:.2f} rad/s, and at {position_rad[joint]:.2f} rad "
        f"the robot permits {permitted:.2f} rad/s"
    )


def _speed(distance_rad: Array) -> Array:
    falling = np.sqrt(np.maximum(0.0, _GAIN_RAD_S2 * distance_rad)) - _OFFSET_RAD_S
    return np.minimum(_SPEED_RAD_S, np.maximum(0.0, falling))
