"""Orientations as unit quaternions x y z w in rows: product, logarithm and exponential on both covers."""

from __future__ import annotations

import numpy as np

from robots.port import Array

_SMALL = 1e-12


def product(left: Array, right: Array) -> Array:
    """Return the quaternions of the rotation by `right` first, then by `left`; (..., 4), broadcast."""
    left, right = np.broadcast_arrays(left, right)
    turned = np.empty(left.shape)
    lv, lw, rv, rw = left[..., :3], left[..., 3:], right[..., :3], right[..., 3:]
    turned[..., :3] = lw * rv + rw * lv + np.cross(lv, rv)
    turned[..., 3] = left[..., 3] * right[..., 3] - (lv * rv).sum(axis=-1)
    return turned


def conjugate(xyzw: Array) -> Array:
    """Return the quaternions of the inverse rotations, (..., 4)."""
    return xyzw * np.array([-1.0, -1.0, -1.0, 1.0])


def log(xyzw: Array) -> Array:
    """Return axis times angle, (..., 3), up to 2 pi long: a quaternion and its negative differ.

    It is twice the quaternion logarithm of Ude et al. 2014. The sign is preserved, so it
    is continuous along a continuous sequence of quaternions, also beyond half a turn.
    """
    sine = np.linalg.norm(xyzw[..., :3], axis=-1, keepdims=True)
    angle = 2.0 * np.arctan2(sine, xyzw[..., 3:])
    small = sine < _SMALL
    return xyzw[..., :3] * np.where(small, 2.0, angle / np.where(small, 1.0, sine))


def exp(vector: Array) -> Array:
    """Return the unit quaternions of rotation vectors, (..., 3) to (..., 4)."""
    angle = np.linalg.norm(vector, axis=-1, keepdims=True)
    small = angle < _SMALL
    shares = np.where(small, 0.5, np.sin(0.5 * angle) / np.where(small, 1.0, angle))
    return np.concatenate((vector * shares, np.cos(0.5 * angle)), axis=-1)


def toward(xyzw: Array, other: Array) -> Array:
    """Return `xyzw` with the sign that is nearer to `other`, (4,)."""
    return -xyzw if float(xyzw @ other) < 0.0 else xyzw


def continuous(xyzw: Array) -> Array:
    """Return the rows, (T, 4), normalised and with signs such that neighbours are close."""
    unit = xyzw / np.linalg.norm(xyzw, axis=-1, keepdims=True)
    flips = np.where((unit[1:] * unit[:-1]).sum(axis=-1) < 0.0, -1.0, 1.0)
    return unit * np.concatenate(([1.0], np.cumprod(flips)))[:, None]


def of_matrix(matrix: Array) -> Array:
    """Return the unit quaternion (4,) of a rotation matrix (3, 3), the nearest one where it is not quite orthogonal."""
    (a, b, c), (d, e, f), (g, h, i) = matrix.tolist()
    # Its eigenvector of the greatest eigenvalue is the quaternion (Bar-Itzhack 2000).
    symmetric = np.array(
        [
            [a - e - i, b + d, c + g, h - f],
            [b + d, e - a - i, f + h, c - g],
            [c + g, f + h, i - a - e, d - b],
            [h - f, c - g, d - b, a + e + i],
        ]
    )
    return np.asarray(np.linalg.eigh(symmetric)[1][:, -1], dtype=np.float64)
