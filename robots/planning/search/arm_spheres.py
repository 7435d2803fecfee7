"""An arm as links of spheres in the frames of its joints, and the smallest allowed gaps between two links' spheres."""

from __future__ import annotations

import io
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from engine.host.user_cache import cache_dir
from robots.model.inverse_kinematics.chain import chain_of
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.robot_model import RobotModel
from robots.model.transform import RigidTransform
from robots.model.urdf.mesh_cache import content_key, read_cached, write_cached
from robots.planning.scene.arm_shapes import ArmShapes, arm_shapes
from robots.planning.scene.coal_shapes import pin, rigid_of, shape_of
from robots.planning.scene.compiled_problem import FREE, GRID_COLUMNS, SOLID_COLUMNS, CompiledProblem, Indices
from robots.planning.scene.motion_bound import motion_bound
from robots.planning.search.sphere_fit import LinkSolid, covering_spheres
from robots.port import Array

_ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
_RECIPE, _SAMPLES = "pair gaps 3", 3000
# Weight of a touching configuration classified as free, relative to a free one classified as touching.
_TOO_FREE = 2.0


@dataclass(frozen=True, kw_only=True)
class ArmSpheres:
    """The part of a `CompiledProblem` that depends on the arm alone; its base is the world."""

    chain: Array
    """(n + 1, 3, 4)"""
    sliding: Array
    bound: Array
    links: tuple[str, ...]
    link_joint: Indices
    spheres: tuple[Array, ...]
    """of each link (s, 4)"""
    frames: dict[str, tuple[int, RigidTransform]]
    """of each link of the URDF: the joint that it moves with and its pose in that joint's frame"""
    pairs: tuple[tuple[int, int], ...]
    pair_gap: Array


@lru_cache(maxsize=32)
def arm_spheres(model: RobotModel, tool_joints: tuple[tuple[str, float], ...]) -> ArmSpheres:
    """Return an arm's spheres; the first computation takes seconds and is cached on disk."""
    shapes = arm_shapes(model, tool_joints)
    chain = chain_of(ArmKinematics(model, base=_ORIGIN))
    frames = _frames(shapes, chain.placements)
    solids: dict[str, list[LinkSolid]] = {}
    for link, shape in zip(shapes.links, shapes.geometry.geometryObjects, strict=False):
        frame = shapes.solver.frames[shape.parentFrame]
        pose = rigid_of(frame.placement.inverse() * shape.placement)
        solids.setdefault(link, []).append(LinkSolid(shape=shape_of(shape.geometry), pose=pose))
    links = tuple(solids)
    spheres: list[Array] = []
    for link in links:
        fitted = covering_spheres(solids[link]).copy()
        pose = frames[link][1]
        fitted[:, :3] = fitted[:, :3] @ pose.rotation.T + pose.xyz
        spheres.append(fitted)
    pairs = tuple((links.index(a), links.index(b)) for a, b in shapes.pairs)
    arm = ArmSpheres(
        chain=chain.placements,
        sliding=chain.sliding.astype(np.float64),
        bound=motion_bound(shapes.solver, shapes.geometry),
        links=links,
        link_joint=np.array([frames[link][0] for link in links], dtype=np.int64),
        spheres=tuple(spheres),
        frames=frames,
        pairs=pairs,
        pair_gap=np.zeros(len(pairs)),
    )
    # The gaps hardly depend on the tool's joints, so those of the tool at rest are used.
    if tool_joints:
        at_rest = arm_spheres(model, ())
        gap_of = dict(zip(at_rest.pairs, at_rest.pair_gap.tolist(), strict=True))
        gaps = np.array([gap_of.get(pair, 0.0) for pair in pairs])
    else:
        gaps = _cached_gaps(model, shapes, arm)
    arm.pair_gap[:] = gaps
    arm.pair_gap.flags.writeable = False
    return arm


def bounding_balls(spheres: tuple[Array, ...]) -> Array:
    """Return for each set of spheres (s, 4) a bounding sphere, (sets, 4)."""
    balls = np.empty((len(spheres), 4))
    for ball, group in zip(balls, spheres, strict=True):
        low, high = (group[:, :3] - group[:, 3:]).min(axis=0), (group[:, :3] + group[:, 3:]).max(axis=0)
        ball[:3] = (low + high) / 2.0
        ball[3] = (np.linalg.norm(group[:, :3] - ball[:3], axis=1) + group[:, 3]).max()
    return balls


def pack_placements(placements: Array) -> Array:
    """Return placements (k, 3, 4) in the form of the compiled core, (k, 12): rotation by rows, then position."""
    return np.hstack((placements[:, :, :3].reshape(-1, 9), placements[:, :, 3]))


def arm_only_problem(arm: ArmSpheres, model: RobotModel) -> CompiledProblem:
    """Return the problem of an arm alone at the origin of the world."""
    limits = np.array([model.limits.lower_rad, model.limits.upper_rad])
    return CompiledProblem(
        placements=pack_placements(arm.chain),
        sliding=arm.sliding.astype(np.bool_),
        limits=np.vstack((limits, limits)),
        bound=arm.bound,
        step_m=0.02,
        link_joint=arm.link_joint,
        link_ball=bounding_balls(arm.spheres),
        first_sphere=np.cumsum([0, *(len(group) for group in arm.spheres)], dtype=np.int64),
        spheres=np.vstack(arm.spheres),
        pairs=np.array(arm.pairs, dtype=np.int64).reshape(-1, 2),
        pair_gap=arm.pair_gap,
        solids=np.empty((0, SOLID_COLUMNS)),
        planes=np.empty((0, 4)),
        solid_gap=np.empty((len(arm.links), 0)),
        voxels=np.empty((0, 0, 0), dtype=np.float32),
        voxel_grid=np.zeros(GRID_COLUMNS),
        orientation=FREE,
        upright=np.vstack((np.eye(3), (0.0, 0.0, 1.0))),
        tolerance=0.0,
    )


def _frames(shapes: ArmShapes, chain: Array) -> dict[str, tuple[int, RigidTransform]]:
    """Return every link's joint and its pose in that joint's frame of the chain."""
    solver = shapes.solver
    data = solver.createData()
    pin.framesForwardKinematics(solver, data, np.zeros(solver.nq))
    at = [_ORIGIN]
    for placement in chain[:-1]:
        rotation = pin.Quaternion(np.ascontiguousarray(placement[:, :3]))
        at.append(at[-1].then(RigidTransform.of(placement[:, 3], np.array(rotation.coeffs()))))
    return {
        str(frame.name): (int(frame.parentJoint), at[int(frame.parentJoint)].inverse().then(rigid_of(data.oMf[index])))
        for index, frame in enumerate(solver.frames)
        if frame.type == pin.FrameType.BODY
    }


def _cached_gaps(model: RobotModel, shapes: ArmShapes, arm: ArmSpheres) -> Array:
    """Return the pairs' gaps, from the disk cache if available."""
    content = b"".join(
        [model.urdf_text.encode(), *(group.tobytes() for group in arm.spheres), repr(arm.pairs).encode()]
    )
    key, folder = content_key(content, recipe=_RECIPE), cache_dir() / "spheres"
    kept = read_cached(folder, key)
    if kept is not None:
        return np.load(io.BytesIO(kept), allow_pickle=False)
    gaps = _sampled_gaps(model, shapes, arm)
    file = io.BytesIO()
    np.save(file, gaps, allow_pickle=False)
    write_cached(folder, key, file.getvalue())
    return gaps


def _sampled_gaps(model: RobotModel, shapes: ArmShapes, arm: ArmSpheres) -> Array:
    """Return for each pair the distance of its spheres that best separates touching from free links."""
    from robots.planning.search.kernels import gaps

    problem = arm_only_problem(arm, model)
    nothing = np.empty((len(arm.links), 0))
    solver, geometry = shapes.solver, shapes.geometry
    data, geometry_data = solver.createData(), geometry.createData()
    names = shapes.links
    number: dict[frozenset[str], int] = {
        frozenset((arm.links[a], arm.links[b])): i for i, (a, b) in enumerate(arm.pairs)
    }
    touching = [(int(pair.first), int(pair.second)) for pair in geometry.collisionPairs]
    numbers = [number[frozenset((names[a], names[b]))] for a, b in touching]
    owner = np.array(numbers, dtype=np.int64)
    random = np.random.default_rng(0)
    exact, spheres = np.full((_SAMPLES, len(arm.pairs)), np.inf), np.empty((_SAMPLES, len(arm.pairs)))
    for row in range(_SAMPLES):
        share = random.random(len(problem.bound))
        joints = problem.limits[0] + share * (problem.limits[1] - problem.limits[0])
        pin.computeDistances(solver, data, geometry, geometry_data, joints)
        distances = np.array([result.min_distance for result in geometry_data.distanceResults])
        np.minimum.at(exact[row], owner, distances)
        gaps(problem, joints, nothing, spheres[row])
    return np.array([_best_limit(spheres[:, pair], exact[:, pair]) for pair in range(len(arm.pairs))])


def _best_limit(spheres: Array, exact: Array) -> float:
    """Return the limit, at most 0, that classifies distances of spheres as touching with the fewest errors."""
    order = np.argsort(spheres)
    touching = exact[order] <= 0.0
    # With the limit at the i-th distance, those before it count as touching.
    too_free = _TOO_FREE * np.append(touching[::-1].cumsum()[::-1], 0)
    too_strict = np.append(0, (~touching).cumsum())
    limits = np.append(spheres[order], np.inf)
    errors = np.where(limits <= 0.0, too_free + too_strict, np.inf)
    if not np.isfinite(errors).any() or not touching.any():
        # The links never touched: only an overlap deeper than any sampled one may mean contact.
        return min(0.0, float(spheres.min()))
    return float(limits[int(np.argmin(errors))])
