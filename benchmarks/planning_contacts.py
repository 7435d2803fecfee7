"""Compares what the exact checker says touches with MuJoCo's contacts, pair by pair, in random configurations."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from robots.planning.scene.cell_planning_scene import planning_scene
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.search.kernels import blocked_at
from robots.planning.search.problem_compiler import compile_problem
from robots.scene.sim_scene import SimScene
from robots.sim.physics.cell_model import CellModel, build_cell
from robots.sim.physics.physics import mujoco

NEAR_M = 1e-3
"""Where two things are nearer than this, or less deep in one another, the two libraries may differ."""

Pair = frozenset[str]


@dataclass(frozen=True, kw_only=True)
class Agreement:
    """What was found: configurations, how many touch, and where the two differ by more than `NEAR_M`.

    `only_mujoco` and `only_ours` are pairs that one calls touching beyond that margin. `close` counts
    configurations in which they differ within it. `spheres_free` counts configurations that touch and
    that the spheres of the fast planner take for free, `spheres_blocked` the other way round.
    """

    configurations: int
    touching: int
    close: int
    only_mujoco: tuple[tuple[str, str], ...]
    only_ours: tuple[tuple[str, str], ...]
    spheres_free: int
    spheres_blocked: int


def compared(
    cell: SimScene, arm: str, *, configurations: int, seed: int = 0, left_out: frozenset[str] = frozenset()
) -> Agreement:
    """Return how checker and MuJoCo agree on an arm of a cell; all other arms are at home.

    Pairs with a link of `left_out` are not compared: the simulator gives some tools other shapes.
    """
    scene = planning_scene(cell)
    checker = ExactChecker(scene, arm)
    problem, _ = compile_problem(scene, arm)
    built = build_cell(cell)
    indices = next(one for one in built.arms if one.name == arm)
    data = mujoco.MjData(built.model)
    _all_home(built, data)
    unseen = _unseen_by_mujoco(built)
    looked_at = {pair for pair in checker.looked_at if not pair & left_out}
    random = np.random.default_rng(seed)
    lower, upper = np.array(checker.model.limits.lower_rad), np.array(checker.model.limits.upper_rad)
    touching = close = spheres_free = spheres_blocked = 0
    only_mujoco: set[tuple[str, str]] = set()
    only_ours: set[tuple[str, str]] = set()
    for _ in range(configurations):
        joints = lower + random.random(len(lower)) * (upper - lower)
        data.qpos[indices.qpos] = joints
        theirs = dict(_contacts(built, data, arm))
        ours: dict[Pair, tuple[str, str]] = {frozenset(pair): pair for pair in checker.colliding_pairs(joints)}
        blocked = blocked_at(problem, joints[None]) >= 0
        touching += bool(ours)
        spheres_free += bool(ours) and not blocked
        spheres_blocked += blocked and not ours
        differ = False
        for pair, depth in theirs.items():
            if pair not in ours and pair in looked_at:
                differ = True
                if depth > NEAR_M:
                    only_mujoco.add(_sorted(pair))
        for pair in ours.keys() - theirs.keys():
            if pair not in unseen and not pair & left_out:
                differ = True
                if checker.depth(joints, pair) > NEAR_M:
                    only_ours.add(_sorted(pair))
        close += differ
    return Agreement(
        configurations=configurations,
        touching=touching,
        close=close,
        only_mujoco=tuple(sorted(only_mujoco)),
        only_ours=tuple(sorted(only_ours)),
        spheres_free=spheres_free,
        spheres_blocked=spheres_blocked,
    )


def _sorted(pair: Pair) -> tuple[str, str]:
    first, second = sorted(pair) if len(pair) == 2 else (*pair, *pair)
    return first, second


def _all_home(built: CellModel, data: Any) -> None:
    for one in built.arms:
        data.qpos[one.qpos] = np.array(one.model.home_rad)


def _contacts(built: CellModel, data: Any, arm: str) -> Iterator[tuple[Pair, float]]:
    """Yield what touches the arm and how deep, metres; each pair once."""
    mujoco.mj_kinematics(built.model, data)
    mujoco.mj_comPos(built.model, data)
    mujoco.mj_collision(built.model, data)
    deepest: dict[Pair, float] = {}
    for contact in data.contact[: data.ncon]:
        names = [built.body_names[int(built.model.geom_bodyid[geom])] for geom in contact.geom]
        if any(name.startswith(f"{arm}/") for name in names):
            pair = frozenset(names)
            deepest[pair] = max(deepest.get(pair, 0.0), -float(contact.dist))
    yield from deepest.items()


def _unseen_by_mujoco(built: CellModel) -> set[Pair]:
    """Return the pairs of bodies that MuJoCo never looks at: neighbours, and those excluded."""
    model = built.model
    welded = [int(model.body_weldid[i]) for i in range(model.nbody)]
    parent = [int(model.body_weldid[int(model.body_parentid[w])]) for w in welded]
    unseen: set[Pair] = set()
    for i in range(model.nbody):
        for j in range(i):
            neighbours = welded[i] != 0 and welded[j] != 0 and (parent[i] == welded[j] or parent[j] == welded[i])
            if welded[i] == welded[j] or neighbours:
                unseen.add(frozenset((built.body_names[i], built.body_names[j])))
    for signature in model.exclude_signature:
        one, two = int(signature) >> 16, int(signature) & 0xFFFF
        unseen.add(frozenset((built.body_names[one], built.body_names[two])))
    return unseen
