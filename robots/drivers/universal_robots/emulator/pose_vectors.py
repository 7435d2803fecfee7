"""Poses as controllers of Universal Robots write them: position in metres and rotation vector, six numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from robots.port.arrays import Array


def rotation_of(vector: Sequence[float] | Array) -> Array:
    """Return the rotation matrix of a rotation vector."""
    x, y, z = (float(value) for value in vector)
    angle = math.sqrt(x * x + y * y + z * z)
    if angle < 1e-12:
        return np.array([[1.0, -z, y], [z, 1.0, -x], [-y, x, 1.0]])
    x, y, z = x / angle, y / angle, z / angle
    c, s = math.cos(angle), math.sin(angle)
    t = 1.0 - c
    return np.array(
        [
            [t * x * x + c, t * x * y - s * z, t * x * z + s * y],
            [t * x * y + s * z, t * y * y + c, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, t * z * z + c],
        ]
    )


def rotation_vector_of(rotation: Array) -> Array:
    """Return the rotation vector of a rotation matrix, of at most half a turn."""
    cosine = min(1.0, max(-1.0, (float(rotation[0, 0] + rotation[1, 1] + rotation[2, 2]) - 1.0) / 2.0))
    axis = np.array(
        [
            rotation[2, 1] - rotation[1, 2],
            rotation[0, 2] - rotation[2, 0],
            rotation[1, 0] - rotation[0, 1],
        ]
    )
    sine = float(np.linalg.norm(axis)) / 2.0
    angle = math.atan2(sine, cosine)
    if sine > 1e-6:
        return axis * (angle / (2.0 * sine))
    if cosine > 0.0:
        return axis / 2.0
    # Half a turn: the axis is the column of R + 1 with the largest diagonal.
    symmetric = (rotation + np.eye(3)) / 2.0
    column = int(np.argmax(np.diag(symmetric)))
    direction = symmetric[:, column] / math.sqrt(max(float(symmetric[column, column]), 1e-12))
    sign = -1.0 if float(direction @ axis) < 0.0 else 1.0
    return sign * angle * direction / float(np.linalg.norm(direction))


def matrix_of(pose: Sequence[float] | Array) -> Array:
    """Return the homogeneous matrix of a pose."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_of(pose[3:6])
    matrix[:3, 3] = pose[:3]
    return matrix


def pose_of(matrix: Array) -> list[float]:
    """Return the pose of a homogeneous matrix."""
    return [*matrix[:3, 3].tolist(), *rotation_vector_of(matrix[:3, :3]).tolist()]


def inverse_of(matrix: Array) -> Array:
    """Return the inverse of a homogeneous matrix."""
    inverse = np.eye(4)
    inverse[:3, :3] = matrix[:3, :3].T
    inverse[:3, 3] = -matrix[:3, :3].T @ matrix[:3, 3]
    return inverse


def interpolate(start: Array, end: Array, fraction: float) -> Array:
    """Return the matrix at a fraction of the straight line from start to end, with the shortest rotation."""
    turn = rotation_vector_of(start[:3, :3].T @ end[:3, :3])
    matrix = np.eye(4)
    matrix[:3, :3] = start[:3, :3] @ rotation_of(turn * fraction)
    matrix[:3, 3] = start[:3, 3] + (end[:3, 3] - start[:3, 3]) * fraction
    return matrix
