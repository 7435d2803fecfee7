"""Rays meet a shape exactly where the physics says so, whatever the shape and wherever it stands."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.sim.physics.physics import mujoco
from robots.vision.detection.visibility import bounding_edges_m, intersects_shape

SIZES = st.floats(0.05, 0.5)
SHAPES = st.one_of(
    st.tuples(st.just("box"), st.tuples(SIZES, SIZES, SIZES)),
    st.tuples(st.just("cylinder"), st.tuples(SIZES, SIZES)),
    st.tuples(st.just("sphere"), st.tuples(SIZES)),
)
KINDS: dict[str, Any] = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
}


def met_by_physics(shape: str, size_m: tuple[float, ...], start: Any, along: Any) -> bool:
    """Ask MuJoCo about one ray."""
    size = np.zeros(3)
    size[: len(size_m)] = np.array(size_m) / 2.0
    return mujoco.mju_rayGeom(np.zeros(3), np.eye(3).ravel(), size, start, along, int(KINDS[shape]), None) >= 0.0


@given(shape=SHAPES, seed=st.integers(0, 2**32 - 1))
def test_rays_meet_what_they_meet_in_the_physics(shape: tuple[str, tuple[float, ...]], seed: int) -> None:
    kind, size_m = shape
    random = np.random.default_rng(seed)
    start = random.normal(size=3)
    start *= random.uniform(1.0, 2.0) / np.linalg.norm(start)
    along = random.normal(scale=0.25, size=(40, 3)) - start
    assert intersects_shape(kind, size_m, start, along).tolist() == [
        met_by_physics(kind, size_m, start, ray) for ray in along
    ]


@pytest.mark.parametrize(("shape", "size_m"), [("box", (0.2, 0.2, 0.2)), ("cylinder", (0.2, 0.2)), ("sphere", (0.2,))])
def test_rays_along_an_axis_meet_it_in_front_and_never_behind(shape: str, size_m: tuple[float, ...]) -> None:
    for axis in range(3):
        ray = np.eye(3)[axis]
        beside = np.roll(ray, 1) * 0.15
        assert intersects_shape(shape, size_m, -ray, ray[None]).tolist() == [True]
        assert intersects_shape(shape, size_m, ray, ray[None]).tolist() == [False]
        assert intersects_shape(shape, size_m, beside - ray, ray[None]).tolist() == [False]


def test_the_box_that_a_shape_fills_has_its_size() -> None:
    assert bounding_edges_m("box", (0.1, 0.2, 0.3)) == (0.1, 0.2, 0.3)
    assert bounding_edges_m("cylinder", (0.1, 0.3)) == (0.1, 0.1, 0.3)
    assert bounding_edges_m("sphere", (0.1,)) == (0.1, 0.1, 0.1)
