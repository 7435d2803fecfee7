"""The physics of arms: still under gravity, stable, limited, the same bits every time."""

from __future__ import annotations

import numpy as np
import pytest

from robots.control.commanding.arm_commands import CancelMotion, FollowTrajectory
from robots.port import Tolerance
from robots.sim.loop.simulation import Simulation
from robots.sim.loop.snapshot import SimSnapshot
from robots.sim.physics.cell_model import build_cell
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import ABOVE_PART, HOME, PANDA, box, one_arm, smooth, two_arms


def measured(simulation: Simulation) -> SimSnapshot:
    """Return the present state."""
    values = simulation.layout.new_array()
    simulation.write_snapshot(values)
    return SimSnapshot(simulation.layout, values)


def steps(simulation: Simulation, count: int) -> None:
    """Let steps pass."""
    for _ in range(count):
        simulation.step()


def test_an_arm_without_commands_does_not_move() -> None:
    """Gravity compensation of an ideal arm is exact: two seconds leave it where it was."""
    simulation = Simulation(build_cell(realistic(two_arms(), "ideal")))
    steps(simulation, 2000)
    for arm in ("left", "right"):
        assert np.abs(measured(simulation).arm(arm).position_rad - HOME).max() < 1e-9


@pytest.mark.jumps
def test_a_step_of_the_set_point_settles_without_much_overshoot() -> None:
    """A jump of 20 mrad in every joint is answered in 0.3 s, torques within the limits."""
    simulation = Simulation(build_cell(one_arm()))
    goal = HOME + 0.02
    simulation.control("left").motion.initialize(goal)
    peak = np.full(7, -np.inf)
    for _ in range(300):
        simulation.step()
        sample = measured(simulation).arm("left")
        peak = np.maximum(peak, sample.position_rad)
        assert (np.abs(sample.effort_nm) <= np.array(PANDA.limits.effort_nm) + 1e-9).all()
    assert np.abs(measured(simulation).arm("left").position_rad - goal).max() < 1e-3
    assert (peak - goal).max() < 0.005


def test_a_trajectory_is_tracked_within_two_milliradians() -> None:
    """The inertia along the set point is fed forward."""
    simulation = Simulation(build_cell(one_arm()))
    simulation.apply(
        FollowTrajectory(arm="left", motion=1, trajectory=smooth(HOME, ABOVE_PART, 1.2), tolerance=Tolerance())
    )
    worst = 0.0
    while simulation.busy:
        simulation.step()
        sample = measured(simulation).arm("left")
        worst = max(worst, float(np.abs(sample.position_rad - sample.desired_rad).max()))
    assert worst < 0.002


def test_equal_commands_give_equal_bits() -> None:
    """Two worlds with moving arms and parts in contact agree in every bit of their state."""

    def run() -> str:
        simulation = Simulation(build_cell(two_arms(box("a"), box("b", (0.09, -0.28, 0.05)))))
        simulation.apply(
            FollowTrajectory(arm="left", motion=1, trajectory=smooth(HOME, ABOVE_PART, 1.0), tolerance=Tolerance())
        )
        steps(simulation, 400)
        simulation.apply(CancelMotion(motion=1))
        steps(simulation, 400)
        return simulation.state_hash()

    assert run() == run()


def test_reading_the_state_does_not_change_the_future() -> None:
    """Snapshots between the steps leave the bits alone."""

    def run(*, look: bool) -> str:
        simulation = Simulation(build_cell(one_arm(box("a"))))
        for _ in range(200):
            simulation.step()
            if look:
                measured(simulation)
        return simulation.state_hash()

    assert run(look=True) == run(look=False)


def test_a_part_dropped_beside_the_table_misses_it_and_one_above_lands_on_it() -> None:
    """Parts fall, collide and come to rest."""
    simulation = Simulation(build_cell(one_arm(box("above", (0.3, 0.0, 0.2)), box("beside", (2.0, 0.0, 0.2)))))
    steps(simulation, 1500)
    xyz, _ = measured(simulation).frames()
    frames = simulation.summary.frames
    assert abs(xyz[frames.index("above")][2] - 0.02) < 0.001
    assert xyz[frames.index("beside")][2] < -1.0
