"""Spheres hold the whole of what they stand for, reach little beyond, and are kept on disk."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.messages.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere
from robots.model.transform import RigidTransform
from robots.planning.scene.convex_shapes import convex_solid, to_frame
from robots.planning.search.sphere_fit import LinkSolid, covering_spheres

sizes = st.floats(0.01, 0.4)


@st.composite
def shapes(draw: st.DrawFn) -> Shape:
    """Return a shape of any kind."""
    x, y, z = draw(sizes), draw(sizes), draw(sizes)
    random = np.random.default_rng(draw(st.integers(0, 1000)))
    points: list[list[float]] = random.uniform(-0.2, 0.2, (12, 3)).tolist()
    every: tuple[Shape, ...] = (
        Box(size_m=(x, y, z)),
        Cylinder(radius_m=x, length_m=y),
        Sphere(radius_m=x),
        Capsule(radius_m=x, length_m=y),
        Hull(points_m=tuple((a, b, c) for a, b, c in points)),
    )
    return draw(st.sampled_from(every))


@st.composite
def places(draw: st.DrawFn) -> RigidTransform:
    """Return a pose nearby."""
    xyz = [draw(st.floats(-0.2, 0.2)) for _ in range(3)]
    return RigidTransform.of(xyz, [draw(st.floats(0.1, 1.0)) for _ in range(4)])


@pytest.fixture(autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path_factory.mktemp("cache")
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder))
    return folder


@settings(deadline=None, max_examples=12)
@given(shape=shapes(), pose=places())
def test_every_point_of_a_solid_is_in_a_sphere_and_no_sphere_reaches_far_beyond(
    shape: Shape, pose: RigidTransform
) -> None:
    spheres = covering_spheres([LinkSolid(shape=shape, pose=pose)])
    solid = convex_solid(shape)
    points = to_frame(pose, solid.surface(0.01))
    away = np.linalg.norm(points[:, None] - spheres[None, :, :3], axis=2) - spheres[:, 3]
    assert away.min(axis=1).max() <= 1e-9
    depth = solid.depth(to_frame(pose.inverse(), spheres[:, :3]))
    assert (spheres[:, 3] - np.maximum(depth, 0.0)).max() <= 0.07 + 1e-9


@given(shape=shapes())
@settings(deadline=None, max_examples=25)
def test_the_surface_is_where_the_depth_is_zero(shape: Shape) -> None:
    solid = convex_solid(shape)
    assert np.abs(solid.depth(solid.surface(0.02))).max() < 1e-6
    assert float(solid.depth(solid.centre[None])[0]) > 0.0
    low, high = solid.box()
    points = solid.surface(0.02)
    assert (points >= low - 1e-6).all()
    assert (points <= high + 1e-6).all()
    assert np.linalg.norm(points - solid.centre, axis=1).max() <= solid.radius_m + 1e-6


def test_spheres_are_kept_and_a_damaged_file_is_made_again(cache: Path) -> None:
    solids = [LinkSolid(shape=Box(size_m=(0.1, 0.2, 0.3)), pose=RigidTransform.of((0, 0, 0), (0, 0, 0, 1)))]
    first = covering_spheres(solids)
    (file,) = (cache / "flexcell" / "spheres").iterdir()
    changed = file.stat().st_mtime_ns
    assert np.array_equal(covering_spheres(solids), first)
    assert file.stat().st_mtime_ns == changed
    file.write_bytes(b"nonsense")
    assert np.array_equal(covering_spheres(solids), first)
