"""The compiled arithmetic of a control period; import it before the loop starts.

Sums keep their written order: equal numbers give equal bits. All arrays are float64.
"""

from __future__ import annotations

import math

import numpy as np

from robots.compiled import compiled
from robots.port import Array

_SMALL = 1e-12
# Slower joints do not limit the pace of a trajectory.
_STANDS = 1e-9
# A pace may change by this share of the jerk limit where the path itself takes all of it.
_LEAST_JERK_SHARE = 0.05
_HARDEST_STOP = 1.1
# The target pace is reached where so small a share of the jerk limit is missing.
_SNAP_SHARE = 0.05
# A pace approaches a faster one with this time constant at least.
_SPEED_UP_S = 0.02
# A change of pace fades with this share of the jerk limit: the path may need the rest.
_FADING_SHARE = 0.5
_ROW, _TABLE, _ANY = "f8[::1]", "f8[:,::1]", "f8[:,:]"


@compiled(f"void({_TABLE}, {_TABLE}, i8, f8, f8, f8, f8, f8, {_ROW}, {_ROW}, {_ROW})")
def interpolate_setpoint(
    points: Array,
    slopes: Array,
    index: int,
    u: float,
    h: float,
    pace: float,
    pace_squared: float,
    pace_change: float,
    position: Array,
    velocity: Array,
    acceleration: Array,
) -> None:
    """Write the set point, each (n,), at the share `u` from sample `index` to the next, `h` seconds later.

    `points` and `slopes` (samples, n) define a cubic Hermite spline; `pace` is the rate of its time.
    """
    u2, u3 = u * u, u * u * u
    at0, at1 = 1 - 3 * u2 + 2 * u3, 3 * u2 - 2 * u3
    by0, by1 = u - 2 * u2 + u3, u3 - u2
    rising, first, last = 6 * u - 6 * u * u, 1 - 4 * u + 3 * u * u, 3 * u * u - 2 * u
    bending, first_bend, last_bend = 6 - 12 * u, 6 * u - 4, 6 * u - 2
    for joint in range(len(position)):
        p0, p1 = points[index, joint], points[index + 1, joint]
        v0, v1 = slopes[index, joint], slopes[index + 1, joint]
        rise = (p1 - p0) / h
        slope = rising * rise + first * v0 + last * v1
        curvature = (bending * rise + first_bend * v0 + last_bend * v1) / h
        position[joint] = at0 * p0 + at1 * p1 + h * (by0 * v0 + by1 * v1)
        velocity[joint] = slope * pace
        acceleration[joint] = curvature * pace_squared + slope * pace_change


@compiled("f8(f8, f8, f8, f8, f8, f8)")
def _rise_towards(missing: float, rise: float, step_s: float, fades: float, lowest: float, highest: float) -> float:
    """Return the rate at the end of a period from which it can fade to 0 where nothing is `missing` any more.

    `fades` is the change of the rate per second with which it fades, `lowest` and `highest` are the largest rates
    downwards and upwards; all are positive.
    """
    # Where it would end if the rate faded at once.
    left = missing - rise * abs(rise) / (2.0 * fades)
    sign = 1.0 if left > 0.0 else -1.0
    room = 2.0 * sign * (missing - rise * step_s / 2.0) / fades + step_s * step_s
    size = fades * (math.sqrt(room) - step_s) if room > step_s * step_s else 0.0
    if sign > 0.0:
        # Too fast a pace exceeds the speed that was planned, where the path keeps the rate from fading.
        return min(size, highest, missing / _SPEED_UP_S)
    return -min(size, lowest)


@compiled(f"void({_TABLE}, {_TABLE}, i8, f8, f8, f8, f8, f8, {_ROW}, {_ROW}, {_ROW}, {_ROW})")
def advance_pace(
    points: Array,
    slopes: Array,
    index: int,
    u: float,
    h: float,
    step_s: float,
    target: float,
    fastest: float,
    most: Array,
    hardest: Array,
    peak: Array,
    pace: Array,
) -> None:
    """Bring the pace ṡ of a trajectory towards `target` within a period, and its rate s̈ to 0 there.

    `pace` (3,) has ṡ, s̈ and what s passes in the period. The spline is that of `interpolate_setpoint`, at the share
    `u` after sample `index`. No joint's p″ṡ² + p′s̈ exceeds `most`, and no p‴ṡ³ + 3p″ṡs̈ + p′s⃛ `hardest`, as far as
    s̈ and s⃛ can bring that about; |s̈| is at most `fastest`. `peak` (n,) are the
    joints' largest |p′|. Where the path bends, 10 % more of `most` precede jerk.
    """
    rate, rise = pace[0], pace[1]
    lowest, highest = -fastest, fastest
    floor, ceiling = -2.0 * fastest, 2.0 * fastest
    fall, climb = -fastest / step_s, fastest / step_s
    fades = climb
    last = len(points) - 1
    for joint in range(points.shape[1]):
        v0, v1 = slopes[index, joint], slopes[index + 1, joint]
        along = (points[index + 1, joint] - points[index, joint]) / h
        slope = (6 * u - 6 * u * u) * along + (1 - 4 * u + 3 * u * u) * v0 + (3 * u * u - 2 * u) * v1
        if abs(slope) <= _STANDS:
            continue
        bend = ((6 - 12 * u) * along + (6 * u - 4) * v0 + (6 * u - 2) * v1) / h
        twist = (6 * (v0 + v1) - 12 * along) / (h * h)
        # What the path asks for itself may change before the pace has.
        ahead = min(index + 2, last)
        onward = (points[ahead, joint] - points[ahead - 1, joint]) / h
        next_twist = (6 * (slopes[ahead - 1, joint] + slopes[ahead, joint]) - 12 * onward) / (h * h)
        size = abs(slope)
        turned = 1.0 if slope > 0.0 else -1.0
        square = turned * rate * rate
        first = square * bend
        second = square * (2 * v0 + 4 * v1 - 6 * along) / h
        third = square * (6 * onward - 4 * slopes[ahead - 1, joint] - 2 * slopes[ahead, joint]) / h
        fourth = square * (2 * slopes[ahead - 1, joint] + 4 * slopes[ahead, joint] - 6 * onward) / h
        pushed, pulled = max(first, second, third, fourth), min(first, second, third, fourth)
        lowest = max(lowest, min(0.0, (-most[joint] - pulled) / size))
        highest = min(highest, max(0.0, (most[joint] - pushed) / size))
        floor = max(floor, min(0.0, (-_HARDEST_STOP * most[joint] - pulled) / size))
        ceiling = min(ceiling, max(0.0, (_HARDEST_STOP * most[joint] - pushed) / size))
        cube = turned * rate * rate * rate
        bent = turned * 3.0 * bend * rate * rise
        least = _LEAST_JERK_SHARE * hardest[joint]
        fall = max(fall, -max(least, hardest[joint] + bent + min(twist * cube, next_twist * cube)) / size)
        climb = min(climb, max(least, hardest[joint] - bent - max(twist * cube, next_twist * cube)) / size)
        fades = min(fades, _FADING_SHARE * hardest[joint] / max(size, _FADING_SHARE * peak[joint]))
    next_rise = _rise_towards(target - rate, rise, step_s, fades, -lowest, highest)
    next_rise = min(max(next_rise, rise + fall * step_s), rise + climb * step_s)
    next_rise = min(max(next_rise, floor), ceiling)
    reached = rate + (rise + next_rise) * step_s / 2.0
    little = _SNAP_SHARE * fades * step_s
    if abs(reached - target) <= little * step_s and abs(next_rise) <= little:
        reached, next_rise = target, 0.0
    if reached < 0.0:
        reached, next_rise = 0.0, 0.0
    pace[2] = max(0.0, rate * step_s + (2.0 * rise + next_rise) * step_s * step_s / 6.0)
    pace[0], pace[1] = reached, next_rise


@compiled(f"void({_ROW}, {_ROW}, {_ROW}, {_ROW}, {_ROW})")
def pose_error(target_xyz: Array, target_xyzw: Array, xyz: Array, xyzw: Array, error: Array) -> None:
    """Write the error of a pose against the target one: translation and rotation vector (6,), in the axes of both."""
    for axis in range(3):
        error[axis] = target_xyz[axis] - xyz[axis]
    ax, ay, az, aw = target_xyzw[0], target_xyzw[1], target_xyzw[2], target_xyzw[3]
    bx, by, bz, bw = -xyzw[0], -xyzw[1], -xyzw[2], xyzw[3]
    error[3] = aw * bx + ax * bw + ay * bz - az * by
    error[4] = aw * by + ay * bw + az * bx - ax * bz
    error[5] = aw * bz + az * bw + ax * by - ay * bx
    cosine = aw * bw - ax * bx - ay * by - az * bz
    sine = math.sqrt(error[3] * error[3] + error[4] * error[4] + error[5] * error[5])
    # The shorter arc; a small angle is twice its sine.
    factor = 2.0
    if sine > _SMALL:
        factor = 2.0 * math.atan2(sine, abs(cosine)) / sine
    if cosine < 0.0:
        factor = -factor
    for axis in range(3, 6):
        error[axis] *= factor


@compiled(f"b1({_TABLE}, {_TABLE})")
def solve_in_place(matrix: Array, right: Array) -> bool:
    """Replace `right` (n, m) by matrix⁻¹ · right, and the symmetric `matrix` (n, n) by its Cholesky factor.

    Only its lower triangle is read. False if it is not positive definite; both are then invalid.
    """
    n, columns = right.shape
    for i in range(n):
        for j in range(i + 1):
            rest = matrix[i, j]
            for k in range(j):
                rest -= matrix[i, k] * matrix[j, k]
            if i != j:
                matrix[i, j] = rest / matrix[j, j]
            elif rest > 0.0:
                matrix[i, i] = math.sqrt(rest)
            else:
                return False
    for column in range(columns):
        for i in range(n):
            rest = right[i, column]
            for k in range(i):
                rest -= matrix[i, k] * right[k, column]
            right[i, column] = rest / matrix[i, i]
        for i in range(n - 1, -1, -1):
            rest = right[i, column]
            for k in range(i + 1, n):
                rest -= matrix[k, i] * right[k, column]
            right[i, column] = rest / matrix[i, i]
    return True


@compiled(f"b1({_ANY}, {_TABLE}, {_ANY}, {_ROW}, {_ROW}, {_ROW}, {_ROW}, {_ROW}, {_ROW}, {_ROW}, f8, {_ROW})")
def impedance_torque(
    world_jacobian: Array,
    base_rotation: Array,
    mass: Array,
    error: Array,
    joint_error: Array,
    joint_error_rate: Array,
    stiffness: Array,
    damping_root: Array,
    joint_stiffness: Array,
    joint_damping_root: Array,
    lightest_share: float,
    torque: Array,
) -> bool:
    """Write the joint torques (n,) of springs and dampers at the tool and, in its null space, at the joints.

    The Jacobian (6, n) and `error` (6,) are in world axes, `stiffness` and `damping_root`
    (6,) in those of the base with `base_rotation` (3, 3); those of the joints are (n,). See
    `CartesianImpedance` for the law.
    False if `mass` (n, n) is not positive definite; `torque` is then unchanged.
    """
    n = len(torque)
    jacobian = np.empty((6, n))
    pull = np.empty(6)
    for row in range(3):
        for half in (0, 3):
            for joint in range(n):
                turned = base_rotation[0, row] * world_jacobian[half, joint]
                turned += base_rotation[1, row] * world_jacobian[half + 1, joint]
                turned += base_rotation[2, row] * world_jacobian[half + 2, joint]
                jacobian[half + row, joint] = turned
            turned = base_rotation[0, row] * error[half] + base_rotation[1, row] * error[half + 1]
            pull[half + row] = turned + base_rotation[2, row] * error[half + 2]
    factor, mobile = np.empty((n, n)), np.empty((n, 6))
    for i in range(n):
        factor[i] = mass[i]
        mobile[i] = jacobian[:, i]
    if not solve_in_place(factor, mobile):
        return False
    mobility, inertia = np.empty((6, 6)), np.zeros((6, 6))
    for row in range(6):
        inertia[row, row] = 1.0
        for column in range(6):
            total = 0.0
            for joint in range(n):
                total += jacobian[row, joint] * mobile[joint, column]
            mobility[row, column] = total
    for half in (0, 3):
        trace = mobility[half, half] + mobility[half + 1, half + 1] + mobility[half + 2, half + 2]
        bound = lightest_share / 3.0 * trace
        for row in range(half, half + 3):
            mobility[row, row] += bound
    if not solve_in_place(mobility, inertia):
        return False
    drawn = np.empty(n)
    for joint in range(n):
        damped = joint_damping_root[joint] * math.sqrt(mass[joint, joint]) * joint_error_rate[joint]
        drawn[joint] = joint_stiffness[joint] * joint_error[joint] + damped
    moved = np.empty(6)
    for row in range(6):
        rate = drift = 0.0
        for joint in range(n):
            rate += jacobian[row, joint] * joint_error_rate[joint]
            drift += drawn[joint] * mobile[joint, row]
        moved[row] = drift
        pull[row] = stiffness[row] * pull[row] + damping_root[row] * math.sqrt(inertia[row, row]) * rate
    for row in range(6):
        for column in range(6):
            pull[row] -= inertia[row, column] * moved[column]
    for joint in range(n):
        total = drawn[joint]
        for row in range(6):
            total += jacobian[row, joint] * pull[row]
        torque[joint] = total
    return True


@compiled(f"i8(f8, {_ROW}, {_TABLE}, {_TABLE}, {_ROW})")
def compare_set_point(step_s: float, position: Array, past: Array, limits: Array, worst: Array) -> int:
    """Compare a set point `position` (n,) with `limits` and with its past, and make it the latest of the past.

    `past` (3, n) has position, velocity and acceleration of the period before, as differences of positions; `limits`
    (5, n) the range, then the largest velocity, acceleration and jerk. Returns 0, or 1 for position, 2 for velocity,
    3 for acceleration, 4 for jerk, the first of them that a joint exceeds; `worst` (3,) is then that joint, its value
    and the limit. A joint beyond its range may stay there, but not go farther.
    """
    exceeded = 5
    largest = 0.0
    for joint in range(len(position)):
        now, before = position[joint], past[0, joint]
        velocity = (now - before) / step_s
        acceleration = (velocity - past[1, joint]) / step_s
        jerk = (acceleration - past[2, joint]) / step_s
        past[0, joint], past[1, joint], past[2, joint] = now, velocity, acceleration
        quantity, value, limit = 5, 0.0, 1.0
        if now > limits[1, joint] and velocity > 0.0:
            quantity, value, limit = 1, now, limits[1, joint]
        elif now < limits[0, joint] and velocity < 0.0:
            quantity, value, limit = 1, now, limits[0, joint]
        elif abs(velocity) > limits[2, joint]:
            quantity, value, limit = 2, velocity, limits[2, joint]
        elif abs(acceleration) > limits[3, joint]:
            quantity, value, limit = 3, acceleration, limits[3, joint]
        elif abs(jerk) > limits[4, joint]:
            quantity, value, limit = 4, jerk, limits[4, joint]
        elif not math.isfinite(now):
            quantity, value, limit = 1, now, limits[1, joint]
        if quantity < exceeded or (quantity == exceeded and quantity < 5 and abs(value) / limit > largest):
            exceeded, largest = quantity, abs(value) / limit if limit > 0.0 else 0.0
            worst[0], worst[1], worst[2] = joint, value, limit
    return exceeded % 5


@compiled(f"void({_ANY}, {_ROW}, {_ROW}, {_ROW}, {_ROW}, {_ROW})")
def add_feedforward(
    mass: Array, bias: Array, velocity: Array, acceleration: Array, damping: Array, feedforward: Array
) -> None:
    """Write the torques that carry and accelerate an arm, (n,), and add its dampers to `bias`.

    `mass` (n, n) and `bias` (n,) are M and C q̇ + g, `acceleration` (n,) is that of the set point, `damping` (n,) in
    N m s/rad.
    """
    for i in range(len(bias)):
        total = bias[i]
        for j in range(len(bias)):
            total += mass[i, j] * acceleration[j]
        feedforward[i] = total
        bias[i] += damping[i] * velocity[i]


@compiled(f"void({_ANY}, {_ROW}, {_ROW}, {_ROW}, f8, f8, {_ROW})")
def observe_momentum(
    mass: Array, before: Array, velocity: Array, known: Array, step_s: float, share: float, external: Array
) -> None:
    """Move the estimate `external` (n,) by `share` towards M Δq̇ / Δt minus the `known` torques (n,)."""
    for i in range(len(external)):
        total = -known[i]
        for j in range(len(external)):
            total += mass[i, j] * ((velocity[j] - before[j]) / step_s)
        external[i] += share * (total - external[i])
