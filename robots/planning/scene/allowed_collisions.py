"""The allowed collision matrix of many names at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robots.planning.scene.planning_scene import PlanningScene


def allowed_collision_matrix(scene: PlanningScene, rows: Sequence[str], columns: Sequence[str]) -> NDArray[np.bool_]:
    """Return for each of `rows` and `columns` whether they may touch, as `PlanningScene.may_touch` defines."""
    matrix = np.zeros((len(rows), len(columns)), dtype=np.bool_)
    for first, second in scene.allowed:
        matrix |= np.outer(_matches(first, rows), _matches(second, columns))
        matrix |= np.outer(_matches(second, rows), _matches(first, columns))
    return matrix


def _matches(rule: str, names: Sequence[str]) -> NDArray[np.bool_]:
    within = rule + "/"
    return np.array([name == rule or name.startswith(within) for name in names], dtype=np.bool_)
