"""The measures of an open world, in lockstep and in a process of its own."""

from __future__ import annotations

import pytest

from engine.robot import MeasurePort
from tests.robots.sim.sim_cell import HOME, both_hosts_nightly, move, one_arm, opened, until


@both_hosts_nightly
async def test_a_world_sums_up_what_its_arms_do(host: str) -> None:
    """It is a measure port; in a process of its own it answers with what was summed up a moment ago."""
    async with opened(one_arm()) as world:
        await move(world.arm("left"), HOME + 0.1, 0.3)
        assert isinstance(world, MeasurePort)
        await until(lambda: world.measures()["left.joint_path_rad"] > 0.69)
        found = world.measures()
    assert found["left.joint_path_rad"] == pytest.approx(7 * 0.1, abs=0.02)
    assert found["left.path_m"] > 0.01
    assert found["cell.contacts"] == 0.0
