"""One motion, summed up by the world that makes it and by the topics that it publishes."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.measures import TopicMeasures
from engine.messages import Pose, RobotDescription
from tests.robots.sim.sim_cell import ABOVE_PART, HOME, LEFT, PANDA, move, one_arm, opened
from tests.robots.sim.stepped import TOOL


def description() -> RobotDescription:
    """Return what the server of the arm publishes."""
    limits = PANDA.limits
    return RobotDescription(
        name="left",
        model="panda",
        urdf="",
        joint_names=PANDA.arm_joints,
        lower_rad=limits.lower_rad,
        upper_rad=limits.upper_rad,
        velocity_rad_s=limits.velocity_rad_s,
        acceleration_rad_s2=limits.acceleration_rad_s2,
        base=Pose(xyz=LEFT.base.xyz),
        tool_frame=TOOL,
    )


@pytest.mark.virtual
async def test_topics_have_what_the_world_sums_up() -> None:
    """Within the rate of the topics: 30 Hz for the tool, 25 ms for the joints, and forces as often as published."""
    bus, by_topics = SkillBus(new_clock()), TopicMeasures()
    async with opened(one_arm()) as world:
        world.register(bus)
        bus.topic("left/description", RobotDescription).publish(description())
        by_topics.listen(bus)
        await move(world.arm("left"), ABOVE_PART, 1.5)
        await move(world.arm("left"), HOME + 0.3 * np.eye(7)[0], 1.5)
        world.push(TOOL, force_n=(0.0, 12.0, 0.0), duration_s=0.3, at_m=(0.0, 0.0, 0.1))
        await asyncio.sleep(0.5)
        expected, found = world.measures(), by_topics.measures()
    # No topic has set points, or distances.
    unknown = {"left.tracking_error_max_rad", "left.set_point_jumps", "left.clearance_min_m"}
    assert set(found) == {name for name in expected if name.startswith("left.")} - unknown
    assert found["left.path_m"] == pytest.approx(expected["left.path_m"], rel=0.01)
    assert found["left.joint_path_rad"] == pytest.approx(expected["left.joint_path_rad"], rel=0.01)
    assert found["left.speed_max_m_s"] == pytest.approx(expected["left.speed_max_m_s"], rel=0.02)
    assert found["left.force_max_n"] == pytest.approx(expected["left.force_max_n"], rel=0.02)
    assert found["left.torque_max_nm"] == pytest.approx(expected["left.torque_max_nm"], rel=0.02)
