"""A planning scene and one of its arms as the arrays of the compiled core."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robots.model.rigid import Rigid
from robots.planning.arm_spheres import arm_spheres, balls_around, bare_problem, rows
from robots.planning.coal_shapes import coal_shape
from robots.planning.problem import BALL, KIND, PLACE, PLANES, SIZE, SOLID_COLUMNS, TURN, Indices, Problem
from robots.planning.scene import AttachedPart, PlanningScene
from robots.planning.solids import convex_solid, to_frame
from robots.planning.sphere_fit import LinkSolid, covering_spheres
from robots.planning.surroundings import PlacedSolid, surroundings
from robots.port import Array

# Of the greatest motion bound, as for the exact check; no finer, the exact check comes after.
_STEP_SHARE, _LEAST_STEP_M, _MOST_STEP_M = 0.016, 0.01, 0.04


@dataclass(frozen=True, kw_only=True)
class Names:
    """The names of a problem's links (held parts among them) and of its solids, in the order of its arrays."""

    links: tuple[str, ...]
    solids: tuple[str, ...]


def problem_of(scene: PlanningScene, arm: str, *, margin_m: float = 0.0) -> tuple[Problem, Names]:
    """Return the problem of moving an arm of a scene; its `margin_m` counts against obstacles and other arms.

    Raises:
        CellError: there is no such arm, or a shape or model is wrong.
    """
    placed = scene.arm(arm)
    model = placed.placement.robot()
    body = arm_spheres(model, placed.tool_joints)
    problem = bare_problem(body, model)
    base = Rigid.from_pose(placed.placement.base)
    spheres = [
        _moved(base, group) if not joint else group for joint, group in zip(body.link_joint, body.spheres, strict=True)
    ]
    names, joints = [f"{arm}/{link}" for link in body.links], body.link_joint.tolist()
    pairs, pair_gap = [*body.pairs], body.pair_gap.tolist()
    for part in scene.attached:
        if part.arm == arm:
            joint, group = _held(part, body.frames[part.link or model.tool_link])
            others = [i for i, other in enumerate(joints) if other != joint]
            pairs += [(i, len(names)) for i in others]
            pair_gap += [0.0] * len(others)
            names.append(part.name)
            joints.append(joint)
            spheres.append(group)
    kept = [i for i, (a, b) in enumerate(pairs) if not scene.may_touch(names[a], names[b])]
    placements = body.chain.copy()
    placements[0, :, :3] = base.rotation @ placements[0, :, :3]
    placements[0, :, 3] = base.rotation @ placements[0, :, 3] + base.xyz
    outside = surroundings(scene, arm)
    return _with_solids(scene, outside, names, margin_m, problem)._replace(
        placements=rows(placements),
        bound=_with_held(problem.bound, joints, spheres, body.link_joint),
        step_m=min(max(_STEP_SHARE * float(problem.bound.max()), _LEAST_STEP_M), _MOST_STEP_M),
        link_joint=np.array(joints, dtype=np.int64),
        link_ball=balls_around(tuple(spheres)),
        first_sphere=np.cumsum([0, *(len(group) for group in spheres)], dtype=np.int64),
        spheres=np.vstack(spheres),
        pairs=np.array([pairs[i] for i in kept], dtype=np.int64).reshape(-1, 2),
        pair_gap=np.array([pair_gap[i] for i in kept]),
    ), Names(links=tuple(names), solids=tuple(solid.name for solid in outside))


def _with_solids(
    scene: PlanningScene, placed: tuple[PlacedSolid, ...], links: list[str], margin_m: float, problem: Problem
) -> Problem:
    solids = [convex_solid(solid.shape) for solid in placed]
    numbers = np.empty((len(placed), SOLID_COLUMNS))
    plane = 0
    for row, one, solid in zip(numbers, placed, solids, strict=True):
        # Checks the sizes, and names what is wrong.
        coal_shape(one.shape, one.name)
        row[KIND], row[PLANES], row[PLANES + 1] = solid.kind, plane, plane + len(solid.planes)
        row[TURN:PLACE], row[PLACE:SIZE], row[SIZE:BALL] = one.pose.rotation.ravel(), one.pose.xyz, solid.size
        row[BALL:PLANES] = np.append(to_frame(one.pose, solid.centre[None])[0], solid.radius_m)
        plane += len(solid.planes)
    gaps = np.full((len(links), len(placed)), margin_m)
    verdicts: dict[tuple[str, str], bool] = {}
    for row, link in enumerate(links):
        for column, one in enumerate(placed):
            pair = (link, one.name)
            if pair not in verdicts:
                verdicts[pair] = scene.may_touch(*pair)
            if verdicts[pair]:
                gaps[row, column] = -np.inf
    return problem._replace(
        solids=numbers,
        planes=np.vstack([np.empty((0, 4)), *(solid.planes for solid in solids)]),
        solid_gap=gaps,
    )


def _held(part: AttachedPart, frame: tuple[int, Rigid]) -> tuple[int, Array]:
    """Return the joint that a held part moves with, and its spheres in that joint's frame."""
    joint, link = frame
    at = link.then(Rigid.from_pose(part.pose))
    for solid in part.solids:
        coal_shape(solid.shape, part.name)
    solids = [LinkSolid(shape=solid.shape, pose=Rigid.from_pose(solid.pose)) for solid in part.solids]
    return joint, _moved(at, covering_spheres(solids))


def _moved(pose: Rigid, spheres: Array) -> Array:
    moved = spheres.copy()
    moved[:, :3] = to_frame(pose, spheres[:, :3])
    return moved


def _with_held(bound: Array, joints: list[int], spheres: list[Array], own: Indices) -> Array:
    """Return the motion bound made larger by what is held beyond the arm itself."""
    farthest = 0.0
    for joint, group in list(zip(joints, spheres, strict=True))[len(own) :]:
        ball = float((np.linalg.norm(group[:, :3], axis=1) + group[:, 3]).max())
        farthest = max(farthest, ball - float(bound[joint - 1]))
    return bound + farthest
