"""An arm that differs from its nominal model tracks with a bounded error, sticks, and feels what it does not know."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from engine.document import RealismName
from engine.skills.arm_control import ControlSettings
from robots.control.laws.joint_impedance import nominal_stiffness_nm_rad
from robots.control.motion_event import ReflexTripped
from robots.port import Array, MotionEnd
from robots.scene.realism import realism
from robots.sim.commands.world_commands import RestoreWorld
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import ABOVE_PART, PANDA, one_arm
from tests.robots.sim.stepped import SteppedArm
from tests.tiers import nightly

EFFORT_NM = np.array(PANDA.limits.effort_nm)
STIFFNESS_NM_RAD = nominal_stiffness_nm_rad(PANDA.limits)
SEEDS = pytest.mark.parametrize("seed", [0, nightly(1), nightly(2)])
# A tenth to a third of the limits: what an arm is commanded to notice.
WATCHED = ControlSettings(collision_torque_nm=(12.0, 12.0, 12.0, 12.0, 4.0, 4.0, 4.0), collision_force_n=30.0)


@pytest.fixture(scope="module", name="typical")
def _typical() -> CellModel:
    return build_cell(realistic(one_arm()))


@dataclass(frozen=True, kw_only=True)
class Moved:
    """What an arm did on a fast motion: greatest and final error of each joint, greatest estimate; all (n,)."""

    behind_rad: Array
    off_rad: Array
    felt_nm: Array
    end: MotionEnd


def moved(arm: SteppedArm, goal: Array = ABOVE_PART, duration_s: float = 1.0) -> Moved:
    """Let an arm go to a configuration and rest there for half a second."""
    behind: list[Array] = []
    felt: list[Array] = []

    def look() -> None:
        sample = arm.sample
        behind.append(sample.desired_rad - sample.position_rad)
        felt.append(sample.external_nm.copy())

    arm.follow(goal, duration_s)
    arm.run(duration_s + 0.1, look=look)
    end = arm.until_finished().end
    at_rest: list[Array] = []
    arm.run(0.5, look=lambda: at_rest.append(arm.sample.desired_rad - arm.sample.position_rad))
    return Moved(
        behind_rad=np.abs(behind).max(axis=0),
        off_rad=np.abs(np.mean(at_rest[-100:], axis=0)),
        felt_nm=np.abs(felt).max(axis=0),
        end=end,
    )


@SEEDS
@pytest.mark.parametrize(("name", "least_mrad", "most_mrad"), [("typical", 0.03, 0.5), ("poor", 0.4, 3.0)])
def test_an_arm_rests_beside_its_goal_by_friction_and_weight_over_stiffness(
    name: RealismName, least_mrad: float, most_mrad: float, seed: int
) -> None:
    """Not exactly there, as an ideal arm is, and no farther than the torques that its controller does not know."""
    found = moved(SteppedArm(build_cell(realistic(one_arm(), name, seed=seed))))
    assert found.end is MotionEnd.REACHED
    assert least_mrad < 1e3 * found.off_rad.max() < most_mrad
    # About one period of the set point at 2.5 rad/s, and what friction and delay add.
    assert 1e3 * found.behind_rad.max() < 2.6 + 2.0 * most_mrad
    # Coulomb friction of the unluckiest joint, and its share of wrong masses: a tenth of the weight of the arm at most.
    preset = realism(name)
    friction_nm = preset.coulomb_share * (1.0 + preset.friction_spread) * EFFORT_NM
    weight_nm = 0.1 * np.abs(SteppedArm(build_cell(realistic(one_arm(), "ideal"))).sample.effort_nm)
    assert (found.off_rad < (friction_nm + weight_nm + 0.05) / STIFFNESS_NM_RAD).all()


def test_an_ideal_arm_is_where_it_shall_be() -> None:
    found = moved(SteppedArm(build_cell(realistic(one_arm(), "ideal"))))
    assert found.off_rad.max() < 2e-5
    assert found.felt_nm.max() < 0.01


def test_a_joint_sticks_after_a_push_by_no_more_than_its_friction(typical: CellModel) -> None:
    """What is pushed aside and released stays aside: a spring alone would bring it back."""
    arm = SteppedArm(typical)
    arm.run(0.5)
    before = arm.simulation.control("left").state.position.copy()
    arm.push((30.0, 30.0, 0.0), 0.5)
    arm.run(0.5)
    aside = np.abs(arm.control.state.position - before)
    arm.run(1.5)
    stays = np.abs(arm.control.state.position - before)
    friction_nm = typical.model.dof_frictionloss[typical.arms[0].dof]
    assert aside.max() > 0.004
    assert stays.max() > 1e-4
    # From one edge of the band of friction to the other.
    assert (stays < 2.0 * friction_nm / STIFFNESS_NM_RAD + 5e-5).all()


def estimated(arm: SteppedArm, seconds: float = 0.3) -> tuple[Array, Array]:
    """Return mean and standard deviation of the external torques that an arm estimates, both (n,)."""
    found: list[Array] = []
    arm.run(seconds, look=lambda: found.append(arm.sample.external_nm.copy()))
    return np.mean(found, axis=0), np.std(found, axis=0)


@SEEDS
def test_a_push_is_estimated_up_to_friction_and_the_weight_that_is_not_known(seed: int) -> None:
    """20 N at the tool: J^T F within Coulomb friction plus 1 % of the limit; noise below 0.6 % of it."""
    arm = SteppedArm(build_cell(realistic(one_arm(), seed=seed)))
    arm.push((20.0, 0.0, 0.0), 2.0)
    arm.run(1.5)
    mean_nm, noise_nm = estimated(arm)
    pushed_nm = arm.control.state.jacobian.T @ np.array([20.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert np.abs(pushed_nm).max() > 4.0
    assert (np.abs(mean_nm - pushed_nm) < (realism("typical").coulomb_share * 1.3 + 0.01) * EFFORT_NM).all()
    assert np.abs(mean_nm - pushed_nm).max() > 0.02
    assert (noise_nm < 0.006 * EFFORT_NM).all()
    assert noise_nm.min() > 0.001


@SEEDS
def test_a_moving_joint_feels_what_its_friction_differs_from_the_nominal_one(seed: int) -> None:
    """An observer without a model of friction felt all of it, 1.2 N m here."""
    arm = SteppedArm(build_cell(realistic(one_arm(), seed=seed)))
    arm.run(0.3)
    rest_nm, _ = estimated(arm)
    goal = arm.sample.desired_rad + np.array([0.8, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    arm.follow(goal, 2.0)
    arm.run(0.85)
    moving_nm, _ = estimated(arm)
    preset = realism("typical")
    coulomb_nm = preset.coulomb_share * float(EFFORT_NM[0])
    viscous_nm = preset.viscous_share_s_rad * float(EFFORT_NM[0]) * 0.75
    assert abs(moving_nm[0]) < preset.friction_spread * (coulomb_nm + viscous_nm) + 0.1
    assert abs(rest_nm[0]) < 2.0 * coulomb_nm


def test_no_fast_motion_of_its_own_trips_the_reflex_and_a_push_does(typical: CellModel) -> None:
    """12 N m at the large joints and 4 N m at the small ones; a typical arm feels at most a third of it by itself."""
    arm = SteppedArm(typical, WATCHED)
    found = moved(arm)
    assert found.end is MotionEnd.REACHED
    assert (found.felt_nm < np.array(WATCHED.collision_torque_nm) / 3.0).all()
    assert not any(isinstance(event, ReflexTripped) for event in arm.events)
    arm.push((0.0, 25.0, 0.0), 0.2)
    arm.push((0.0, 60.0, 0.0), 0.2, body="left/panda_link5")
    arm.run(0.1)
    assert [event.arm for event in arm.events if isinstance(event, ReflexTripped)] == ["left"]


def test_a_seed_repeats_every_bit_and_another_seed_none_of_them() -> None:
    def ends(seed: int) -> tuple[str, tuple[str, ...], list[float]]:
        arm = SteppedArm(build_cell(realistic(one_arm(), seed=seed)))
        moved(arm)
        sample = arm.sample
        measured = np.concatenate((sample.position_rad, sample.effort_nm, sample.external_nm, sample.wrench))
        return arm.simulation.state_hash(), tuple(repr(event) for event in arm.events), measured.tolist()

    one, again, other = ends(3), ends(3), ends(4)
    assert one == again
    assert one[0] != other[0]


def test_two_worlds_restored_from_one_image_continue_alike(typical: CellModel) -> None:
    """Noise and delay continue with the step of the image, whatever the world did before."""
    arm = SteppedArm(typical)
    moved(arm)
    image = np.zeros(arm.simulation.summary.image_size)
    arm.simulation.write_image(image)
    fresh = SteppedArm(typical)
    for world in (arm, fresh):
        world.apply(RestoreWorld(image=image))
        world.run(0.2)
    assert arm.simulation.state_hash() == fresh.simulation.state_hash()
    assert arm.sample.external_nm.tolist() == fresh.sample.external_nm.tolist()
    assert arm.sample.position_rad.tolist() == fresh.sample.position_rad.tolist()
