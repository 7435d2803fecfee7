"""What a world sums up while it runs: paths that are known, a known push, grips, slips, and contacts that are none."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

from engine.skills.arm_control import ControlSettings
from robots.port import Array
from robots.sim.commands.world_commands import MoveTool, RestoreWorld
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.measures.measure_layout import MeasureLayout
from robots.sim.measures.run_measures import RunMeasures
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import ABOVE_PART, AT_PART, HOME, LEFT, box, one_arm
from tests.robots.sim.stepped import SteppedArm

PART = "part"
FIRST_JOINT = np.eye(7)[0]
CLOSE, OPEN = (0.0, 0.1, 20.0), (0.08, 0.1, 20.0)
"""Opening, speed and force of a tool's motion."""


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(one_arm(box(PART)))


@pytest.fixture(scope="module", name="ideal")
def _ideal() -> CellModel:
    """Where a path, a speed and a force of nothing are exact."""
    return build_cell(realistic(one_arm(box(PART)), "ideal"))


@pytest.fixture(scope="module", name="reached")
def _reached(cell: CellModel) -> Array:
    """The image of a world whose open fingers are around the part, at rest."""
    arm = SteppedArm(cell)
    arm.apply(MoveTool(arm="left", motion=9, goal=OPEN))
    arm.follow(ABOVE_PART, 1.2)
    arm.until_finished()
    arm.follow(AT_PART, 0.8, motion=2)
    arm.until_finished(2)
    image = np.zeros(arm.simulation.image_layout.size)
    arm.simulation.write_image(image)
    return image


def measures(arm: SteppedArm) -> dict[str, float]:
    """Return what its world has summed up."""
    kept = arm.simulation.measures
    return kept.layout.read(kept.values())


def at_the_part(cell: CellModel, reached: Array) -> SteppedArm:
    """Return an arm whose open fingers are around the part, with everything summed up from now on."""
    arm = SteppedArm(cell)
    arm.apply(RestoreWorld(image=reached))
    return arm


def close(arm: SteppedArm) -> None:
    """Close the fingers."""
    arm.apply(MoveTool(arm="left", motion=10, goal=CLOSE))
    arm.until_finished(10)


def in_the_hand(arm: SteppedArm) -> Array:
    """Return where the part is in the frame of the tool."""
    values = arm.simulation.layout.new_array()
    arm.simulation.write_snapshot(values)
    xyz, _ = SimSnapshot(arm.simulation.layout, values).frames()
    part = np.array(xyz[arm.simulation.summary.frames.index(PART)])
    return arm.control.state.tool.rotation.T @ (part - arm.tool_xyz)


def test_a_turn_of_the_first_joint_moves_the_tool_along_its_arc(ideal: CellModel) -> None:
    """Its length is radius times angle, its speed that of the set point; nothing is gripped and nothing touched."""
    arm = SteppedArm(ideal)
    radius_m = float(np.hypot(*(arm.tool_xyz - [-0.55, 0.0, 0.0])[:2]))
    arm.follow(HOME + 0.5 * FIRST_JOINT, 1.0)
    arm.until_finished()
    found = measures(arm)
    assert found["left.path_m"] == pytest.approx(0.5 * radius_m, rel=2e-3)
    assert found["left.joint_path_rad"] == pytest.approx(0.5, rel=0.02)
    # A minimum-jerk motion is 15/8 as fast as its mean in the middle.
    assert found["left.speed_max_m_s"] == pytest.approx(1.875 * 0.5 * radius_m, rel=0.01)
    assert 1e-6 < found["left.tracking_error_max_rad"] < 0.005
    assert found["left.force_max_n"] < 0.01
    assert {name: value for name, value in found.items() if not name.startswith("left.")} == {
        "cell.contacts": 0.0,
        "cell.contact_s": 0.0,
        "cell.contact_force_max_n": 0.0,
        "cell.clearance_min_m": found["left.clearance_min_m"],
    }
    assert not any(name.startswith("left.gripper") for name in found)


def test_another_tool_centre_point_is_no_path(ideal: CellModel) -> None:
    """It is a change of the settings, not a movement."""
    arm = SteppedArm(ideal)
    arm.run(0.1)
    arm.configure(ControlSettings(tool_xyz_m=(0.0, 0.0, 0.2)))
    arm.run(0.1)
    assert measures(arm)["left.path_m"] < 1e-6


def test_a_known_push_at_the_tool_is_its_largest_force(cell: CellModel) -> None:
    """Also when it has ended long ago; a push beside the tool centre point is a torque too."""
    arm = SteppedArm(cell)
    arm.push((0.0, 0.0, -25.0), 0.5)
    arm.run(0.5)
    arm.push((10.0, 0.0, 0.0), 0.3, at_m=(0.0, 0.0, -0.1))
    arm.run(1.0)
    found = measures(arm)
    assert found["left.force_max_n"] == pytest.approx(25.0, rel=0.03)
    assert found["left.torque_max_nm"] == pytest.approx(1.0, rel=0.05)


def test_a_grasp_is_no_contact_and_has_its_force(cell: CellModel, reached: Array) -> None:
    """From the first touch of the fingers on; the part is held with 20 N and does not slip."""
    arm = at_the_part(cell, reached)
    close(arm)
    arm.follow(ABOVE_PART, 0.8)
    arm.until_finished()
    found = measures(arm)
    assert found["cell.contacts"] == 0.0
    assert found["left.gripper.force_min_n"] == pytest.approx(20.0, abs=1.0)
    assert found["left.gripper.force_max_n"] == pytest.approx(20.0, abs=2.0)
    assert found["left.gripper.slip_max_m"] < 0.002


def test_a_held_part_that_is_pushed_slips(cell: CellModel, reached: Array) -> None:
    """By as much as it moves in the hand."""
    arm = at_the_part(cell, reached)
    close(arm)
    arm.run(0.1)
    before = in_the_hand(arm)
    arm.push((60.0, 0.0, 0.0), 0.01, body=PART)
    arm.run(0.3)
    slip_m = float(np.linalg.norm(in_the_hand(arm) - before))
    assert slip_m > 0.01
    assert measures(arm)["left.gripper.slip_max_m"] == pytest.approx(slip_m, rel=0.01)


def test_open_fingers_that_push_a_part_are_a_contact(cell: CellModel, reached: Array) -> None:
    """One, which lasts while they push; the impact at its start is harder than what the arm feels of it."""
    arm = at_the_part(cell, reached)
    arm.run(0.1)
    assert measures(arm)["cell.contacts"] == 0.0
    arm.follow(AT_PART + 0.15 * FIRST_JOINT, 1.0)
    arm.until_finished()
    found = measures(arm)
    assert found["cell.contacts"] == 1.0
    assert 0.1 < found["cell.contact_s"] < 1.5
    assert found["cell.contact_force_max_n"] > 0.5
    assert 0.5 < found["left.force_max_n"] < found["cell.contact_force_max_n"]


def test_a_bare_flange_that_pushes_a_part_is_a_contact() -> None:
    """It has no fingers that could take the part."""
    bare = replace(one_arm(), arms=(replace(LEFT, gripper=None),), gravity=False)
    empty = Simulation(build_cell(bare))
    values = empty.layout.new_array()
    empty.write_snapshot(values)
    x, y, z = SimSnapshot(empty.layout, values).frame(f"left/{LEFT.robot().flange_link}")[0].tolist()
    arm = SteppedArm(build_cell(replace(bare, parts=(box(PART, (x, y, z - 0.06)),))))
    arm.run(0.1)
    assert measures(arm)["cell.contacts"] == 1.0


def test_measures_begin_again_in_a_restored_world(cell: CellModel, reached: Array) -> None:
    """The jump to the restored state is no path."""
    arm = SteppedArm(cell)
    arm.follow(ABOVE_PART, 1.0)
    arm.run(0.5)
    assert measures(arm)["left.path_m"] > 0.05
    arm.apply(RestoreWorld(image=reached))
    arm.run(0.1)
    assert measures(arm)["left.path_m"] < 1e-3


def test_measures_change_no_bit_of_the_world(cell: CellModel, reached: Array, monkeypatch: pytest.MonkeyPatch) -> None:
    """A world that sums up nothing has the same state after the same steps."""
    hashes: list[str] = []
    for _ in range(2):
        arm = at_the_part(cell, reached)
        arm.apply(MoveTool(arm="left", motion=10, goal=CLOSE))
        arm.run(0.5)
        hashes.append(arm.simulation.state_hash())
        monkeypatch.setattr(RunMeasures, "step", _nothing)
    assert hashes[0] == hashes[1]


def _nothing(_measures: RunMeasures, _step: int) -> None:
    """Sum up nothing."""


def test_values_do_not_depend_on_when_they_are_read(cell: CellModel) -> None:
    """A sum that is read in the middle of a block goes on from there."""
    found: list[dict[str, float]] = []
    for reads in (False, True):
        arm = SteppedArm(cell)
        arm.follow(ABOVE_PART, 1.0)
        arm.run(0.333)
        if reads:
            measures(arm)
        arm.run(0.4)
        found.append(measures(arm))
    assert found[0] == pytest.approx(found[1], rel=1e-12)


def test_what_a_world_has_nothing_of_is_absent() -> None:
    """The grip force of a tool that held nothing is no number; a bare flange has no grip at all; nothing is near."""
    layout = MeasureLayout({"left": "gripper", "right": None})
    found = layout.read(layout.new_values())
    assert set(found) == {
        "cell.contacts",
        "cell.contact_s",
        "cell.contact_force_max_n",
        *(
            f"{arm}.{name}"
            for arm in ("left", "right")
            for name in (
                "path_m",
                "joint_path_rad",
                "speed_max_m_s",
                "tracking_error_max_rad",
                "force_max_n",
                "torque_max_nm",
                "set_point_jumps",
            )
        ),
    }
    assert {each.name for each in layout.measures} - set(found) == {
        "left.gripper.force_max_n",
        "left.gripper.force_min_n",
        "left.gripper.slip_max_m",
        "left.clearance_min_m",
        "right.clearance_min_m",
        "cell.clearance_min_m",
    }
