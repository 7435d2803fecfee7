"""What an arm feels: a known push is measured, its own tool and load are not, and a hidden weight is.

With an ideal plant: friction, noise and the offset of the sensor are in `test_arm_loop_realism`.
"""

from __future__ import annotations

import numpy as np
import pytest

from engine.messages import Vector3
from engine.skills.arm_control import ControlSettings
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import ABOVE_PART, one_arm
from tests.robots.sim.stepped import SteppedArm

CONTROLLERS = pytest.mark.parametrize(
    "settings", [ControlSettings(), ControlSettings(controller="cartesian_impedance")], ids=["joint", "cartesian"]
)


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(realistic(one_arm(), "ideal"))


@CONTROLLERS
@pytest.mark.parametrize("force", [(20.0, 0.0, 0.0), (0.0, -12.0, 0.0), (0.0, 0.0, -30.0), (0.8, 0.6, -0.4)])
def test_a_push_at_the_tool_is_measured(cell: CellModel, settings: ControlSettings, force: Vector3) -> None:
    """Within 1 % and 0.05 N at rest; the joints feel its torque, J^T F."""
    arm = SteppedArm(cell, settings)
    arm.push(force, 2.0)
    arm.run(1.5)
    sample = arm.sample
    assert sample.wrench[:3] == pytest.approx(force, rel=0.01, abs=0.05)
    assert sample.wrench[3:] == pytest.approx(np.zeros(3), abs=0.01)
    expected = arm.control.state.jacobian.T @ np.array([*force, 0.0, 0.0, 0.0])
    assert sample.external_nm == pytest.approx(expected, rel=0.01, abs=0.02)


def test_a_push_beside_the_tool_centre_point_is_measured_as_force_and_torque(cell: CellModel) -> None:
    """10 N along x, 0.1 m above the tool centre point (which points down), turn about y by 1 N m."""
    arm = SteppedArm(cell)
    arm.push((10.0, 0.0, 0.0), 2.0, at_m=(0.0, 0.0, -0.1))
    arm.run(1.5)
    assert arm.sample.wrench == pytest.approx([10.0, 0.0, 0.0, 0.0, 1.0, 0.0], abs=0.05)


def test_the_wrench_is_about_the_tool_centre_point_that_is_set(cell: CellModel) -> None:
    """A point 0.2 m farther down: the same push turns the other way round about it."""
    arm = SteppedArm(cell, ControlSettings(tool_xyz_m=(0.0, 0.0, 0.2)))
    arm.push((10.0, 0.0, 0.0), 2.0)
    arm.run(1.5)
    assert arm.sample.wrench == pytest.approx([10.0, 0.0, 0.0, 0.0, 2.0, 0.0], abs=0.05)


def test_a_push_at_the_forearm_is_felt_by_the_joints_and_not_by_the_tool(cell: CellModel) -> None:
    arm = SteppedArm(cell)
    arm.push((0.0, 20.0, 0.0), 2.0, body="left/panda_link4")
    arm.run(1.5)
    assert np.abs(arm.sample.wrench).max() < 1e-3
    assert np.abs(arm.sample.external_nm).max() > 3.0


@CONTROLLERS
def test_its_own_motion_is_no_external_force(cell: CellModel, settings: ControlSettings) -> None:
    """Weight and inertia of arm and tool are known: on a fast way nothing is felt."""
    arm = SteppedArm(cell, settings)
    arm.follow(ABOVE_PART, 1.0)
    most = 0.0

    def look() -> None:
        nonlocal most
        most = max(most, float(np.abs(arm.sample.external_nm).max()), float(np.abs(arm.sample.wrench).max()))

    arm.run(1.2, look=look)
    assert most < 0.01


def test_a_push_is_felt_within_ten_milliseconds_and_gone_as_soon_after_it(cell: CellModel) -> None:
    arm = SteppedArm(cell)
    arm.push((0.0, 0.0, -10.0), 0.1)
    arm.run(0.01)
    assert arm.sample.wrench[2] < -9.0
    arm.run(0.1)
    assert abs(arm.sample.wrench[2]) < 1.0
