"""Exciting motions: joints swing about the start within their limits, and end where they began."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.errors import RobotError
from robots.model.robot_model import JointLimits
from robots.port import Array, JointTrajectory

_STEP_S = 0.004
# Shares of the limits of velocity, acceleration and jerk that an excitation uses.
_VELOCITY_SHARE, _ACCELERATION_SHARE, _JERK_SHARE = 0.5, 0.4, 0.4
# Distance that is kept from the range of a joint.
_MARGIN_RAD = 0.05
_LEAST_RAD = 0.1
_WRIST_S, _JOINT_S = 12.0, 6.0
_JOINT_SWINGS = 2


def swing_wrist(start: Array, *, amplitude_rad: float, limits: JointLimits, joints: tuple[str, ...]) -> JointTrajectory:
    """Return a motion in which the last three joints swing once, twice and three times, by a finite Fourier series.

    Different whole numbers of swings give orientations that do not repeat (Swevers et al., Optimal robot excitation
    and identification, T-RA 1997).

    Raises:
        RobotError: a joint has no room.
    """
    moved = range(max(0, len(start) - 3), len(start))
    swings = {joint: 1 + at for at, joint in enumerate(moved)}
    room = {joint: _room_rad(joint, start, amplitude_rad, limits, joints) for joint in moved}
    return _swing(start, swings, room, least_s=_WRIST_S, limits=limits)


def swing_joints(
    start: Array, moved: Sequence[int], *, amplitude_rad: float, limits: JointLimits, joints: tuple[str, ...]
) -> JointTrajectory:
    """Return a motion in which each of these joints in turn swings twice, at speeds from zero to a greatest one.

    Raises:
        RobotError: a joint has no room.
    """
    parts: list[JointTrajectory] = []
    for joint in moved:
        room = {joint: _room_rad(joint, start, amplitude_rad, limits, joints)}
        parts.append(_swing(start, {joint: _JOINT_SWINGS}, room, least_s=_JOINT_S, limits=limits))
    return JointTrajectory(
        dt_s=_STEP_S,
        position_rad=np.concatenate([parts[0].position_rad, *(part.position_rad[1:] for part in parts[1:])]),
        velocity_rad_s=np.concatenate([parts[0].velocity_rad_s, *(part.velocity_rad_s[1:] for part in parts[1:])]),
    )


def _room_rad(joint: int, start: Array, amplitude_rad: float, limits: JointLimits, joints: tuple[str, ...]) -> float:
    """Return the amplitude that a joint has room for, at most `amplitude_rad`."""
    below, above = start[joint] - limits.lower_rad[joint], limits.upper_rad[joint] - start[joint]
    room = float(min(below, above)) - _MARGIN_RAD
    if room < _LEAST_RAD:
        raise RobotError(
            f"{joints[joint]} at {start[joint]:.2f} rad has {max(0.0, room):.2f} rad of room to swing,"
            f" {_LEAST_RAD:g} rad are needed",
            hint="move the arm to a configuration away from the limits of its joints",
        )
    return min(amplitude_rad, room)


def _swing(
    start: Array, swings: dict[int, int], amplitude_rad: dict[int, float], *, least_s: float, limits: JointLimits
) -> JointTrajectory:
    """Return sines under a window that begins and ends at rest, as slow as the limits of all joints require."""
    slowed = 1.0
    u = np.linspace(0.0, 1.0, 2001)
    for joint, count in swings.items():
        shape = amplitude_rad[joint] * _windowed_sine(u, count)
        for order, (limit, share) in enumerate(
            (
                (limits.velocity_rad_s[joint], _VELOCITY_SHARE),
                (limits.acceleration_rad_s2[joint], _ACCELERATION_SHARE),
                (limits.jerk_rad_s3[joint], _JERK_SHARE),
            ),
            1,
        ):
            shape = np.gradient(shape, u)
            peak = float(np.abs(shape).max()) / least_s**order
            slowed = max(slowed, (peak / (share * limit)) ** (1.0 / order))
    duration_s = least_s * slowed
    count_steps = int(np.ceil(duration_s / _STEP_S))
    u = np.arange(count_steps + 1) / count_steps
    position = np.tile(start, (count_steps + 1, 1))
    velocity = np.zeros_like(position)
    for joint, count in swings.items():
        position[:, joint] += amplitude_rad[joint] * _windowed_sine(u, count)
        velocity[:, joint] = amplitude_rad[joint] * _windowed_sine_rate(u, count) / (count_steps * _STEP_S)
    position[-1] = start
    velocity[[0, -1]] = 0.0
    return JointTrajectory(dt_s=_STEP_S, position_rad=position, velocity_rad_s=velocity)


def _windowed_sine(u: Array, count: int) -> Array:
    return np.sin(np.pi * u) ** 2 * np.sin(2.0 * np.pi * count * u)


def _windowed_sine_rate(u: Array, count: int) -> Array:
    phase = 2.0 * np.pi * count
    return np.pi * np.sin(2.0 * np.pi * u) * np.sin(phase * u) + np.sin(np.pi * u) ** 2 * phase * np.cos(phase * u)
