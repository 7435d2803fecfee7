"""Converts a planning scene and one of its arms to the arrays of the compiled core."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.model.transform import RigidTransform
from robots.planning.scene.allowed_collisions import allowed_collision_matrix
from robots.planning.scene.compiled_problem import (
    BALL,
    FREE,
    GRID,
    HIGH,
    KIND,
    LOW,
    PLACE,
    PLANES,
    SIZE,
    SOLID_COLUMNS,
    TURN,
    CompiledProblem,
    Indices,
)
from robots.planning.scene.convex_shapes import to_frame
from robots.planning.scene.planning_scene import OCCUPANCY, AttachedPart, PlanningScene
from robots.planning.scene.shape_cache import cached_shape
from robots.planning.scene.static_scene import ArmInScene, PlacedSolid, arm_in_scene
from robots.planning.scene.voxels import Voxels
from robots.planning.search.arm_spheres import arm_only_problem, arm_spheres, bounding_balls, pack_placements
from robots.planning.search.sphere_fit import LinkSolid, covering_spheres
from robots.port import Array

# Share of the largest motion bound, as in the exact check; not finer, as the exact check follows.
_STEP_SHARE, _LEAST_STEP_M, _MOST_STEP_M = 0.016, 0.01, 0.04


@dataclass(frozen=True, kw_only=True)
class ProblemNames:
    """The names of a problem's links (including held parts) and of its solids, in the order of its arrays."""

    links: tuple[str, ...]
    solids: tuple[str, ...]


def compile_problem(
    scene: PlanningScene, arm: str, *, margin_m: float = 0.0, among: ArmInScene | None = None
) -> tuple[CompiledProblem, ProblemNames]:
    """Return the problem of moving an arm of a scene; `margin_m` applies to obstacles and other arms.

    `among` is the result of `arm_in_scene` for this scene and arm, if available.

    Raises:
        CellError: there is no such arm, or a shape or model is invalid.
    """
    among = among or arm_in_scene(scene, arm)
    placed, model = among.placed, among.model
    body = arm_spheres(model, placed.tool_joints)
    problem = arm_only_problem(body, model)
    base = RigidTransform.from_pose(placed.placement.base)
    spheres = [
        _moved(base, group) if not joint else group for joint, group in zip(body.link_joint, body.spheres, strict=True)
    ]
    names, joints = [f"{arm}/{link}" for link in body.links], body.link_joint.tolist()
    pairs, pair_gap = [*body.pairs], body.pair_gap.tolist()
    for part in among.held:
        joint, group = _held(part, body.frames[part.link or model.tool_link])
        others = [i for i, other in enumerate(joints) if other != joint]
        pairs += [(i, len(names)) for i in others]
        pair_gap += [0.0] * len(others)
        names.append(part.name)
        joints.append(joint)
        spheres.append(group)
    allowed = allowed_collision_matrix(scene, names, names)
    kept = [i for i, (a, b) in enumerate(pairs) if not allowed[a, b]]
    placements = body.chain.copy()
    placements[0, :, :3] = base.rotation @ placements[0, :, :3]
    placements[0, :, 3] = base.rotation @ placements[0, :, 3] + base.xyz
    return _with_solids(scene, among.outside, names, margin_m, problem)._replace(
        placements=pack_placements(placements),
        bound=_with_held(problem.bound, joints, spheres, body.link_joint),
        step_m=min(max(_STEP_SHARE * float(problem.bound.max()), _LEAST_STEP_M), _MOST_STEP_M),
        link_joint=np.array(joints, dtype=np.int64),
        link_ball=bounding_balls(tuple(spheres)),
        first_sphere=np.cumsum([0, *(len(group) for group in spheres)], dtype=np.int64),
        spheres=np.vstack(spheres),
        pairs=np.array([pairs[i] for i in kept], dtype=np.int64).reshape(-1, 2),
        pair_gap=np.array([pair_gap[i] for i in kept]),
    ), ProblemNames(links=tuple(names), solids=tuple(solid.name for solid in among.outside))


def with_voxels(
    problem: CompiledProblem, names: ProblemNames, scene: PlanningScene, voxels: Voxels | None, *, margin_m: float = 0.0
) -> tuple[CompiledProblem, ProblemNames]:
    """Return the problem with the voxels of the occupancy map added; moving links keep `margin_m` from them."""
    if voxels is None:
        return problem, names
    low, high = voxels.grid[LOW:HIGH], voxels.grid[HIGH:]
    row = np.zeros((1, SOLID_COLUMNS))
    row[0, KIND] = GRID
    row[0, BALL:PLANES] = np.append((low + high) / 2.0, np.linalg.norm(high - low) / 2.0)
    gaps = np.where(allowed_collision_matrix(scene, names.links, (OCCUPANCY,)), -np.inf, margin_m)
    return problem._replace(
        solids=np.vstack((problem.solids, row)),
        solid_gap=np.hstack((problem.solid_gap, gaps)),
        voxels=voxels.field,
        voxel_grid=voxels.grid,
    ), ProblemNames(links=names.links, solids=(*names.solids, OCCUPANCY))


def voxels_alone(problem: CompiledProblem) -> CompiledProblem:
    """Return the problem with only the voxels that `with_voxels` added."""
    return problem._replace(
        solids=problem.solids[-1:],
        solid_gap=np.ascontiguousarray(problem.solid_gap[:, -1:]),
        pairs=problem.pairs[:0],
        pair_gap=problem.pair_gap[:0],
        orientation=FREE,
    )


def _with_solids(
    scene: PlanningScene, placed: tuple[PlacedSolid, ...], links: list[str], margin_m: float, problem: CompiledProblem
) -> CompiledProblem:
    solids = [one.ready.solid for one in placed]
    numbers = np.empty((len(placed), SOLID_COLUMNS))
    plane = 0
    for row, one, solid in zip(numbers, placed, solids, strict=True):
        row[KIND], row[PLANES], row[PLANES + 1] = solid.kind, plane, plane + len(solid.planes)
        rotation = one.pose.rotation
        row[TURN:PLACE], row[PLACE:SIZE], row[SIZE:BALL] = rotation.ravel(), one.pose.xyz, solid.size
        row[BALL : PLANES - 1], row[PLANES - 1] = rotation @ solid.centre + one.pose.xyz, solid.radius_m
        plane += len(solid.planes)
    gaps = np.where(allowed_collision_matrix(scene, links, [one.name for one in placed]), -np.inf, margin_m)
    return problem._replace(
        solids=numbers,
        planes=np.vstack([np.empty((0, 4)), *(solid.planes for solid in solids)]),
        solid_gap=gaps,
    )


def _held(part: AttachedPart, frame: tuple[int, RigidTransform]) -> tuple[int, Array]:
    """Return the joint that a held part moves with, and its spheres in that joint's frame."""
    joint, link = frame
    at = link.then(RigidTransform.from_pose(part.pose))
    for solid in part.solids:
        cached_shape(solid.shape, part.name)
    solids = [LinkSolid(shape=solid.shape, pose=RigidTransform.from_pose(solid.pose)) for solid in part.solids]
    return joint, _moved(at, covering_spheres(solids))


def _moved(pose: RigidTransform, spheres: Array) -> Array:
    moved = spheres.copy()
    moved[:, :3] = to_frame(pose, spheres[:, :3])
    return moved


def _with_held(bound: Array, joints: list[int], spheres: list[Array], own: Indices) -> Array:
    """Return the motion bound, enlarged by held parts that extend beyond the arm."""
    farthest = 0.0
    for joint, group in list(zip(joints, spheres, strict=True))[len(own) :]:
        ball = float((np.linalg.norm(group[:, :3], axis=1) + group[:, 3]).max())
        farthest = max(farthest, ball - float(bound[joint - 1]))
    return bound + farthest
