"""Measures how far an arm with what it holds is from the unknown bodies in the occupancy map."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from engine.messages import Vector3
from engine.messages.sensing import OccupancyGrid
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.planning.scene.convex_shapes import convex_solid, to_frame
from robots.planning.scene.planning_scene import AttachedPart
from robots.planning.search.arm_spheres import arm_spheres
from robots.port import Array
from robots.vision.occupancy.arm_body import ArmBody
from robots.vision.occupancy.solid_distance import solid_distance
from robots.vision.voxel_box import occupied_centres

# Half the diagonal of a voxel in edges: the body that filled a voxel is somewhere in it.
_HALF_DIAGONAL = math.sqrt(3.0) / 2.0


@dataclass(frozen=True, kw_only=True)
class NearestBody:
    """The smallest distance of an arm, infinite without unknown bodies; `body` of the arm is nearest to `at_m`."""

    distance_m: float = math.inf
    body: str = ""
    at_m: Vector3 | None = None


class UnknownBodies:
    """The occupied voxels of a map, unpacked once per revision."""

    def __init__(self) -> None:
        self._revision = -1
        self._points: Array = np.empty((0, 3))

    def points(self, grid: OccupancyGrid) -> Array:
        """Return the centres of the occupied voxels, (k, 3), world."""
        if grid.revision != self._revision:
            self._points, self._revision = occupied_centres(grid), grid.revision
        return self._points


def nearest_body(
    arm: str, balls: Mapping[str, Array], held: Iterable[tuple[AttachedPart, RigidTransform]], grid_points: Array
) -> NearestBody:
    """Return the body of an arm that is nearest to a voxel, and how far its surface is from the voxel's centre.

    `balls` (k, 4) cover its links by name, `held` are its parts with the poses of the links that hold them.
    """
    if not len(grid_points):
        return NearestBody()
    # Imported here: it loads compiled code.
    from robots.workspace.separation_kernels import nearest_point

    nearest = NearestBody()
    points = np.ascontiguousarray(grid_points)
    for link, spheres in balls.items():
        gap_m, point, _ = nearest_point(points, np.ascontiguousarray(spheres), nearest.distance_m)
        if point >= 0:
            nearest = _found(gap_m, f"{arm}/{link}", points[point])
    for part, link in held:
        pose = link.then(RigidTransform.from_pose(part.pose))
        for solid in part.solids:
            at = pose.then(RigidTransform.from_pose(solid.pose))
            gaps = solid_distance(convex_solid(solid.shape), (grid_points - at.xyz) @ at.rotation)
            nearest = _nearer(nearest, gaps, part.name, grid_points)
    return nearest


def voxel_reach_m(grid: OccupancyGrid) -> float:
    """Return the distance from the centre of a voxel to its corners."""
    return grid.voxel_m * _HALF_DIAGONAL


def moving_links(body: ArmBody, model: RobotModel) -> frozenset[str]:
    """Return the links of an arm and its tool that its joints move."""
    fitted = arm_spheres(model, ())
    moved = {link for link, joint in zip(fitted.links, fitted.link_joint.tolist(), strict=True) if joint > 0}
    return frozenset(link for link in body.links if link in moved)


def link_extents_m(model: RobotModel) -> tuple[float, ...]:
    """Return how far the link behind each joint extends, as in `MeasuredSeparation`; without held parts."""
    fitted = arm_spheres(model, ())
    extents = np.zeros(model.dof)
    for joint, spheres in zip(fitted.link_joint.tolist(), fitted.spheres, strict=True):
        if joint > 0:
            end = fitted.chain[joint][:, 3] if joint < model.dof else np.zeros(3)
            beside = _from_segment(spheres[:, :3], end) + spheres[:, 3]
            extents[joint - 1] = max(extents[joint - 1], float(beside.max()))
    return tuple(extents.tolist())


def held_reach_m(part: AttachedPart) -> float:
    """Return how far a held part extends from the origin of the link that holds it."""
    pose, far_m = RigidTransform.from_pose(part.pose), 0.0
    for solid in part.solids:
        low, high = convex_solid(solid.shape).box()
        corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
        placed = to_frame(pose.then(RigidTransform.from_pose(solid.pose)), corners)
        far_m = max(far_m, float(np.linalg.norm(placed, axis=1).max()))
    return far_m


def _nearer(nearest: NearestBody, gaps: Array, body: str, points: Array) -> NearestBody:
    first = int(gaps.argmin())
    return nearest if gaps[first] >= nearest.distance_m else _found(float(gaps[first]), body, points[first])


def _found(distance_m: float, body: str, point: Array) -> NearestBody:
    x, y, z = point.tolist()
    return NearestBody(distance_m=distance_m, body=body, at_m=(x, y, z))


def _from_segment(points: Array, end: Array) -> Array:
    """Return the distances of points (k, 3) from the segment between the origin and `end`."""
    square = float(end @ end)
    share = np.clip(points @ end / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(points))
    return np.linalg.norm(points - share[:, None] * end, axis=1)
