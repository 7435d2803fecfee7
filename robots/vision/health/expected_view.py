"""What of the known geometry a camera must see: fixtures and arms along a sample of its rays."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from engine.messages.sensing import CameraIntrinsics
from engine.messages.shapes import Obstacle
from robots.model.transform import RigidTransform
from robots.planning.scene.convex_shapes import ConvexSolid, convex_solid
from robots.port import Array
from robots.vision.cameras.camera import CameraSpec, Image, directions
from robots.vision.health.expected_view_kernels import ball_spans
from robots.vision.occupancy.solid_distance import solid_distance

Flags = NDArray[np.bool_]

_COLUMNS, _ROWS = 64, 48
_TRACING_STEPS, _HIT_M, _TILT_M = 96, 1e-4, 1e-4
# The spheres of an arm are larger than the arm: rays that pass so far inside them hit it.
_CORE_M, _BEYOND_M = 0.03, 0.03
_BESIDE_ARM_M, _BEHIND_ARM_M = 0.05, 0.05
_TOLERANCE_M, _DEVIATIONS = 0.03, 4.0
_LEAST_COSINE = 0.05


@dataclass(frozen=True, kw_only=True)
class ViewComparison:
    """How an image agrees with the known geometry, as numbers of sampled pixels.

    Of the `fixtures` pixels that must show a fixture, `farther` measure something behind its surface, `nearer`
    something before it; `nearer_spread_m` is the interquartile range of how far before. Of the `arms` pixels that
    must show an arm, `through_arms` measure something behind it. `silhouette` are the pixels at which an arm may be.
    """

    fixtures: int
    farther: int
    nearer: int
    nearer_m: float
    nearer_spread_m: float
    arms: int
    through_arms: int
    silhouette: Flags


class ExpectedView:
    """The sampled rays of one camera, and where they meet the fixtures.

    Args:
        camera: The camera as it is calibrated.
        intrinsics: Those of its images.
        fixtures: Bodies that do not move.
    """

    def __init__(self, camera: CameraSpec, intrinsics: CameraIntrinsics, fixtures: Iterable[Obstacle]) -> None:
        self._camera = camera
        pose = RigidTransform.from_pose(camera.pose)
        width, height = intrinsics.width_px, intrinsics.height_px
        columns = np.unique(np.linspace(0, width - 1, min(_COLUMNS, width)).round().astype(int))
        rows = np.unique(np.linspace(0, height - 1, min(_ROWS, height)).round().astype(int))
        self._pixels = np.ix_(rows, columns)
        ahead = directions(intrinsics).reshape(height, width, 3)[self._pixels].reshape(-1, 3)
        self._length = np.linalg.norm(ahead, axis=1)
        self._start, self._turn = pose.xyz.copy(), np.ascontiguousarray(pose.rotation)
        # Where the rays pass the plane 1 m ahead.
        self._across: Array = (columns - intrinsics.cx_px) / intrinsics.fx_px
        self._down: Array = (rows - intrinsics.cy_px) / intrinsics.fy_px
        self._along: Array = np.ascontiguousarray((ahead / self._length[:, None]) @ pose.rotation.T)
        self._fixture_m, self._cosine, owner = self._trace(fixtures)
        depth = self._fixture_m / self._length
        measurable = (depth > camera.range_m[0]) & (depth < camera.range_m[1]) & (self._cosine > _LEAST_COSINE)
        self._inside = _inner(owner.reshape(len(rows), len(columns))).reshape(-1) & measurable

    def compare(self, depth: Image, balls: Array) -> ViewComparison:
        """Compare an image with the fixtures and the arms, whose spheres are `balls` (m, 4)."""
        along = depth[self._pixels].reshape(-1).astype(np.float64) * self._length
        measured = along > 0.0
        front, back = np.empty(len(along)), np.empty(len(along))
        grid = self._across, self._down, self._along
        ball_spans(self._start, self._turn, *grid, balls, _CORE_M, _BEYOND_M, front, back)
        fixtures = self._inside & measured & (front > self._fixture_m + _BESIDE_ARM_M)
        with np.errstate(invalid="ignore"):
            behind = (along - self._fixture_m) * self._cosine
        noise_m = _DEVIATIONS * self._camera.noise_m * (np.minimum(self._fixture_m, 1e3) / self._length) ** 2
        tolerance = _TOLERANCE_M + noise_m
        nearer = fixtures & (behind < -tolerance)
        near, far = self._camera.range_m
        silhouette = (front > near * self._length) & (front < np.minimum(self._fixture_m, far * self._length))
        must_show = silhouette & (back > 0.0) & (back < np.minimum(self._fixture_m, far * self._length))
        before = -behind[nearer]
        low, middle, high = np.percentile(before, (25, 50, 75)).tolist() if len(before) else (0.0, 0.0, 0.0)
        arms = must_show & measured
        return ViewComparison(
            fixtures=int(fixtures.sum()),
            farther=int((fixtures & (behind > tolerance)).sum()),
            nearer=int(nearer.sum()),
            nearer_m=middle,
            nearer_spread_m=high - low,
            arms=int(arms.sum()),
            through_arms=int((arms & (along > back + _BEHIND_ARM_M)).sum()),
            silhouette=silhouette,
        )

    def _trace(self, fixtures: Iterable[Obstacle]) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return the distance of the first fixture along each ray, the cosine of its incidence, and its number."""
        count = len(self._along)
        distance, cosine = np.full(count, np.inf), np.zeros(count)
        owner = np.full(count, -1, dtype=np.int64)
        solids = [
            (convex_solid(solid.shape), RigidTransform.from_pose(one.pose).then(RigidTransform.from_pose(solid.pose)))
            for one in fixtures
            for solid in one.solids
        ]
        for number, (solid, pose) in enumerate(solids):
            start = (self._start - pose.xyz) @ pose.rotation
            along = self._along @ pose.rotation
            away = _first_hit(solid, start, along, 2.0 * self._camera.range_m[1])
            hit = away < distance
            distance[hit], owner[hit] = away[hit], number
            cosine[hit] = _incidence(solid, start + along[hit] * away[hit, None], along[hit])
        return distance, cosine, owner


def _first_hit(solid: ConvexSolid, start: Array, along: Array, reach_m: float) -> Array:
    """Return the distance at which rays meet a solid, infinite for none."""
    away = np.zeros(len(along))
    hit = np.zeros(len(along), dtype=np.bool_)
    for _ in range(_TRACING_STEPS):
        gap = solid_distance(solid, start + along * away[:, None])
        hit |= gap < _HIT_M
        going = ~hit & (away < reach_m)
        if not going.any():
            break
        away[going] += gap[going]
    return np.where(hit, away, np.inf)


def _incidence(solid: ConvexSolid, points: Array, along: Array) -> Array:
    """Return the cosine between rays and the surface normals at points near the surface."""
    slope = np.stack(
        [
            solid_distance(solid, points + offset) - solid_distance(solid, points - offset)
            for offset in np.eye(3) * _TILT_M
        ],
        axis=1,
    )
    length = np.maximum(np.linalg.norm(slope, axis=1), 1e-12)
    return np.abs((slope * along).sum(axis=1) / length)


def _inner(owner: NDArray[np.int64]) -> Flags:
    """Return the samples whose neighbours belong to the same body: edges may be on either side of a pixel."""
    inner = owner >= 0
    for axis in (0, 1):
        for shift in (-1, 1):
            inner &= np.roll(owner, shift, axis=axis) == owner
    inner[[0, -1], :] = inner[:, [0, -1]] = False
    return inner
