"""Which rays hit an isolated box, cylinder or sphere: its image without occlusion."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from engine.messages import Vector3
from robots.port import Array

Mask = NDArray[np.bool_]
_PARALLEL = 1e-12


def bounding_edges_m(shape: str, size_m: tuple[float, ...]) -> Vector3:
    """Return the edges of the bounding box of a shape of a cell document, in its own axes."""
    match shape:
        case "sphere":
            return (size_m[0], size_m[0], size_m[0])
        case "cylinder":
            return (size_m[0], size_m[0], size_m[1])
        case _:
            return (size_m[0], size_m[1], size_m[2])


def intersects_shape(shape: str, size_m: tuple[float, ...], start: Array, along: Array) -> Mask:
    """Return which rays hit the shape, (k,).

    Args:
        shape: `box`, `cylinder` (along z) or `sphere`, centred at the origin.
        size_m: As in a cell document.
        start: Origin of all rays, (3,), outside the shape.
        along: Directions, (k, 3).
    """
    half = np.array(bounding_edges_m(shape, size_m)) / 2.0
    match shape:
        case "sphere":
            near, far = _round(start, along, half[0])
        case "cylinder":
            side, end = _round(start[:2], along[:, :2], half[0]), _slab(start[2], along[:, 2], half[2])
            near, far = np.maximum(side[0], end[0]), np.minimum(side[1], end[1])
        case _:
            slabs = [_slab(start[axis], along[:, axis], half[axis]) for axis in range(3)]
            near = np.maximum.reduce([slab[0] for slab in slabs])
            far = np.minimum.reduce([slab[1] for slab in slabs])
    return (near < far) & (far > 0.0)


def _slab(start: float, along: Array, half: float) -> tuple[Array, Array]:
    """Return entry and exit, in lengths of each ray, of the slab within `half` of the centre; entry inf if never."""
    is_level = np.abs(along) < _PARALLEL
    pace = np.where(is_level, 1.0, along)
    one, other = (-half - start) / pace, (half - start) / pace
    always = -np.inf if abs(start) < half else np.inf
    near = np.where(is_level, always, np.minimum(one, other))
    far = np.where(is_level, -always, np.maximum(one, other))
    return near, far


def _round(start: Array, along: Array, radius: float) -> tuple[Array, Array]:
    """Return the same for a circle or a ball around the origin."""
    pace = np.einsum("ij,ij->i", along, along)
    is_level = pace < _PARALLEL**2
    safe = np.where(is_level, 1.0, pace)
    middle = -(along @ start) / safe
    outside = float(start @ start) - radius**2
    under = middle**2 - outside / safe
    reach = np.sqrt(np.maximum(under, 0.0))
    always = -np.inf if outside < 0.0 else np.inf
    misses = under <= 0.0
    near = np.where(is_level, always, np.where(misses, np.inf, middle - reach))
    far = np.where(is_level, -always, np.where(misses, -np.inf, middle + reach))
    return near, far
