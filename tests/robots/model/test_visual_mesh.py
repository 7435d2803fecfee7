"""Visual meshes: thinned, in place, the same from the cache, rebuilt when the cache is damaged or absent."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from engine.errors import CellError
from robots.model.mesh_cache import read_cached, write_cached
from robots.model.registry import model_by_name
from robots.model.robot_model import RobotModel
from robots.model.visual_mesh import link_visuals


@pytest.fixture(name="hand_only")
def _hand_only(tmp_path: Path) -> RobotModel:
    """Return a robot that is a Panda's hand and one finger, to keep the conversion short."""
    panda = model_by_name("panda")
    uri = "package://example-robot-data/robots/panda_description/meshes/visual"
    links = "".join(
        f'<link name="{name}"><visual><origin xyz="0 0 0.1" rpy="0 0 0"/>'
        f'<geometry><mesh filename="{uri}/{name}.dae"/></geometry></visual></link>'
        for name in ("hand", "finger")
    )
    urdf = tmp_path / "hand.urdf"
    urdf.write_text(f'<robot name="hand">{links}</robot>')
    return replace(panda, urdf=urdf)


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
    urdf = tmp_path / "bad.urdf"
    urdf.write_text(
        '<robot name="b"><link name="a"><visual><geometry><mesh filename="bad.dae"/></geometry></visual></link></robot>'
    )
    with pytest.raises(CellError, match=r"bad\.dae: the mesh cannot be read"):
        link_visuals(replace(hand_only, urdf=urdf), cache=tmp_path / "cache")


def test_what_was_written_is_read_and_nothing_half_written_stays(tmp_path: Path) -> None:
    assert read_cached(tmp_path, "key") is None
    write_cached(tmp_path, "key", b"payload")
    assert read_cached(tmp_path, "key") == b"payload"
    assert [file.name for file in tmp_path.iterdir()] == ["key"]
