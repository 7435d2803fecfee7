"""Arms with friction reach joint goals under every law, and one guided by hand neither drifts nor goes on by itself."""

from __future__ import annotations

import numpy as np
import pytest

from engine.document import RealismName
from engine.skills.arm_control import ControlSettings
from robots.control.commanding.arm_commands import FinishStream, StartGuiding
from robots.port import Array, MotionEnd
from robots.sim.physics.cell_model import build_cell
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import ABOVE_PART, HOME, LIFTED, one_arm
from tests.robots.sim.stepped import SteppedArm
from tests.tiers import nightly

CARTESIAN = ControlSettings(controller="cartesian_impedance")
SEEDS = pytest.mark.parametrize("seed", [1, nightly(0), nightly(2), nightly(3)])


def error_rad(arm: SteppedArm) -> Array:
    """Return how far each joint is beside its set point, (n,), averaged over 50 ms."""
    found: list[Array] = []
    arm.run(0.05, look=lambda: found.append(arm.sample.desired_rad - arm.sample.position_rad))
    return np.abs(np.mean(found, axis=0))


@SEEDS
@pytest.mark.parametrize(
    ("name", "settings", "most_mrad"),
    [
        ("typical", ControlSettings(), 0.5),
        ("typical", CARTESIAN, 3.0),
        ("poor", ControlSettings(), 2.5),
        ("poor", CARTESIAN, 9.0),
    ],
    ids=["typical-joint", "typical-cartesian", "poor-joint", "poor-cartesian"],
)
def test_joint_goals_are_reached_under_every_law(
    name: RealismName, settings: ControlSettings, most_mrad: float, seed: int
) -> None:
    """A null space of 20 N m/rad and no compensation failed two of three goals, typical, and all of them, poor."""
    arm = SteppedArm(build_cell(realistic(one_arm(), name, seed=seed)), settings)
    for motion, (goal, duration_s) in enumerate(((ABOVE_PART, 1.0), (LIFTED, 0.6), (HOME, 1.2)), 1):
        arm.follow(goal, duration_s, motion=motion)
        assert arm.until_finished(motion).end is MotionEnd.REACHED
        arm.run(0.4)
        assert 1e3 * error_rad(arm).max() < most_mrad


@pytest.mark.parametrize("settings", [ControlSettings(), CARTESIAN], ids=["joint", "cartesian"])
@pytest.mark.parametrize("name", ["typical", "poor"])
def test_an_arm_at_rest_does_not_hunt(name: RealismName, settings: ControlSettings) -> None:
    """Integral action through stiction swings around a goal for ever, unless it ends in a dead band."""
    arm = SteppedArm(build_cell(realistic(one_arm(), name, seed=1)), settings)
    arm.follow(LIFTED, 0.8)
    assert arm.until_finished().end is MotionEnd.REACHED
    arm.run(2.5)
    seen: list[Array] = []
    arm.run(1.5, look=lambda: seen.append(arm.sample.position_rad))
    assert np.ptp(seen, axis=0).max() < 1.5e-3


@pytest.mark.parametrize("name", ["typical", "poor"])
@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_guided_arm_stays_where_it_is_left(name: RealismName, damping: float) -> None:
    """Friction is compensated for a hand only: all of it stops the arm, and holds it against a wrong weight."""
    arm = SteppedArm(build_cell(realistic(one_arm(), name, seed=1)))
    arm.apply(StartGuiding(arm="left", motion=1, damping=damping))
    arm.run(0.5)
    before = arm.tool_xyz
    arm.run(2.0)
    assert np.linalg.norm(arm.tool_xyz - before) < 0.002
    arm.push((0.0, 25.0, 0.0), 0.3)
    arm.run(0.3)
    pushed = arm.tool_xyz
    assert np.linalg.norm(pushed - before) > 0.01
    arm.run(2.5)
    left = arm.tool_xyz
    arm.run(1.0)
    assert np.linalg.norm(arm.tool_xyz - left) < 0.002
    arm.apply(FinishStream(arm="left", motion=1))
    assert arm.until_finished().end is MotionEnd.REACHED


def test_a_hand_moves_a_guided_arm_more_easily_than_its_friction_alone_lets_it() -> None:
    """5 N are 2.5 N m at the shoulder, of which 1 N m is friction."""
    scene = realistic(one_arm(), seed=1)
    compensated = SteppedArm(build_cell(scene))
    rough = SteppedArm(build_cell(scene))
    # The same arm with a controller that knows of no friction.
    rough.control._friction = None  # pyright: ignore[reportPrivateUsage]
    moved_m: list[float] = []
    for arm in (compensated, rough):
        arm.apply(StartGuiding(arm="left", motion=1, damping=0.0))
        arm.run(0.5)
        before = arm.tool_xyz
        arm.push((0.0, 5.0, 0.0), 1.0)
        arm.run(1.0)
        moved_m.append(float(np.linalg.norm(arm.tool_xyz - before)))
    assert moved_m[0] > 1.15 * moved_m[1] > 0.01
