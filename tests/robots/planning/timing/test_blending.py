"""Corners of paths are replaced by curves with continuous acceleration."""

from __future__ import annotations

import numpy as np
import pytest

from robots.planning.timing.blending import BlendedPath, blend_corners

CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [2.0, 1.0]])


def require_consistent(path: BlendedPath) -> None:
    """Positions, first derivatives and lengths fit one another."""
    steps = np.diff(path.along)
    assert steps.min() > 0.0
    slopes = np.diff(path.position, axis=0) / steps[:, None]
    means = (path.first[1:] + path.first[:-1]) / 2.0
    assert np.abs(slopes - means).max() < 0.02
    bends = np.diff(path.first, axis=0) / steps[:, None]
    assert np.abs(bends - (path.second[1:] + path.second[:-1]) / 2.0).max() < 0.5 * max(1.0, np.abs(bends).max())


@pytest.mark.parametrize("cut", [0.05, 0.3, 0.5])
def test_the_curve_keeps_its_length_along_the_lines_and_deviates_by_three_sixteenths_of_the_cut(cut: float) -> None:
    """With half a line as cut nothing is left of the line in the middle."""
    path = blend_corners(CORNERS, np.array([0.0, cut, cut, 0.0]))
    require_consistent(path)
    assert path.along[-1] == pytest.approx(3.0)
    assert path.position[0].tolist() == [0.0, 0.0]
    assert path.position[-1] == pytest.approx([2.0, 1.0])
    nearest = np.linalg.norm(path.position - CORNERS[1], axis=1).min()
    assert nearest == pytest.approx(3.0 / 16.0 * cut * np.sqrt(2.0), rel=0.02)


def test_a_line_that_two_blends_use_up_has_no_points_of_its_own() -> None:
    path = blend_corners(CORNERS, np.array([0.0, 0.5, 0.5, 0.0]))
    shorter = blend_corners(CORNERS, np.array([0.0, 0.4, 0.4, 0.0]))
    assert len(path.along) < len(shorter.along)
    inside = (path.along > 0.5) & (path.along < 2.5)
    assert np.count_nonzero(np.abs(path.second[inside]).max(axis=1) < 1e-9) <= 2
