"""Two compiled worlds have one fingerprint only if they have one future."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

from robots.scene.sim_scene import SimScene
from robots.sim.physics.arm_spec import arm_spec
from robots.sim.physics.cell_model import build_cell
from robots.sim.physics.fingerprint import fingerprint
from tests.robots.sim.sim_cell import PANDA, box, one_arm, two_arms

SCENE = one_arm(box("part"))


def fingerprint_of(scene: SimScene) -> str:
    """Return the fingerprint of a scene."""
    return fingerprint(build_cell(scene).model)


def test_equal_scenes_have_equal_fingerprints() -> None:
    assert fingerprint_of(SCENE) == fingerprint_of(SCENE)


@pytest.mark.parametrize(
    "other",
    [
        one_arm(box("other")),
        one_arm(box("part", mass_kg=0.1201)),
        two_arms(box("part")),
        msgspec.structs.replace(SCENE, step_s=0.0005),
        msgspec.structs.replace(SCENE, gravity=False),
        msgspec.structs.replace(SCENE, fixtures=()),
    ],
    ids=["name", "mass", "arms", "step", "gravity", "fixtures"],
)
def test_whatever_changes_the_future_changes_the_fingerprint(other: SimScene) -> None:
    assert fingerprint_of(other) != fingerprint_of(SCENE)


def test_a_moved_installation_has_the_same_worlds(tmp_path: Path) -> None:
    """The meshes are the same, only found elsewhere."""
    moved = tmp_path / "a-much-longer-way-to-the-descriptions"
    moved.symlink_to(PANDA.package_dirs[0])
    here, there = arm_spec(PANDA).compile(), arm_spec(replace(PANDA, package_dirs=(moved,))).compile()
    assert here.paths != there.paths
    assert fingerprint(here) == fingerprint(there)
