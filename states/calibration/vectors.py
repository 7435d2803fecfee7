"""Sums and products of vectors with plain floats."""

from __future__ import annotations

import math
from collections.abc import Sequence

from engine.messages import Vector3


def dot(one: Vector3, other: Vector3) -> float:
    """Return the scalar product."""
    return sum(a * b for a, b in zip(one, other, strict=True))


def cross(one: Vector3, other: Vector3) -> Vector3:
    """Return the vector product."""
    (ax, ay, az), (bx, by, bz) = one, other
    return (ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)


def add(one: Vector3, other: Vector3) -> Vector3:
    """Return the sum."""
    return (one[0] + other[0], one[1] + other[1], one[2] + other[2])


def subtract(one: Vector3, other: Vector3) -> Vector3:
    """Return the first vector less the second."""
    return (one[0] - other[0], one[1] - other[1], one[2] - other[2])


def scale(vector: Vector3, by: float) -> Vector3:
    """Return a multiple of the vector."""
    return (vector[0] * by, vector[1] * by, vector[2] * by)


def mean(vectors: Sequence[Vector3]) -> Vector3:
    """Return the mean of one or more vectors."""
    x, y, z = (math.fsum(values) / len(vectors) for values in zip(*vectors, strict=True))
    return (x, y, z)
