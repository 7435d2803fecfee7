"""The inner loops of inverse kinematics, compiled: forward kinematics, Levenberg-Marquardt, Newton refinement.

A chain is `placements` (n + 1, 3, 4): the pose of each joint in the frame of the one before, the last
is the tool; every joint rotates about, or slides along, the z axis of its frame. `bounds` (3, n) contains
lower limits, upper limits and speeds. A goal is a pose (3, 4) in the world. `match` selects the part of it
to match, see `robots.model.inverse_kinematics.pose_match`. All arrays are C-contiguous float64.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from robots.compiled import compiled
from robots.port import Array

Flags = NDArray[np.bool_]

POSE, POSITION, AXIS = 0, 1, 2

_CHAIN = "f8[:,:,::1], b1[::1]"
_DONE = 1e-14
# A descent that others follow is given up when, still this far away after the pulled iterations, it does not
# halve its cost in a few more: such a one hardly ever arrives, and would take most of the time.
_HOPEFUL, _LOOK_EVERY = 1e-3, 4
_LONGEST_STEP = 0.6


@compiled()
def _place(placements: Array, sliding: Flags, joints: Array, axes: Array, points: Array, tool: Array) -> None:
    """Write the joint axes (n, 3), a point on each (n, 3), and the tool pose (3, 4)."""
    r00, r01, r02 = 1.0, 0.0, 0.0
    r10, r11, r12 = 0.0, 1.0, 0.0
    r20, r21, r22 = 0.0, 0.0, 1.0
    px, py, pz = 0.0, 0.0, 0.0
    last = len(joints)
    for i in range(last + 1):
        m = placements[i]
        px += r00 * m[0, 3] + r01 * m[1, 3] + r02 * m[2, 3]
        py += r10 * m[0, 3] + r11 * m[1, 3] + r12 * m[2, 3]
        pz += r20 * m[0, 3] + r21 * m[1, 3] + r22 * m[2, 3]
        a00 = r00 * m[0, 0] + r01 * m[1, 0] + r02 * m[2, 0]
        a01 = r00 * m[0, 1] + r01 * m[1, 1] + r02 * m[2, 1]
        a02 = r00 * m[0, 2] + r01 * m[1, 2] + r02 * m[2, 2]
        a10 = r10 * m[0, 0] + r11 * m[1, 0] + r12 * m[2, 0]
        a11 = r10 * m[0, 1] + r11 * m[1, 1] + r12 * m[2, 1]
        a12 = r10 * m[0, 2] + r11 * m[1, 2] + r12 * m[2, 2]
        a20 = r20 * m[0, 0] + r21 * m[1, 0] + r22 * m[2, 0]
        a21 = r20 * m[0, 1] + r21 * m[1, 1] + r22 * m[2, 1]
        a22 = r20 * m[0, 2] + r21 * m[1, 2] + r22 * m[2, 2]
        cosine, sine = 1.0, 0.0
        if i < last:
            axes[i, 0], axes[i, 1], axes[i, 2] = a02, a12, a22
            points[i, 0], points[i, 1], points[i, 2] = px, py, pz
            if sliding[i]:
                px += a02 * joints[i]
                py += a12 * joints[i]
                pz += a22 * joints[i]
            else:
                cosine, sine = math.cos(joints[i]), math.sin(joints[i])
        r00, r01, r02 = cosine * a00 + sine * a01, cosine * a01 - sine * a00, a02
        r10, r11, r12 = cosine * a10 + sine * a11, cosine * a11 - sine * a10, a12
        r20, r21, r22 = cosine * a20 + sine * a21, cosine * a21 - sine * a20, a22
    tool[0, 0], tool[0, 1], tool[0, 2], tool[0, 3] = r00, r01, r02, px
    tool[1, 0], tool[1, 1], tool[1, 2], tool[1, 3] = r10, r11, r12, py
    tool[2, 0], tool[2, 1], tool[2, 2], tool[2, 3] = r20, r21, r22, pz


@compiled()
def _turn_missing(tool: Array, goal: Array, error: Array) -> None:
    """Write the rotation vector (world axes) that turns the tool's orientation into the goal's."""
    e00 = goal[0, 0] * tool[0, 0] + goal[0, 1] * tool[0, 1] + goal[0, 2] * tool[0, 2]
    e01 = goal[0, 0] * tool[1, 0] + goal[0, 1] * tool[1, 1] + goal[0, 2] * tool[1, 2]
    e02 = goal[0, 0] * tool[2, 0] + goal[0, 1] * tool[2, 1] + goal[0, 2] * tool[2, 2]
    e10 = goal[1, 0] * tool[0, 0] + goal[1, 1] * tool[0, 1] + goal[1, 2] * tool[0, 2]
    e11 = goal[1, 0] * tool[1, 0] + goal[1, 1] * tool[1, 1] + goal[1, 2] * tool[1, 2]
    e12 = goal[1, 0] * tool[2, 0] + goal[1, 1] * tool[2, 1] + goal[1, 2] * tool[2, 2]
    e20 = goal[2, 0] * tool[0, 0] + goal[2, 1] * tool[0, 1] + goal[2, 2] * tool[0, 2]
    e21 = goal[2, 0] * tool[1, 0] + goal[2, 1] * tool[1, 1] + goal[2, 2] * tool[1, 2]
    e22 = goal[2, 0] * tool[2, 0] + goal[2, 1] * tool[2, 1] + goal[2, 2] * tool[2, 2]
    # The quaternion by its largest component (Shepperd), which stays exact near half a turn.
    trace = e00 + e11 + e22
    if trace > 0.0:
        w = 0.5 * math.sqrt(1.0 + trace)
        x, y, z = 0.25 * (e21 - e12) / w, 0.25 * (e02 - e20) / w, 0.25 * (e10 - e01) / w
    elif e00 >= e11 and e00 >= e22:
        x = 0.5 * math.sqrt(1.0 + e00 - e11 - e22)
        w, y, z = 0.25 * (e21 - e12) / x, 0.25 * (e01 + e10) / x, 0.25 * (e02 + e20) / x
    elif e11 >= e22:
        y = 0.5 * math.sqrt(1.0 + e11 - e00 - e22)
        w, x, z = 0.25 * (e02 - e20) / y, 0.25 * (e01 + e10) / y, 0.25 * (e12 + e21) / y
    else:
        z = 0.5 * math.sqrt(1.0 + e22 - e00 - e11)
        w, x, y = 0.25 * (e10 - e01) / z, 0.25 * (e02 + e20) / z, 0.25 * (e12 + e21) / z
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    sine = math.sqrt(x * x + y * y + z * z)
    scale = 2.0 if sine < 1e-12 else 2.0 * math.atan2(sine, w) / sine
    error[3], error[4], error[5] = scale * x, scale * y, scale * z


@compiled()
def _tilt_missing(tool: Array, goal: Array, error: Array) -> None:
    """Write the shortest rotation vector (world axes) that brings the tool's z axis onto the goal's."""
    ax, ay, az = tool[0, 2], tool[1, 2], tool[2, 2]
    bx, by, bz = goal[0, 2], goal[1, 2], goal[2, 2]
    x, y, z = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    sine = math.sqrt(x * x + y * y + z * z)
    cosine = ax * bx + ay * by + az * bz
    if sine < 1e-12 and cosine < 0.0:
        # Opposite: any axis square to z does, the tool's x axis for one.
        x, y, z, sine = tool[0, 0], tool[1, 0], tool[2, 0], 1.0
        scale = math.pi
    else:
        scale = 1.0 if sine < 1e-12 else math.atan2(sine, cosine) / sine
    error[3], error[4], error[5] = scale * x, scale * y, scale * z


@compiled()
def _linearise(
    placements: Array, sliding: Flags, joints: Array, goal: Array, match: int, jacobian: Array, error: Array
) -> None:
    """Write what is missing to the goal (6,) and how the joints change it (6, n), in world axes."""
    n = len(joints)
    axes, points, tool = np.empty((n, 3)), np.empty((n, 3)), np.empty((3, 4))
    _place(placements, sliding, joints, axes, points, tool)
    for i in range(n):
        x, y, z = axes[i, 0], axes[i, 1], axes[i, 2]
        if sliding[i]:
            jacobian[0, i], jacobian[1, i], jacobian[2, i] = x, y, z
            jacobian[3, i], jacobian[4, i], jacobian[5, i] = 0.0, 0.0, 0.0
            continue
        dx, dy, dz = tool[0, 3] - points[i, 0], tool[1, 3] - points[i, 1], tool[2, 3] - points[i, 2]
        jacobian[0, i], jacobian[1, i], jacobian[2, i] = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
        jacobian[3, i], jacobian[4, i], jacobian[5, i] = x, y, z
    for k in range(3):
        error[k] = goal[k, 3] - tool[k, 3]
    if match == POSE:
        _turn_missing(tool, goal, error)
    elif match == AXIS:
        _tilt_missing(tool, goal, error)
        for i in range(n):
            spin = jacobian[3, i] * tool[0, 2] + jacobian[4, i] * tool[1, 2] + jacobian[5, i] * tool[2, 2]
            for k in range(3):
                jacobian[3 + k, i] -= spin * tool[k, 2]
    else:
        for k in range(3, 6):
            error[k] = 0.0
            for i in range(n):
                jacobian[k, i] = 0.0


@compiled()
def _step(jacobian: Array, free: Array, error: Array, damping: float, pull: Array, step: Array) -> float:
    """Write the damped step of the free joints; `pull` acts where it does not disturb the tool.

    Returns the smallest pivot, which bounds the square of the smallest singular value from above.
    """
    n = len(step)
    square, right = np.empty((6, 6)), np.empty(6)
    for a in range(6):
        total = error[a]
        for i in range(n):
            total -= jacobian[a, i] * free[i] * pull[i]
        right[a] = total
        for b in range(a + 1):
            total = 0.0
            for i in range(n):
                total += jacobian[a, i] * jacobian[b, i] * free[i]
            square[a, b] = total
        square[a, a] += damping + 1e-12
    smallest = 1e30
    for a in range(6):
        for b in range(a + 1):
            total = square[a, b]
            for k in range(b):
                total -= square[a, k] * square[b, k]
            if a == b:
                smallest = min(smallest, total)
                square[a, a] = math.sqrt(max(total, 1e-16))
            else:
                square[a, b] = total / square[b, b]
    for a in range(6):
        for k in range(a):
            right[a] -= square[a, k] * right[k]
        right[a] /= square[a, a]
    for a in range(5, -1, -1):
        for k in range(a + 1, 6):
            right[a] -= square[k, a] * right[k]
        right[a] /= square[a, a]
    for i in range(n):
        total = pull[i]
        for a in range(6):
            total += jacobian[a, i] * right[a]
        step[i] = total * free[i]
    return smallest


@compiled()
def _square(vector: Array, first: int) -> float:
    """Return the squared length of three numbers from `first` on."""
    x, y, z = vector[first], vector[first + 1], vector[first + 2]
    return x * x + y * y + z * z


@compiled()
def _shorten(step: Array, longest: float) -> None:
    """Scale a step so that no joint makes more than `longest`."""
    largest = 0.0
    for i in range(len(step)):
        largest = max(largest, abs(step[i]))
    if largest > longest:
        for i in range(len(step)):
            step[i] *= longest / largest


@compiled()
def _step_within(
    joints: Array, bounds: Array, jacobian: Array, error: Array, damping: float, pull: Array, step: Array
) -> None:
    """Write a damped step that does not push joints beyond limits at which they are, nor turns any too far."""
    n = len(joints)
    free = np.ones(n)
    for _ in range(4):
        _step(jacobian, free, error, damping, pull, step)
        pushed = False
        for i in range(n):
            if (joints[i] <= bounds[0, i] and step[i] < 0.0) or (joints[i] >= bounds[1, i] and step[i] > 0.0):
                free[i] = 0.0
                pushed = True
        if not pushed:
            break
    _shorten(step, _LONGEST_STEP)


@compiled(f"UniTuple(f8, 2)({_CHAIN}, f8[:,::1], f8[:,::1], i8, f8[::1], i8, i8, f8[::1])")
def descend(
    placements: Array,
    sliding: Flags,
    bounds: Array,
    goal: Array,
    match: int,
    near: Array,
    pulled: int,
    iterations: int,
    joints: Array,
) -> tuple[float, float]:
    """Change `joints` by Levenberg-Marquardt within the limits; returns the remaining error, metres and radians.

    During the first `pulled` iterations the self-motion of a redundant arm pulls the joints to `near`; after
    them the descent is abandoned unless it is close to the goal. With `pulled` 0 it continues to the end.
    """
    n = len(joints)
    jacobian, error, new_jacobian, new_error = np.empty((6, n)), np.empty(6), np.empty((6, n)), np.empty(6)
    pull, step, moved = np.zeros(n), np.empty(n), np.empty(n)
    damping, before = 1e-3, 1e30
    _linearise(placements, sliding, joints, goal, match, jacobian, error)
    cost = _square(error, 0) + _square(error, 3)
    for iteration in range(iterations):
        if cost < _DONE:
            break
        if 0 < pulled <= iteration and (iteration - pulled) % _LOOK_EVERY == 0:
            if cost > _HOPEFUL and cost > 0.5 * before:
                break
            before = cost
        for i in range(n):
            pull[i] = 0.1 * (near[i] - joints[i]) if iteration < pulled else 0.0
        _step_within(joints, bounds, jacobian, error, damping * cost + 1e-12, pull, step)
        for i in range(n):
            moved[i] = min(max(joints[i] + step[i], bounds[0, i]), bounds[1, i])
        _linearise(placements, sliding, moved, goal, match, new_jacobian, new_error)
        new_cost = _square(new_error, 0) + _square(new_error, 3)
        if new_cost < cost or (iteration < pulled and new_cost < 1.5 * cost):
            for i in range(n):
                joints[i] = moved[i]
            jacobian, new_jacobian = new_jacobian, jacobian
            error, new_error = new_error, error
            cost = new_cost
            damping = max(damping * 0.3, 1e-6)
        else:
            damping *= 8.0
            if damping > 1e6:
                break
    return math.sqrt(_square(error, 0)), math.sqrt(_square(error, 3))


@compiled()
def _newton(
    placements: Array, sliding: Flags, goal: Array, match: int, longest: float, joints: Array
) -> tuple[float, float, float]:
    """Change `joints`, almost there, by Newton steps without limits; returns metres, radians, smallest pivot."""
    n = len(joints)
    jacobian, error, step = np.empty((6, n)), np.empty(6), np.empty(n)
    free, pull = np.ones(n), np.zeros(n)
    pivot = 0.0
    for iteration in range(9):
        _linearise(placements, sliding, joints, goal, match, jacobian, error)
        distance, angle = math.sqrt(_square(error, 0)), math.sqrt(_square(error, 3))
        pivot = _step(jacobian, free, error, 1e-9, pull, step)
        if iteration == 8 or (distance < 1e-7 and angle < 1e-7):
            return distance, angle, pivot
        _shorten(step, longest)
        for i in range(n):
            joints[i] += step[i]
    return 1e30, 1e30, pivot


@compiled()
def _time_between(seed: Array, joints: Array, bounds: Array) -> float:
    longest = 0.0
    for i in range(len(seed)):
        longest = max(longest, abs(joints[i] - seed[i]) / bounds[2, i])
    return longest


@compiled(f"void({_CHAIN}, f8[::1], f8[:,::1], f8[:,::1], f8[:,::1])")
def place(placements: Array, sliding: Flags, joints: Array, axes: Array, points: Array, tool: Array) -> None:
    """Write the joint axes (n, 3), a point on each (n, 3), and the tool pose (3, 4), in the world."""
    _place(placements, sliding, joints, axes, points, tool)


@compiled(f"UniTuple(f8, 2)({_CHAIN}, f8[:,::1], i8, f8[::1])")
def follow(placements: Array, sliding: Flags, goal: Array, match: int, joints: Array) -> tuple[float, float]:
    """Refine `joints`, which are almost at the goal, ignoring limits; returns the remaining error, metres, radians."""
    distance, angle, _ = _newton(placements, sliding, goal, match, 1e30, joints)
    return distance, angle


@compiled(f"Tuple((i8, i8, f8))({_CHAIN}, f8[:,::1], f8[:,::1], i8, f8[::1], f8[:,::1], f8, f8, f8[:,::1])")
def refine(
    placements: Array,
    sliding: Flags,
    bounds: Array,
    goal: Array,
    match: int,
    seed: Array,
    candidates: Array,
    metres: float,
    radians: float,
    solutions: Array,
) -> tuple[int, int, float]:
    """Refine approximate solutions (k, n), each joint in the turn within limits nearest to `seed`.

    Writes those that succeed to `solutions` (k, n). Returns their number, the index of the one soonest
    reached from the seed, and the smallest pivot, which is small near a singularity.
    """
    n = len(seed)
    count, nearest, soonest, pivot = 0, 0, 1e30, 1e30
    turn = 2.0 * math.pi
    for row in range(len(candidates)):
        joints = solutions[count]
        for i in range(n):
            joints[i] = candidates[row, i]
        distance, angle, smallest = _newton(placements, sliding, goal, match, 0.3, joints)
        pivot = min(pivot, smallest)
        if not (distance <= metres and angle <= radians):
            continue
        within = True
        for i in range(n):
            # A solution that rounding puts just outside stays one when clipped.
            fewest = math.ceil((bounds[0, i] - 1e-8 - joints[i]) / turn)
            most = math.floor((bounds[1, i] + 1e-8 - joints[i]) / turn)
            if fewest > most:
                within = False
                break
            turns = min(max(round((seed[i] - joints[i]) / turn), fewest), most)
            joints[i] = min(max(joints[i] + turns * turn, bounds[0, i]), bounds[1, i])
        if within:
            time = _time_between(seed, joints, bounds)
            if time < soonest:
                soonest, nearest = time, count
            count += 1
            if count == len(solutions):
                break
    return count, nearest, pivot
