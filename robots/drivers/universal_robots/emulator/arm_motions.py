"""The motions of URScript, as generators: each sets one set point and yields once a cycle, and ends with the motion."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from robots.drivers.universal_robots.emulator.controller_state import ControllerState
from robots.drivers.universal_robots.emulator.pose_vectors import interpolate, rotation_vector_of
from robots.port.arrays import Array

Motion = Generator[None, None, None]
_SERVO_ACCELERATION_RAD_S2 = 40.0
_STEADY_M_S = 1e-4


class UnreachableError(Exception):
    """A pose that has no inverse kinematics: the program ends."""


@dataclass(frozen=True, slots=True)
class TrapezoidalTiming:
    """Distance over time with one acceleration, one speed, and the same deceleration."""

    distance: float
    speed: float
    acceleration: float

    @property
    def peak_speed(self) -> float:
        """The speed that is reached."""
        return min(self.speed, math.sqrt(self.distance * self.acceleration))

    @property
    def duration_s(self) -> float:
        """Time from rest to rest."""
        if self.distance <= 0.0:
            return 0.0
        return self.distance / self.peak_speed + self.peak_speed / self.acceleration

    def at(self, time_s: float) -> float:
        """Return the distance covered."""
        if time_s >= self.duration_s:
            return self.distance
        ramp = self.peak_speed / self.acceleration
        if time_s < ramp:
            return self.acceleration * time_s * time_s / 2.0
        left = self.duration_s - time_s
        if left < ramp:
            return self.distance - self.acceleration * left * left / 2.0
        return self.peak_speed * (time_s - ramp / 2.0)


def timing_of(distance: float, *, speed: float, acceleration: float, time_s: float) -> TrapezoidalTiming:
    """Return the timing of a motion; a time above zero counts more than speed and acceleration."""
    if time_s > 0.0 and distance > 0.0:
        # A quarter of the time each for speeding up and slowing down.
        return TrapezoidalTiming(distance, distance / (0.75 * time_s), distance / (0.75 * 0.25 * time_s * time_s))
    return TrapezoidalTiming(distance, max(speed, 1e-6), max(acceleration, 1e-6))


def move_joints(
    controller: ControllerState, target: Array, *, speed: float, acceleration: float, time_s: float
) -> Motion:
    """`movej`: all joints start and end together; the speed is that of the joint with the longest distance."""
    yield from stop_joints(controller, acceleration)
    arm = controller.arm
    start, delta = arm.q.copy(), target - arm.q
    distance = float(np.abs(delta).max())
    if distance > 0.0:
        share = np.abs(delta) / distance
        speed = min(speed, float((arm.joint_speed_rad_s / np.maximum(share, 1e-9)).min()))
    timing = timing_of(distance, speed=speed, acceleration=acceleration, time_s=time_s)
    elapsed_s = 0.0
    while elapsed_s < timing.duration_s:
        elapsed_s += arm.cycle_s * controller.speed_scaling
        arm.command(start + delta * (timing.at(elapsed_s) / distance))
        yield
    yield from _one_cycle_at_rest(controller)


def move_tool(
    controller: ControllerState, target: Array, *, speed: float, acceleration: float, time_s: float
) -> Motion:
    """`movel`: the tool centre point moves on a straight line; raises UnreachableError where it cannot."""
    yield from stop_joints(controller, acceleration)
    arm = controller.arm
    if arm.joints_for(target) is None:
        raise UnreachableError("the target of movel has no inverse kinematics")
    start = arm.tcp()
    length = float(np.linalg.norm(target[:3, 3] - start[:3, 3]))
    turn = float(np.linalg.norm(rotation_vector_of(start[:3, :3].T @ target[:3, :3])))
    distance = max(length, turn)
    timing = timing_of(distance, speed=speed, acceleration=acceleration, time_s=time_s)
    elapsed_s = 0.0
    while elapsed_s < timing.duration_s:
        elapsed_s += arm.cycle_s * controller.speed_scaling
        q = arm.joints_for(interpolate(start, target, timing.at(elapsed_s) / distance))
        if q is None:
            raise UnreachableError("the line of movel leaves the space that the arm can reach")
        arm.command(q)
        yield
    yield from _one_cycle_at_rest(controller)


def servo_joints(controller: ControllerState, target: Array, *, time_s: float, lookahead_s: float) -> Motion:
    """`servoj`: follows a set point for a time, later by the lookahead; smooth, and within the speeds of the joints."""
    arm = controller.arm
    lag_s = min(0.2, max(0.03, lookahead_s))
    for _ in range(max(1, round(time_s / arm.cycle_s))):
        qd = np.clip((target - arm.q) / lag_s, -arm.joint_speed_rad_s, arm.joint_speed_rad_s)
        arm.command(arm.q + _approach(arm.qd, qd, _SERVO_ACCELERATION_RAD_S2 * arm.cycle_s) * arm.cycle_s)
        yield


def speed_joints(controller: ControllerState, target: Array, *, acceleration: float, time_s: float) -> Motion:
    """`speedj`: accelerates to joint velocities; ends after the time, or when they are reached where it is zero."""
    arm = controller.arm
    elapsed_s = 0.0
    while True:
        qd = _approach(arm.qd, target * controller.speed_scaling, acceleration * arm.cycle_s)
        arm.command(arm.q + qd * arm.cycle_s)
        elapsed_s += arm.cycle_s
        yield
        if elapsed_s >= time_s and (time_s > 0.0 or np.allclose(arm.qd, target * controller.speed_scaling, atol=1e-4)):
            return


def speed_tool(controller: ControllerState, target: Array, *, acceleration: float, time_s: float) -> Motion:
    """`speedl`: accelerates to a velocity of the tool centre point in the base."""
    arm = controller.arm
    elapsed_s = 0.0
    while True:
        scaled = target * controller.speed_scaling
        jacobian = arm.kinematics.jacobian(arm.q, arm.tool)
        twist = _approach(jacobian @ arm.qd, scaled, acceleration * arm.cycle_s)
        # A little damping: at a singular configuration the arm slows down, or stops for the speed of a joint.
        qd = np.linalg.solve(jacobian.T @ jacobian + 1e-8 * np.eye(6), jacobian.T @ twist)
        arm.command(arm.q + qd * arm.cycle_s)
        elapsed_s += arm.cycle_s
        yield
        if elapsed_s >= time_s and (time_s > 0.0 or np.allclose(twist, scaled, atol=1e-6)):
            return


def stop_joints(controller: ControllerState, deceleration: float) -> Motion:
    """`stopj`: the fastest joint decelerates as given, the others with it."""
    arm = controller.arm
    while not arm.is_at_rest:
        arm.command(arm.q + arm.braked(max(deceleration, 1e-3)) * arm.cycle_s)
        yield


def stop_tool(controller: ControllerState, deceleration: float) -> Motion:
    """`stopl`: the tool centre point decelerates as given."""
    arm = controller.arm
    while not arm.is_at_rest:
        speed = float(np.linalg.norm(arm.tcp_speed()[:3]))
        qd = arm.braked(max(deceleration, 1e-3), speed if speed > _STEADY_M_S else None)
        arm.command(arm.q + qd * arm.cycle_s)
        yield


def _one_cycle_at_rest(controller: ControllerState) -> Motion:
    """Hold the set point for a cycle, so that the measured velocity is zero when the motion ends."""
    controller.arm.command(controller.arm.q.copy())
    yield


def _approach(current: Array, target: Array, step: float) -> Array:
    difference = target - current
    largest = float(np.abs(difference).max())
    return target.copy() if largest <= step else current + difference * (step / largest)
