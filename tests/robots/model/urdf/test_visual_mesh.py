"""Visual meshes: thinned, in place, the same from the cache, rebuilt when the cache is damaged or absent."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from engine.errors import CellError
from robots.model.mechanics.collision_model import CollisionModel
from robots.model.registry import model_by_name, robot_model
from robots.model.robot_model import RobotModel
from robots.model.urdf.mesh_cache import read_cached, write_cached
from robots.model.urdf.visual_mesh import link_visuals


@pytest.fixture(name="hand_only")
def _hand_only() -> RobotModel:
    """Return a robot that is a Panda's hand and one finger, to keep the conversion short."""
    panda = model_by_name("panda")
    uri = "package://example-robot-data/robots/panda_description/meshes/visual"
    links = "".join(
        f'<link name="{name}"><visual><origin xyz="0 0 0.1" rpy="0 0 0"/>'
        f'<geometry><mesh filename="{uri}/{name}.dae"/></geometry></visual></link>'
        for name in ("hand", "finger")
    )
    return replace(panda, urdf_text=f'<robot name="hand">{links}</robot>')


def test_meshes_are_thinned_split_by_colour_and_in_metres(hand_only: RobotModel, tmp_path: Path) -> None:
    visuals = link_visuals(hand_only, cache=tmp_path / "cache")
    hand = [visual for visual in visuals if visual.link == "hand"]
    points = np.concatenate([np.frombuffer(v.mesh.vertices, np.float32).reshape(-1, 3) for v in hand])
    assert np.ptp(points, axis=0) == pytest.approx([0.064, 0.205, 0.094], abs=0.003)
    assert 200 < sum(len(visual.mesh.faces) // 12 for visual in hand) < 2000
    assert len({visual.mesh.rgba for visual in hand}) == len(hand) > 1
    assert hand[0].xyz == (0.0, 0.0, 0.1)
    for visual in visuals:
        assert np.frombuffer(visual.mesh.faces, np.uint32).max() < len(visual.mesh.vertices) // 12


def test_the_cache_gives_the_same_and_a_damaged_one_is_made_again(hand_only: RobotModel, tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    fresh = link_visuals(hand_only, cache=cache)
    files = sorted(cache.iterdir())
    assert len(files) == 2
    assert link_visuals(hand_only, cache=cache) == fresh
    kept = files[0].read_bytes()
    files[0].write_bytes(kept[:-10] + b"0123456789")
    assert link_visuals(hand_only, cache=cache) == fresh
    assert files[0].read_bytes() == kept


def test_without_a_writable_cache_it_works_all_the_same(hand_only: RobotModel, tmp_path: Path) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.write_text("not a folder")
    assert link_visuals(hand_only, cache=in_the_way / "cache")


def test_a_mesh_that_cannot_be_read_is_named(hand_only: RobotModel, tmp_path: Path) -> None:
    (tmp_path / "bad.dae").write_text("this is no mesh")
    visual = '<visual><geometry><mesh filename="package://bad.dae"/></geometry></visual>'
    bad = replace(
        hand_only, urdf_text=f'<robot name="b"><link name="a">{visual}</link></robot>', package_dirs=(tmp_path,)
    )
    with pytest.raises(CellError, match=r"bad\.dae: the mesh cannot be read"):
        link_visuals(bad, cache=tmp_path / "cache")


def _primitives(model: RobotModel, *, rgba: str) -> RobotModel:
    """Return a robot that is one link with a box, a cylinder and a sphere."""
    shapes = ('<box size="0.1 0.2 0.3"/>', '<cylinder radius="0.05" length="0.4"/>', '<sphere radius="0.07"/>')
    visuals = "".join(
        f'<visual><geometry>{shape}</geometry><material name="m"><color rgba="{rgba}"/></material></visual>'
        for shape in shapes
    )
    return replace(model, urdf_text=f'<robot name="p"><link name="a">{visuals}</link></robot>')


def test_primitives_become_meshes_in_the_colour_of_their_material(hand_only: RobotModel, tmp_path: Path) -> None:
    drawn = link_visuals(_primitives(hand_only, rgba="0.1 0.2 0.3 1"), cache=tmp_path / "cache")
    sizes = [np.ptp(np.frombuffer(v.mesh.vertices, np.float32).reshape(-1, 3), axis=0) for v in drawn]
    assert np.allclose(sizes, [(0.1, 0.2, 0.3), (0.1, 0.1, 0.4), (0.14, 0.14, 0.14)], atol=0.003)
    assert {visual.mesh.rgba for visual in drawn} == {(0.1, 0.2, 0.3, 1.0)}


def test_primitives_come_from_the_cache_without_what_makes_them(
    hand_only: RobotModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its import takes more than a second; the colour is that of the material now."""
    fresh = link_visuals(_primitives(hand_only, rgba="0.1 0.2 0.3 1"), cache=tmp_path / "cache")
    monkeypatch.setitem(sys.modules, "trimesh", None)
    again = link_visuals(_primitives(hand_only, rgba="1 1 1 1"), cache=tmp_path / "cache")
    assert [each.mesh.vertices for each in again] == [each.mesh.vertices for each in fresh]
    assert [each.mesh.faces for each in again] == [each.mesh.faces for each in fresh]
    assert {each.mesh.rgba for each in again} == {(1.0, 1.0, 1.0, 1.0)}


def test_what_is_drawn_of_an_arm_and_its_tool_lies_where_it_collides() -> None:
    """Mesh files of every kind, scaled and placed: Collada, STL and OBJ of the UR10 with a 2F-85."""
    model = robot_model("ur10", gripper="robotiq_2f85")
    collision = CollisionModel(model)
    drawn: dict[str, list[NDArray[np.float64]]] = {}
    for visual in link_visuals(model):
        points = np.frombuffer(visual.mesh.vertices, np.float32).reshape(-1, 3)
        drawn.setdefault(visual.link, []).append(Rotation.from_quat(visual.xyzw).apply(points) + visual.xyz)
    for link, hull in collision.hulls():
        points = np.concatenate(drawn[link])
        off = np.concatenate((points.min(axis=0) - hull.min(axis=0), points.max(axis=0) - hull.max(axis=0)))
        assert np.abs(off).max() < 0.01, link


def test_what_was_written_is_read_and_nothing_half_written_stays(tmp_path: Path) -> None:
    assert read_cached(tmp_path, "key") is None
    write_cached(tmp_path, "key", b"payload")
    assert read_cached(tmp_path, "key") == b"payload"
    assert [file.name for file in tmp_path.iterdir()] == ["key"]
