"""Closed-form solutions by EAIK: six-axis arms whose axes meet or are parallel, seven-axis arms with one joint locked.

EAIK (Ostermeier, Külz, Althoff: "Automatic geometric decomposition for analytical inverse kinematics",
IEEE RA-L 2025) determines from the geometry whether it can solve an arm.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from robots.model.inverse_kinematics.chain import KinematicChain
from robots.model.inverse_kinematics.ideal_arm import IdealArm, ideal_arm
from robots.port import Array

_AXES = 6
# An ideal arm displaced less than this from the true one has all of its solutions.
_EXACT = 1e-8


@dataclass(frozen=True, kw_only=True)
class AnalyticSolver:
    """The closed form of one arm; `locked` is the joint with a fixed value, -1 for six-axis arms.

    `exact` is False if the solutions are those of an ideal arm close to the true one.
    """

    ideal: IdealArm
    tool: Array
    locked: int
    family: str
    exact: bool
    solver: Any

    def candidates(self, goal: Array) -> Array:
        """Return solutions (k, 6) for a goal (3, 4) in the world, with any turns, approximate ones included."""
        return _solved(self.solver, goal, _AXES)

    def candidates_with(self, goal: Array, value: float) -> Array:
        """Return solutions (k, 7) with the locked joint at `value`."""
        return _solved(_solver(self.ideal, self.tool, ((self.locked, value),)), goal, _AXES + 1)


def new_analytic_solver(chain: KinematicChain) -> AnalyticSolver | None:
    """Return the closed form of an arm, None if EAIK has none or is not installed."""
    # EAIK has wheels for Linux only; elsewhere these arms use the general solver.
    if chain.sliding.any() or chain.dof not in (_AXES, _AXES + 1) or find_spec("eaik") is None:
        return None
    ideal = ideal_arm(chain)
    # For a seven-axis arm the last joint that leaves a solvable remainder is locked: it affects the others least.
    joints = [-1] if chain.dof == _AXES else range(_AXES, -1, -1)
    for locked in joints:
        solver = _solver(ideal, chain.tool, () if locked < 0 else ((locked, 0.0),))
        if solver is not None and solver.has_known_decomposition():
            family = str(solver.get_kinematic_family())
            exact = ideal.moved < _EXACT
            return AnalyticSolver(
                ideal=ideal, tool=chain.tool, locked=locked, family=family, exact=exact, solver=solver
            )
    return None


def _solver(ideal: IdealArm, tool: Array, locked: tuple[tuple[int, float], ...]) -> Any:
    # The compiled part only: the package's Python classes read URDFs with a library that is not needed here.
    eaik: Any = import_module("eaik.pybindings.EAIK")
    offsets = np.vstack((ideal.points[0], np.diff(ideal.points, axis=0), tool[:, 3] - ideal.points[-1]))
    try:
        return eaik.Robot(ideal.axes.T, offsets.T, tool[:, :3], list(locked), True)
    except RuntimeError:
        # EAIK raises this for a geometry that it cannot decompose, for example axes that almost intersect.
        return None


def _solved(solver: Any, goal: Array, joints: int) -> Array:
    if solver is None:
        return np.empty((0, joints))
    pose = np.eye(4)
    pose[:3] = goal
    found = np.array(solver.calculate_IK(pose).Q, dtype=np.float64).reshape(-1, joints)
    return found[np.isfinite(found).all(axis=1)]
