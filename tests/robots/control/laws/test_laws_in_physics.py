"""The control laws in physics: stiff as set, well damped, on the path, and no bump when one takes over from another.

The laws are judged by an ideal plant: what they assert is exact without friction, noise and delay. What a realistic
plant makes of them is in `tests/robots/sim/loop`.
"""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

from engine.skills.arm_control import ControlSettings
from robots.control.commanding.arm_commands import FinishStream, FollowTrajectory, StartGuiding
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.motion import plan_line
from robots.port import MotionEnd, Tolerance
from robots.scene.sim_scene import SimScene
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import ABOVE_PART, HOME, LEFT, LIFTED, PANDA, one_arm
from tests.robots.sim.stepped import BumpWatch, SteppedArm
from tests.tiers import nightly

CARTESIAN = ControlSettings(controller="cartesian_impedance")
# A null space that hardly leads: what gives way is the tool alone, or the elbow alone.
LOOSE_NM_RAD = 20.0
BOTH = pytest.mark.parametrize("settings", [ControlSettings(), CARTESIAN], ids=["joint", "cartesian"])


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(realistic(one_arm(), "ideal"))


@BOTH
def test_an_arm_without_commands_does_not_move(cell: CellModel, settings: ControlSettings) -> None:
    arm = SteppedArm(cell, settings)
    arm.run(1.0)
    assert np.abs(arm.sample.position_rad - HOME).max() < 1e-9


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_the_tool_gives_way_as_its_stiffness_says(cell: CellModel, axis: int) -> None:
    """30 N against 600 N/m along one axis are 50 mm, which the stiff axes hardly see."""
    stiffness = [3000.0, 3000.0, 3000.0, 200.0, 200.0, 200.0]
    stiffness[axis] = 600.0
    settings = ControlSettings(
        controller="cartesian_impedance",
        cartesian_stiffness=tuple(stiffness),  # type: ignore[arg-type]
        nullspace_stiffness_nm_rad=0.0,
    )
    arm = SteppedArm(cell, settings)
    before = arm.tool_xyz
    force = np.zeros(3)
    force[axis] = 30.0
    arm.push((force[0], force[1], force[2]), 2.0)
    arm.run(1.9)
    assert arm.tool_xyz - before == pytest.approx(force / stiffness[axis], abs=5e-4)
    assert np.abs(arm.sample.velocity_rad_s).max() < 0.01


@pytest.mark.parametrize("ratio", [0.7, 1.0])
@pytest.mark.parametrize("stiffness", [nightly(200.0), 3000.0])
def test_what_is_let_go_comes_back_without_swinging(cell: CellModel, ratio: float, stiffness: float) -> None:
    """From 10 mm off, along each axis, it overshoots by 5 % at a ratio of 0.7 and by less at 1."""
    settings = ControlSettings(
        controller="cartesian_impedance",
        cartesian_stiffness=(stiffness, stiffness, stiffness, 100.0, 100.0, 100.0),
        cartesian_damping_ratio=ratio,
        nullspace_stiffness_nm_rad=LOOSE_NM_RAD,
    )
    for direction in np.eye(3):
        arm = SteppedArm(cell, settings)
        before = arm.tool_xyz
        push = 0.01 * stiffness * direction
        arm.push((push[0], push[1], push[2]), 1.5)
        arm.run(1.5)
        far = float((arm.tool_xyz - before) @ direction)
        assert far > 0.008
        lowest = far

        def look(arm: SteppedArm = arm, before: np.ndarray = before, direction: np.ndarray = direction) -> None:
            nonlocal lowest
            lowest = min(lowest, float((arm.tool_xyz - before) @ direction))

        arm.run(1.2, look=look)
        assert lowest > -0.08 * far
        assert np.abs(arm.tool_xyz - before).max() < 0.0005


def test_a_nudged_elbow_comes_back_and_the_tool_stays(cell: CellModel) -> None:
    """The push at the forearm moves joints in the null space by far more than the tool."""
    arm = SteppedArm(cell, replace(CARTESIAN, nullspace_stiffness_nm_rad=LOOSE_NM_RAD))
    before = arm.tool_xyz
    arm.push((0.0, 15.0, 0.0), 1.0, body="left/panda_link4")
    arm.run(0.9)
    assert np.abs(arm.sample.position_rad - HOME).max() > 0.08
    assert np.linalg.norm(arm.tool_xyz - before) < 0.002
    arm.run(3.0)
    assert np.abs(arm.sample.position_rad - HOME).max() < 0.01


@BOTH
def test_a_line_is_followed_within_half_a_millimetre(cell: CellModel, settings: ControlSettings) -> None:
    """With nominal gains, 0.3 m in 1.5 s: what is measured lies on the line."""
    kinematics = ArmKinematics(PANDA, base=RigidTransform.from_pose(LEFT.base))
    start = kinematics.tool_pose(HOME)
    goal = RigidTransform(xyz=start.xyz + np.array([0.1, 0.25, -0.13]), xyzw=start.xyzw)
    arm = SteppedArm(cell, settings)
    line = plan_line(kinematics.twin(), HOME, goal, duration_s=1.5)
    arm.apply(FollowTrajectory(arm="left", motion=1, trajectory=line, tolerance=Tolerance()))
    along = (goal.xyz - start.xyz) / np.linalg.norm(goal.xyz - start.xyz)
    worst = 0.0

    def look() -> None:
        nonlocal worst
        off = arm.tool_xyz - start.xyz
        worst = max(worst, float(np.linalg.norm(off - along * (off @ along))))

    arm.run(1.6, look=look)
    assert worst < 0.0005
    assert arm.until_finished().end == MotionEnd.REACHED


def test_a_stretched_arm_stays_calm_and_comes_back(cell: CellModel) -> None:
    """At the singularity the Cartesian law neither lets go nor swings."""
    arm = SteppedArm(cell)
    stretched = np.array([0.0, 0.2, 0.0, -0.075, 0.0, 1.5, 0.7])
    arm.follow(stretched, 2.0)
    assert arm.until_finished().end == MotionEnd.REACHED
    arm.configure(CARTESIAN)
    watch = BumpWatch(arm, 1.0)
    assert (watch.moved_m < 0.002, watch.torque_step_nm < 0.5) == (True, True)
    arm.push((-20.0, 10.0, -10.0), 0.2)
    arm.run(2.0)
    assert np.abs(arm.sample.velocity_rad_s).max() < 0.01
    arm.follow(HOME, 2.0, motion=2)
    assert arm.until_finished(2).end == MotionEnd.REACHED


SWITCHES = [
    ControlSettings(controller="cartesian_impedance"),
    ControlSettings(joint_stiffness_nm_rad=(600.0, 600.0, 600.0, 600.0, 100.0, 100.0, 100.0)),
    ControlSettings(load_kg=2.0),
    ControlSettings(controller="cartesian_impedance", load_kg=2.0, tool_xyz_m=(0.0, 0.0, 0.1)),
]


@pytest.mark.parametrize("settings", SWITCHES, ids=["cartesian", "soft", "load", "all"])
def test_a_switch_at_rest_under_load_makes_no_bump(cell: CellModel, settings: ControlSettings) -> None:
    """Torques change by less than 0.2 N m a step, and the tool glides to where the new law holds it."""
    arm = SteppedArm(cell)
    arm.push((0.0, 0.0, -19.62), 10.0)
    arm.run(0.8)
    arm.configure(settings)
    watch = BumpWatch(arm, 0.6)
    assert watch.torque_step_nm < 0.2
    assert watch.speed_m_s < 0.08


def test_switching_to_and_fro_leaves_the_arm_where_it_was(cell: CellModel) -> None:
    arm = SteppedArm(cell)
    arm.step()
    for settings in (CARTESIAN, ControlSettings(), CARTESIAN):
        arm.configure(settings)
        watch = BumpWatch(arm, 0.25)
        assert watch.moved_m < 1e-6
        assert watch.torque_step_nm < 1e-3


@pytest.mark.parametrize("settings", SWITCHES[:3], ids=["cartesian", "soft", "load"])
def test_a_switch_in_motion_is_no_bump_and_the_goal_is_reached(cell: CellModel, settings: ControlSettings) -> None:
    """The torques of an undisturbed motion change by as much."""
    arm = SteppedArm(cell)
    arm.follow(LIFTED, 1.2)
    arm.run(0.5)
    arm.configure(settings)
    assert BumpWatch(arm, 0.4).torque_step_nm < 0.25
    assert arm.until_finished().end == MotionEnd.REACHED
    if settings.load_kg == 0.0:
        assert np.abs(arm.sample.position_rad - LIFTED).max() < 0.002


def test_a_guided_arm_holds_where_it_is_left_without_a_bump(cell: CellModel) -> None:
    arm = SteppedArm(cell)
    arm.run(0.05)
    arm.apply(StartGuiding(arm="left", motion=1, damping=0.1))
    assert BumpWatch(arm, 0.2).torque_step_nm < 0.01
    arm.push((0.0, 10.0, 0.0), 0.5)
    arm.run(3.0)
    led = arm.tool_xyz
    arm.apply(FinishStream(arm="left", motion=1))
    watch = BumpWatch(arm, 0.5)
    assert (arm.until_finished().end, watch.torque_step_nm < 1.0, watch.moved_m < 0.003) == (
        MotionEnd.REACHED,
        True,
        True,
    )
    assert np.linalg.norm(led - arm.control.state.kinematics.tool_pose(HOME).xyz) > 0.05
    arm.follow(ABOVE_PART, 1.5, motion=2)
    assert arm.until_finished(2).end == MotionEnd.REACHED


@pytest.mark.parametrize("model", ["panda", "ur10", "irb4600"])
@BOTH
def test_every_arm_holds_still_and_comes_back_from_a_push(model: str, settings: ControlSettings) -> None:
    """At a step of 2 ms as well."""
    cell = build_cell(SimScene(arms=(replace(LEFT, model=model),), step_s=0.002, realism="ideal"))
    arm = SteppedArm(cell, settings)
    before = arm.sample.position_rad.copy()
    arm.run(0.2)
    assert np.abs(arm.sample.position_rad - before).max() < 1e-9
    arm.push((10.0, 20.0, -20.0), 0.5, body=f"left/{cell.arms[0].model.tool_link}")
    arm.run(0.5)
    assert np.abs(arm.sample.position_rad - before).max() > 3e-4
    assert arm.sample.wrench[:3] == pytest.approx([10.0, 20.0, -20.0], rel=0.01)
    arm.run(2.0)
    assert np.abs(arm.sample.position_rad - before).max() < 1e-3
