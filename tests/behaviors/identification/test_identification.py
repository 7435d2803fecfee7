"""The shipped behaviors that weigh a part and measure friction, with arms that differ from their models."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest

from engine.event import Event, UserdataWritten
from robots.scene.scene_builder import build_scene
from robots.sim.physics.cell_model import build_cell
from tests.behaviors.application import Application, changed_cell, shipped_cell
from tests.tiers import nightly

SEEDS = pytest.mark.parametrize("seed", [3, nightly(1), nightly(2)])


def written(log: list[Event], key: str) -> Any:
    """Return what a state has written under a key."""
    (value,) = (event.value for event in log if isinstance(event, UserdataWritten) and event.key == key)
    return msgspec.to_builtins(value)


@SEEDS
@pytest.mark.parametrize("nominal_kg", [0.4, 1.2])
def test_a_part_of_unknown_weight_is_weighed_and_carried(tmp_path: Path, nominal_kg: float, seed: int) -> None:
    """The behavior knows neither mass nor centre; the truth is what the simulator drew around the nominal mass."""
    cell = changed_cell(
        "dual_panda", tmp_path, cell=lambda text: text.replace("mass_kg: 0.12", f"mass_kg: {nominal_kg}", 1)
    )
    true_kg = float(build_cell(build_scene(cell.document, seed=seed)).model.body("hca_north").mass[0])
    assert true_kg != nominal_kg
    done = Application(behavior="identification/identify_payload.yaml", cell=cell, seed=seed)
    assert done.run(tmp_path).outcome == "finished"
    mass_kg, spread_kg = written(done.log, "part_kg"), written(done.log, "spread_kg")
    assert abs(mass_kg - true_kg) < 0.03
    assert abs(mass_kg - true_kg) < spread_kg < 0.1
    # The part is held between the pads: 20 mm up or down and 15 mm beside the tool centre point at most.
    x, y, z = written(done.log, "part_com_m")
    assert max(abs(x), abs(y)) < 0.02
    assert abs(z) < 0.025


@SEEDS
def test_the_friction_of_every_joint_is_measured(tmp_path: Path, seed: int) -> None:
    cell = shipped_cell("dual_panda")
    arm = (built := build_cell(build_scene(cell.document, seed=seed))).arms[0]
    done = Application(behavior="identification/identify_friction.yaml", cell=cell, seed=seed)
    assert done.run(tmp_path).outcome == "finished"
    friction = written(done.log, "friction")
    assert [joint["joint"] for joint in friction] == list(arm.model.arm_joints)
    for dof, joint in zip(arm.dof, friction, strict=True):
        assert joint["coulomb_nm"] == pytest.approx(float(built.model.dof_frictionloss[dof]), rel=0.15)
