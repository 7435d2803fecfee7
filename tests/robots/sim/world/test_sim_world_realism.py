"""A world with errors on both hosts: what it measures is what its encoders count, and its snapshots name its seed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine.errors import RobotError
from robots.port import MotionEnd
from tests.robots.sim.realistic import realistic
from tests.robots.sim.sim_cell import HOME, both_hosts_nightly, move, one_arm, opened

COUNT_RAD = 2.0 * math.pi / 2**19


@both_hosts_nightly
async def test_an_arm_reaches_its_goal_as_far_as_friction_allows_and_is_measured_in_whole_counts(host: str) -> None:
    async with opened(realistic(one_arm())) as world:
        report = await move(world.arm("left"), HOME + 0.1, 0.5)
        sample = world.arm("left").sample()
    assert report.end is MotionEnd.REACHED
    counts = sample.position_rad / COUNT_RAD
    assert np.abs(counts - np.rint(counts)).max() < 1e-6
    assert 1e-4 < np.abs(sample.position_rad - sample.desired_rad).max() < 0.003
    assert 0.0 < np.abs(sample.velocity_rad_s).max() < 0.01


@pytest.mark.virtual
async def test_a_snapshot_of_an_arm_of_another_seed_is_refused() -> None:
    """It would continue with other masses: the model of the world is another one."""
    async with opened(realistic(one_arm(), seed=1)) as world:
        snapshot = world.snapshot()
    async with opened(realistic(one_arm(), seed=2)) as world:
        with pytest.raises(RobotError, match="of another world"):
            await world.restore(snapshot)
    async with opened(realistic(one_arm(), seed=1)) as world:
        await world.restore(snapshot)
