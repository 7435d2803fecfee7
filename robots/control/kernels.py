"""The compiled arithmetic of a control period; import it before the loop starts.

Sums keep their written order: equal numbers give equal bits. All arrays are float64.
"""

from __future__ import annotations

import math

import numpy as np

from robots.compiled import compiled
from robots.port import Array

_SMALL = 1e-12
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


@compiled(f"b1({_ANY}, {_TABLE}, {_ANY}, {_ROW}, {_ROW}, {_ROW}, {_ROW}, {_ROW}, f8, f8, f8, {_ROW})")
def impedance_torque(
    world_jacobian: Array,
    base_rotation: Array,
    mass: Array,
    error: Array,
    joint_error: Array,
    joint_error_rate: Array,
    stiffness: Array,
    damping_root: Array,
    joint_stiffness: float,
    joint_damping_root: float,
    lightest_share: float,
    torque: Array,
) -> bool:
    """Write the joint torques (n,) of springs and dampers at the tool and, in its null space, at the joints.

    The Jacobian (6, n) and `error` (6,) are in world axes, `stiffness` and `damping_root`
    (6,) in those of the base with `base_rotation` (3, 3). See `CartesianImpedance` for the law.
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
        damped = joint_damping_root * math.sqrt(mass[joint, joint]) * joint_error_rate[joint]
        drawn[joint] = joint_stiffness * joint_error[joint] + damped
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
