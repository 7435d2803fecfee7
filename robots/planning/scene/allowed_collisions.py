"""Which pairs of names may touch, for many names at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robots.planning.scene.planning_scene import PlanningScene


def allowed_collision_matrix(scene: PlanningScene, rows: Sequence[str], columns: Sequence[str]) -> NDArray[np.bool_]:
    """Return for each of `rows` and each of `columns` whether they may touch, as `PlanningScene.may_touch` says."""
    found = np.zeros((len(rows), len(columns)), dtype=np.bool_)
    for first, second in scene.allowed:
        found |= np.outer(_meant(first, rows), _meant(second, columns))
        found |= np.outer(_meant(second, rows), _meant(first, columns))
    return found


def _meant(rule: str, names: Sequence[str]) -> NDArray[np.bool_]:
    within = rule + "/"
    return np.array([name == rule or name.startswith(within) for name in names], dtype=np.bool_)
