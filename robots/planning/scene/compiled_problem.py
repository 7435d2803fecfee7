"""The arrays of the compiled core: an arm as links of spheres, the rest of the world as convex solids and voxels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robots.port import Array

BOX, CYLINDER, SPHERE, CAPSULE, HULL, GRID = 0, 1, 2, 3, 4, 5
FREE, TILT, FULL = 0, 1, 2

Indices = NDArray[np.int64]

KIND, TURN, PLACE, SIZE, BALL, PLANES, SOLID_COLUMNS = 0, 1, 10, 13, 16, 20, 22
"""Columns of a solid: kind; rotation (9, by rows) and position in the world; half edges, or radius and half
length, or radius; center and radius of its bounding sphere; first and last + 1 of its planes. A GRID has only the
bounding sphere: it stands for all occupied voxels."""

CORNER, VOXEL, FARTHEST, LOW, HIGH, GRID_COLUMNS = 0, 3, 4, 5, 8, 11
"""Columns of the voxel grid: its lowest corner, the voxel's edge, the distance at which the field is truncated,
the corners of the bounding box of the occupied voxels."""


class CompiledProblem(NamedTuple):
    """One arm in one scene, all in the world frame; n joints, L links, S spheres, P pairs, K solids, M planes.

    The first `placements` row is the first joint's frame in the world (rotation by rows, then position),
    each next one the next joint's in the previous frame, the last the tool's; joints rotate about, or slide
    along, z. Links of joint 0 are static. `bound` is what `motion_bound` returns, `step_m` the largest motion of
    a point of the arm between two checks. `solid_gap` and `pair_gap` are the distances below which spheres
    count as touching: mostly negative, as the spheres are larger than the arm.
    """

    placements: Array
    """(n + 1, 12)"""
    sliding: NDArray[np.bool_]
    limits: Array
    """(4, n) lower and upper limits, lower and upper bounds of samples"""
    bound: Array
    step_m: float
    link_joint: Indices
    """(L,) the joint (1 … n) that a link moves with, 0 for none"""
    link_ball: Array
    """(L, 4) center in the joint's frame and radius of a bounding sphere of the link's spheres"""
    first_sphere: Indices
    """(L + 1,)"""
    spheres: Array
    """(S, 4) center in the joint's frame and radius"""
    pairs: Indices
    """(P, 2) links that must not touch"""
    pair_gap: Array
    """(P,)"""
    solids: Array
    """(K, SOLID_COLUMNS)"""
    planes: Array
    """(M, 4) of hulls, in the solid's frame: outward normal and offset"""
    solid_gap: Array
    """(L, K)"""
    voxels: NDArray[np.float32]
    """(x, y, z) the distance of each voxel from the nearest occupied one, as `voxel_distance_kernels` returns it"""
    voxel_grid: Array
    """(GRID_COLUMNS,)"""
    orientation: int
    """FREE, TILT (the tool's `axis` stays along the third column of `upright`) or FULL (the tool stays as `upright`)"""
    upright: Array
    """(4, 3): a rotation matrix, then `axis`"""
    tolerance: float
