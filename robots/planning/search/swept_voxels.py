"""Finds the unknown space that an arm with its attached parts passes through along a trajectory."""

from __future__ import annotations

import numpy as np

from engine.messages import Vector3
from engine.messages.sensing import AGES_PER_S, NEVER_SEEN
from robots.planning.scene.compiled_problem import CompiledProblem
from robots.planning.search.path_check import require_fit
from robots.planning.search.swept_voxel_kernels import sweep
from robots.planning.swept_space import CoverRegion, SweptSpace, SweptSpaceRequest
from robots.planning.unknown_voxels import unknown_voxels
from robots.port import Array

_STEP_VOXELS = 0.75


def swept_space(request: SweptSpaceRequest, problem: CompiledProblem) -> SweptSpace:
    """Return the unknown space on the trajectory of a request.

    Raises:
        CellError: the trajectory does not fit this arm, or the observed space is inconsistent.
    """
    observed, trajectory = request.observed, request.trajectory
    require_fit(trajectory, arm=request.arm, dof=len(problem.sliding))
    state = unknown_voxels(observed, request.regions)
    found, at_row = (np.empty(state.size, dtype=np.int64) for _ in range(2))
    count = sweep(
        problem,
        np.ascontiguousarray(trajectory.position_rad, dtype=np.float64),
        _STEP_VOXELS * observed.voxel_m,
        request.near_m,
        np.array(observed.corner_m, dtype=np.float64),
        observed.voxel_m,
        np.array(observed.shape, dtype=np.int64),
        state.reshape(-1),
        found,
        at_row,
    )
    if not count:
        return SweptSpace(unknown_m3=0.0)
    places = np.stack(np.unravel_index(found[:count], observed.shape), axis=1)
    centres: Array = (np.array(observed.corner_m) + (places + 0.5) * observed.voxel_m).astype(np.float64)
    age = observed.ages[int(found[0])]
    return SweptSpace(
        unknown_m3=count * observed.voxel_m**3,
        first_m=_point(centres[0]),
        at_s=float(at_row[0]) * trajectory.dt_s,
        last_s=float(at_row[:count].max()) * trajectory.dt_s,
        age_s=None if age == NEVER_SEEN else age / AGES_PER_S,
        low_m=_point(centres.min(axis=0) - observed.voxel_m / 2.0),
        high_m=_point(centres.max(axis=0) + observed.voxel_m / 2.0),
        regions=tuple(region.name for region in request.regions if _holds(region, centres)),
    )


def _holds(region: CoverRegion, centres: Array) -> bool:
    away = np.abs(centres - np.array(region.center_m))
    return bool((away <= np.array(region.size_m) / 2.0).all(axis=1).any())


def _point(values: Array) -> Vector3:
    x, y, z = values.tolist()
    return (x, y, z)
