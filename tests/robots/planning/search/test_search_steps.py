"""No obstacle slips through between two checks: the steps of all checks, measured on the arm's bodies in MuJoCo."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone
from engine.messages import Pose
from engine.messages.shapes import Obstacle, Sphere
from robots.planning.scene.exact_checker import ExactChecker
from robots.planning.scene.planning_scene import NamePair
from robots.planning.search.kernels import blocked_at, check_along_path
from robots.planning.search.problem_compiler import compile_problem
from robots.port import Array
from tests.robots.planning.motion_oracle import MotionOracle, fine_steps

MODELS = ("panda", "ur10", "irb4600")
LARGEST_STEP_M = {"panda": 0.02, "ur10": 0.03, "irb4600": 0.045}
"""What a point of the arm may move between two checks: 1.6 % of the reach, and its fringe."""


def swing(model: str) -> Array:
    """Two configurations, stretched out, a radian apart in the first axis and half of one in the second."""
    checker = ExactChecker(alone(model), ARM)
    start = np.array(checker.model.home_rad)
    end = start.copy()
    end[0] += 1.0
    end[1] += 0.5
    return np.vstack((start, end))


def largest_step_m(model: str, rows: Array) -> float:
    """Return how far a corner of a body of the arm moves at most between two configurations, as MuJoCo has it."""
    oracle = MotionOracle(alone(model), ARM)
    corners = [oracle.corners(joints) for joints in rows]
    return max(float(np.linalg.norm(after - before, axis=1).max()) for before, after in pairwise(corners))


class Notebook:
    """A query that never finds anything, and remembers where it was asked."""

    def __init__(self) -> None:
        self.rows: list[Array] = []

    def in_collision(self, joints: Array) -> bool:
        """Remember a configuration."""
        self.rows.append(joints)
        return False

    def colliding_pairs(self, joints: Array) -> tuple[NamePair, ...]:
        """Nothing touches."""
        return ()


@pytest.mark.parametrize("model", MODELS)
def test_the_exact_check_of_a_path_takes_small_steps(model: str) -> None:
    notebook = Notebook()
    path = swing(model)
    assert ExactChecker(alone(model), ARM).first_collision(path, query=notebook) is None
    assert len(notebook.rows) > 10
    assert largest_step_m(model, np.array(notebook.rows)) <= LARGEST_STEP_M[model]
    assert np.array_equal(notebook.rows[0], path[0])
    assert np.allclose(notebook.rows[-1], path[1])


@pytest.mark.parametrize("model", MODELS)
def test_the_check_of_an_edge_takes_the_same_steps(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """In another order: sorted along the edge they are as close."""
    notebook = Notebook()
    start, end = swing(model)
    checker = ExactChecker(alone(model), ARM)
    monkeypatch.setattr(checker, "in_collision", notebook.in_collision)
    assert checker.is_edge_free(start, end)
    rows = np.array(sorted([start, *notebook.rows], key=lambda row: float(np.abs(row - start).sum())))
    assert largest_step_m(model, rows) <= LARGEST_STEP_M[model]
    assert len({row.tobytes() for row in rows}) == len(rows)


@pytest.mark.parametrize("model", MODELS)
def test_the_check_of_a_trajectory_skips_no_more_rows_than_a_step(model: str) -> None:
    problem, _ = compile_problem(alone(model), ARM)
    rows = np.ascontiguousarray(fine_steps(swing(model)))
    checked, blocked = np.empty(len(rows), dtype=np.int64), np.empty(len(rows), dtype=np.bool_)
    count = check_along_path(problem, rows, checked, blocked)
    assert 10 < count < len(rows)
    assert largest_step_m(model, rows[checked[:count]]) <= LARGEST_STEP_M[model]
    assert (int(checked[0]), int(checked[count - 1])) == (0, len(rows) - 1)


@pytest.mark.parametrize("model", MODELS)
def test_the_compiled_check_of_an_edge_finds_a_pea_anywhere_on_the_path_of_the_outermost_body(model: str) -> None:
    """Nothing that this body would hit is passed between two checks."""
    start, end = swing(model)
    oracle = MotionOracle(alone(model), ARM)
    for share in np.linspace(0.05, 0.95, 31):
        at = oracle.outermost(start + share * (end - start))
        pea = Obstacle.of("pea", Sphere(radius_m=0.005), Pose(xyz=(float(at[0]), float(at[1]), float(at[2]))))
        problem, _ = compile_problem(alone(model).with_obstacles(pea), ARM)
        path = np.ascontiguousarray(np.vstack((start, end)))
        assert blocked_at(problem, path) >= 0, share
