"""The legs of a hexapod are drawn between both plates, wherever the platform is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from engine.document.cell import load_cell
from engine.document.placement import Placement
from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.scene.scene_builder import build_scene
from robots.scene.sim_scene import SimScene
from robots.sim.physics.hexapod_drawing import leg_frames, leg_geometries

CELL = Path(__file__).parents[4] / "behaviors" / "cells" / "hexapods.yaml"


@pytest.fixture(scope="module", name="scene")
def _scene() -> SimScene:
    return build_scene(load_cell(CELL).document)


def test_each_half_of_a_leg_has_a_frame(scene: SimScene) -> None:
    at = {fixture.name: fixture.pose for fixture in scene.fixtures}
    frames = leg_frames(scene, at)
    assert len(frames) == 2 * 2 * 6
    assert {geometry.frame for geometry in leg_geometries(scene)} == set(frames)


def test_tube_and_rod_point_at_each_other_and_overlap(scene: SimScene) -> None:
    at = {fixture.name: fixture.pose for fixture in scene.fixtures}
    tilted = Placement(xyz=(0.62, 0.35, 0.2), rpy=(0.1, 0.15, 0.2)).pose()
    frames = leg_frames(scene, {**at, "north_jig/platform": tilted})
    drawn = {geometry.frame: geometry.size_m[1] for geometry in leg_geometries(scene)}
    platform = next(fixture for fixture in scene.fixtures if fixture.name == "north_jig/platform")
    assert platform.hexapod is not None
    for number, joint in enumerate(platform.hexapod.joints, start=1):
        tube, rod = (frames[f"north_jig/platform~{half}_{number}"] for half in ("tube", "rod"))
        head = RigidTransform.from_pose(tilted).then(RigidTransform.from_pose(Pose(xyz=joint)))
        assert rod.xyz == pytest.approx(tuple(head.xyz))
        length = float(np.linalg.norm(np.array(rod.xyz) - np.array(tube.xyz)))
        along = RigidTransform.from_pose(tube).rotation[:, 2]
        assert np.array(tube.xyz) + length * along == pytest.approx(np.array(rod.xyz), abs=1e-9)
        assert RigidTransform.from_pose(rod).rotation[:, 2] == pytest.approx(-along, abs=1e-9)
        assert sum(drawn[f"north_jig/platform~{half}_{number}"] for half in ("tube", "rod")) > length
