"""The compiled geometry of a person's arm: where its elbow is, the poses of its bodies, and how fast these move.

All arrays are float64. `shoulder` and `hand` (3,) are points of the world, `lengths` are those of upper arm and forearm
and the least and the greatest distance of the hand from the shoulder, `side` (3,) is as in `Limb`.
"""

from __future__ import annotations

import math

import numpy as np

from robots.compiled import compiled
from robots.port import Array

_SMALL, _SHORTEST = 1e-9, 1e-6
# Rate at which an elbow returns to its hanging position: nearly as fast as it would fall, and smoothly.
_SINKING_RAD_S = 3.0
_SINKING_S = 0.15
_SETTLED_RAD = 1e-6
_ROW, _ROWS = "f8[::1]", "f8[:, ::1]"


@compiled(f"f8({_ROW}, {_ROW}, {_ROW}, {_ROW})")
def _axis(shoulder: Array, lengths: Array, hand: Array, axis: Array) -> float:
    """Write the direction from the shoulder to the hand, and return the hand's distance within reach."""
    x, y, z = hand[0] - shoulder[0], hand[1] - shoulder[1], hand[2] - shoulder[2]
    length = math.sqrt(x * x + y * y + z * z)
    if length < _SMALL:
        axis[0], axis[1], axis[2] = 1.0, 0.0, 0.0
        return lengths[2]
    axis[0], axis[1], axis[2] = x / length, y / length, z / length
    return min(max(length, lengths[2]), lengths[3])


@compiled(f"b1({_ROW}, {_ROW}, {_ROW})")
def _across(vector: Array, axis: Array, part: Array) -> bool:
    """Write the unit vector along the component of `vector` perpendicular to `axis`; false if there is none."""
    share = vector[0] * axis[0] + vector[1] * axis[1] + vector[2] * axis[2]
    for i in range(3):
        part[i] = vector[i] - axis[i] * share
    length = math.sqrt(part[0] * part[0] + part[1] * part[1] + part[2] * part[2])
    if length <= _SHORTEST:
        return False
    for i in range(3):
        part[i] /= length
    return True


@compiled(f"void({_ROW}, {_ROW}, {_ROW}, {_ROW})")
def hang(shoulder: Array, lengths: Array, hand: Array, side: Array) -> None:
    """Write the side on which the elbow hangs."""
    axis, other = np.empty(3), np.zeros(3)
    _axis(shoulder, lengths, hand, axis)
    other[2] = -1.0
    if _across(other, axis, side):
        return
    other[:] = 0.0
    other[0 if abs(axis[0]) < 0.9 else 1] = 1.0
    _across(other, axis, side)


@compiled(f"void({_ROW}, {_ROW}, {_ROW}, f8, {_ROW})")
def carry_on(shoulder: Array, lengths: Array, hand: Array, step_s: float, side: Array) -> None:
    """Turn the side with the arm in a step in which the hand moved to `hand`, and let the elbow sink."""
    axis, turned, down = np.empty(3), np.empty(3), np.zeros(3)
    _axis(shoulder, lengths, hand, axis)
    if not _across(side, axis, turned):
        hang(shoulder, lengths, hand, side)
        return
    down[2] = -1.0
    lowest = np.empty(3)
    if not _across(down, axis, lowest):
        side[:] = turned
        return
    normal_x = axis[1] * turned[2] - axis[2] * turned[1]
    normal_y = axis[2] * turned[0] - axis[0] * turned[2]
    normal_z = axis[0] * turned[1] - axis[1] * turned[0]
    sine = normal_x * lowest[0] + normal_y * lowest[1] + normal_z * lowest[2]
    cosine = turned[0] * lowest[0] + turned[1] * lowest[1] + turned[2] * lowest[2]
    angle = math.atan2(sine, cosine)
    if abs(angle) < _SETTLED_RAD:
        side[:] = lowest
        return
    # Near the vertical the lower side is ill-defined, and nothing pulls the elbow to it.
    fastest = _SINKING_RAD_S * math.sqrt(axis[0] * axis[0] + axis[1] * axis[1]) * step_s
    turn = math.copysign(min(abs(angle) * min(1.0, step_s / _SINKING_S), fastest), angle)
    c, s = math.cos(turn), math.sin(turn)
    side[0] = turned[0] * c + normal_x * s
    side[1] = turned[1] * c + normal_y * s
    side[2] = turned[2] * c + normal_z * s


@compiled(f"void({_ROW}, {_ROW}, {_ROW})")
def _orient(y: Array, z: Array, out: Array) -> None:
    """Write the quaternion, w first, of the frame with these orthonormal y and z axes."""
    m00, m10, m20 = y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]
    m01, m11, m21 = y[0], y[1], y[2]
    m02, m12, m22 = z[0], z[1], z[2]
    ww, xx = 1.0 + m00 + m11 + m22, 1.0 + m00 - m11 - m22
    yy, zz = 1.0 - m00 + m11 - m22, 1.0 - m00 - m11 + m22
    # From the largest component, to avoid division by a small number.
    largest = max(ww, xx, yy, zz)
    double = 2.0 * math.sqrt(largest)
    if ww == largest:
        out[0], out[1], out[2], out[3] = double / 4.0, (m21 - m12) / double, (m02 - m20) / double, (m10 - m01) / double
    elif xx == largest:
        out[0], out[1], out[2], out[3] = (m21 - m12) / double, double / 4.0, (m01 + m10) / double, (m02 + m20) / double
    elif yy == largest:
        out[0], out[1], out[2], out[3] = (m02 - m20) / double, (m01 + m10) / double, double / 4.0, (m12 + m21) / double
    else:
        out[0], out[1], out[2], out[3] = (m10 - m01) / double, (m02 + m20) / double, (m12 + m21) / double, double / 4.0
    length = math.sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2] + out[3] * out[3])
    for i in range(4):
        out[i] /= length


@compiled(f"void({_ROW}, {_ROW}, {_ROW}, {_ROW}, {_ROWS}, {_ROWS})")
def place(shoulder: Array, lengths: Array, hand: Array, side: Array, xyz: Array, wxyz: Array) -> None:
    """Write the poses of the bodies, (3, 3) and (3, 4), with the elbow towards `side`."""
    axis = np.empty(3)
    length = _axis(shoulder, lengths, hand, axis)
    upper_m, fore_m = lengths[0], lengths[1]
    along = (upper_m * upper_m - fore_m * fore_m + length * length) / (2.0 * length)
    out = math.sqrt(max(upper_m * upper_m - along * along, 0.0))
    upper, fore = np.empty(3), np.empty(3)
    for i in range(3):
        to_elbow = axis[i] * along + side[i] * out
        elbow, reached = shoulder[i] + to_elbow, shoulder[i] + axis[i] * length
        xyz[0, i], xyz[1, i], xyz[2, i] = shoulder[i] + to_elbow / 2.0, (elbow + reached) / 2.0, reached
        upper[i], fore[i] = to_elbow / upper_m, (reached - elbow) / fore_m
    hinge = np.empty(3)
    hinge[0] = axis[1] * side[2] - axis[2] * side[1]
    hinge[1] = axis[2] * side[0] - axis[0] * side[2]
    hinge[2] = axis[0] * side[1] - axis[1] * side[0]
    _orient(hinge, upper, wxyz[0])
    _orient(hinge, fore, wxyz[1])
    wxyz[2] = wxyz[1]


@compiled(f"void({_ROWS}, {_ROWS}, {_ROWS}, {_ROWS}, f8, {_ROW}, {_ROW})")
def move(xyz: Array, wxyz: Array, next_xyz: Array, next_wxyz: Array, step_s: float, qpos: Array, qvel: Array) -> None:
    """Write positions (21,) and velocities (18,) of the bodies that go on to the next poses in a step.

    Velocities are linear of the origins in the world, angular in the frames of the bodies.
    """
    for body in range(len(xyz)):
        for i in range(3):
            qpos[7 * body + i] = xyz[body, i]
            qvel[6 * body + i] = (next_xyz[body, i] - xyz[body, i]) / step_s
        for i in range(4):
            qpos[7 * body + 3 + i] = wxyz[body, i]
        bw, bx, by, bz = wxyz[body, 0], wxyz[body, 1], wxyz[body, 2], wxyz[body, 3]
        aw, ax, ay, az = next_wxyz[body, 0], next_wxyz[body, 1], next_wxyz[body, 2], next_wxyz[body, 3]
        # conjugate(b) * a, vector part; over one step the rotation is twice that, along the shorter arc.
        twice = -2.0 if bw * aw + bx * ax + by * ay + bz * az < 0.0 else 2.0
        qvel[6 * body + 3] = twice * (bw * ax - aw * bx - (by * az - bz * ay)) / step_s
        qvel[6 * body + 4] = twice * (bw * ay - aw * by - (bz * ax - bx * az)) / step_s
        qvel[6 * body + 5] = twice * (bw * az - aw * bz - (bx * ay - by * ax)) / step_s
