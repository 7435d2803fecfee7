"""Covers a link with few spheres that contain it and extend little beyond: a greedy fit, cached on disk."""

from __future__ import annotations

import io
from collections.abc import Sequence
from dataclasses import dataclass

import msgspec
import numpy as np

from engine.host.user_cache import cache_dir
from engine.messages.shapes import Shape
from robots.model.transform import RigidTransform
from robots.model.urdf.mesh_cache import content_key, read_cached, write_cached
from robots.planning.scene.convex_shapes import ConvexSolid, convex_solid, to_frame
from robots.port import Array

_RECIPE = "spheres 6"
# Extension of spheres beyond a link: a share of its greatest depth, or of its length if that is more, within bounds.
_DEPTH_SHARE, _LENGTH_SHARE, _LEAST_INFLATION_M, _MOST_INFLATION_M = 0.4, 0.04, 0.015, 0.07
_MOST_CANDIDATES = 1500


@dataclass(frozen=True, kw_only=True)
class LinkSolid:
    """A shape and its pose in the frame of the link."""

    shape: Shape
    pose: RigidTransform


def covering_spheres(solids: Sequence[LinkSolid]) -> Array:
    """Return spheres, (s, 4) center and radius in the link's frame, that together contain the solids."""
    key = content_key(_content(solids), recipe=_RECIPE)
    folder = cache_dir() / "spheres"
    cached = read_cached(folder, key)
    if cached is not None:
        return np.load(io.BytesIO(cached), allow_pickle=False)
    spheres = _fit(solids)
    file = io.BytesIO()
    np.save(file, spheres, allow_pickle=False)
    write_cached(folder, key, file.getvalue())
    return spheres


def _content(solids: Sequence[LinkSolid]) -> bytes:
    poses = [[solid.pose.xyz.round(9).tolist(), solid.pose.xyzw.round(9).tolist()] for solid in solids]
    return msgspec.msgpack.encode([[solid.shape for solid in solids], poses])


@dataclass(frozen=True, kw_only=True)
class _Union:
    """The union of several solids; the depth of a point is its greatest depth in any of them."""

    parts: tuple[tuple[ConvexSolid, RigidTransform], ...]

    def depth(self, points: Array) -> Array:
        depths = [solid.depth(to_frame(pose.inverse(), points)) for solid, pose in self.parts]
        return np.max(depths, axis=0)

    def surface(self, spacing_m: float) -> Array:
        points = np.vstack([to_frame(pose, solid.surface(spacing_m)) for solid, pose in self.parts])
        # One point per cell of a grid: meshes have many more.
        cells = np.unique((points / (0.3 * spacing_m)).round().astype(np.int64), axis=0, return_index=True)[1]
        points = points[np.sort(cells)]
        return points[self.depth(points) < 1e-6]

    def inside(self, spacing_m: float) -> Array:
        grids: list[Array] = []
        for solid, pose in self.parts:
            lower, upper = solid.box()
            counts = np.maximum(1, np.ceil((upper - lower) / spacing_m)).astype(int)
            # Cell centers: they include the center plane of a thin solid.
            cells = np.indices(tuple(counts.tolist())).reshape(3, -1).T
            grid = lower + (cells + 0.5) * (upper - lower) / counts
            grid = np.vstack((grid[solid.depth(grid) > 0.0], solid.centre))
            grids.append(to_frame(pose, grid))
        return np.vstack(grids)


def _fit(solids: Sequence[LinkSolid]) -> Array:
    union = _Union(parts=tuple((convex_solid(solid.shape), solid.pose) for solid in solids))
    deepest = max(float(union.depth(to_frame(pose, s.centre[None]))[0]) for s, pose in union.parts)
    corners = np.vstack([to_frame(pose, np.array(s.box())) for s, pose in union.parts])
    length = float(np.linalg.norm(corners.max(axis=0) - corners.min(axis=0)))
    inflation = min(max(_DEPTH_SHARE * deepest, _LENGTH_SHARE * length, _LEAST_INFLATION_M), _MOST_INFLATION_M)
    spacing = 0.25 * inflation
    centres = union.inside(1.6 * inflation)
    if len(centres) > _MOST_CANDIDATES:
        centres = centres[np.linspace(0, len(centres) - 1, _MOST_CANDIDATES).astype(int)]
    centres = np.vstack((_deepened(union, centres, inflation), centres))
    radii = np.maximum(union.depth(centres), 0.0) + inflation
    surface = union.surface(spacing)
    # Slack with which a sphere must contain a point to contain the surface around it too.
    samples = np.vstack((surface, centres))
    slack = np.concatenate((np.full(len(surface), 0.8 * spacing), np.zeros(len(centres))))
    covers = _distances(centres, samples) <= radii[:, None] - slack[None, :]
    chosen: list[Array] = []
    left = np.ones(len(samples), dtype=bool)
    gains = covers.sum(axis=1)
    while left.any():
        best = int(np.argmax(gains))
        if gains[best] == 0:
            # No candidate covers this point: add a small sphere for it.
            point = samples[int(np.argmax(left))]
            sphere = np.append(point, max(float(union.depth(point[None])[0]), 0.0) + inflation)
        else:
            sphere = np.append(centres[best], radii[best])
        chosen.append(sphere)
        covered = left & (np.linalg.norm(samples - sphere[:3], axis=1) <= sphere[3] - slack + 1e-12)
        gains -= covers[:, covered].sum(axis=1)
        left &= ~covered
    return np.array(chosen)


def _deepened(union: _Union, points: Array, step_m: float) -> Array:
    """Return points moved to the greatest depth nearby: the best centers are in the middle of a link."""
    points, depths = points.copy(), union.depth(points)
    directions = np.vstack((np.eye(3), -np.eye(3)))
    for scale in (1.0, 1.0, 0.5, 0.5, 0.25, 0.25, 0.1, 0.1):
        for direction in directions:
            moved = points + scale * step_m * direction
            deeper = union.depth(moved)
            better = deeper > depths + 1e-6
            points[better], depths[better] = moved[better], deeper[better]
    return points


def _distances(a: Array, b: Array) -> Array:
    square = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1)[None, :] - 2.0 * a @ b.T
    return np.sqrt(np.maximum(square, 0.0))
