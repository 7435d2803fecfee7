"""The meshes of shapes that viser does not have."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from editor_web.cell_view.rendering.convex_shapes import capsule, hull

lengths = st.floats(0.01, 2.0)


def volume_m3(vertices: NDArray[np.float32], faces: NDArray[np.uint32]) -> float:
    """Of a closed surface whose faces are turned outwards."""
    a, b, c = (vertices[faces[:, corner]].astype(float) for corner in range(3))
    return float((np.cross(a, b) * c).sum() / 6)


@given(lengths, lengths)
def test_a_capsule_is_closed_turned_outwards_and_of_its_size(radius_m: float, length_m: float) -> None:
    vertices, faces = capsule(radius_m, length_m)
    beyond = np.maximum(np.abs(vertices[:, 2]) - length_m / 2, 0.0)
    assert np.allclose(np.hypot(np.hypot(vertices[:, 0], vertices[:, 1]), beyond), radius_m, rtol=1e-3)
    exact = np.pi * radius_m**2 * (length_m + 4 / 3 * radius_m)
    assert 0.94 < volume_m3(vertices, faces) / exact < 1.0


def test_a_hull_leaves_out_what_lies_inside() -> None:
    vertices, faces = hull(((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0.1, 0.1, 0.1)))
    assert len(faces) == 4
    assert sorted(set(faces.flat)) == [0, 1, 2, 3]
    assert len(vertices) == 5


@pytest.mark.parametrize("points", [((0.0, 0.0, 0.0),) * 4, ((0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)), ()])
def test_points_in_one_plane_are_no_body(points: tuple[tuple[float, float, float], ...]) -> None:
    with pytest.raises(ValueError, match="in one plane"):
        hull(points)
