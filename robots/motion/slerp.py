"""Spherical interpolation between two orientations, the short way round."""

from __future__ import annotations

import numpy as np

from robots.model.transform import conjugate, product, quaternion_of, rotation_vector
from robots.port import Array


def slerp(start: Array, end: Array, share: float) -> Array:
    """Return the orientation `share` (0 to 1) of the way from `start` to `end`, unit quaternions x y z w.

    It turns about one fixed axis by at most pi, whichever sign the quaternions have.
    """
    turn = rotation_vector(product(conjugate(start), end))
    turned = product(start, quaternion_of(share * turn))
    return turned / np.linalg.norm(turned)
