"""Spherical interpolation between two orientations, along the shorter arc."""

from __future__ import annotations

import numpy as np

from robots.model.transform import conjugate, product, quaternion_of, rotation_vector
from robots.port import Array


def slerp(start: Array, end: Array, share: float) -> Array:
    """Return the orientation at `share` (0 to 1) from `start` to `end`, unit quaternions x y z w.

    It rotates about one fixed axis by at most pi, for any sign of the quaternions.
    """
    turn = rotation_vector(product(conjugate(start), end))
    turned = product(start, quaternion_of(share * turn))
    return turned / np.linalg.norm(turned)
