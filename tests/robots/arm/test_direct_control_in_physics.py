"""Direct joint control in physics: followed within the limits, at rest when the sender falls silent."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from tests.robots.arm.simulated import HOME, simulated
from tests.robots.panda_arm import home, panda_model


@pytest.mark.virtual
async def test_a_sine_is_followed_and_a_silence_brings_the_arm_to_rest_until_it_is_spoken_to_again() -> None:
    """Then it is turned off, and goals are taken again."""
    async with simulated() as cell:
        commands = cell.bus.topic("left/direct_joints", JointCommand)
        clock = cell.bus.clock

        async def send(duration_s: float) -> float:
            """Send the sine and return the greatest speed."""
            start_s, fastest = clock.now_s(), 0.0
            while clock.now_s() < start_s + duration_s:
                joints = home()
                joints[0] += 0.3 * math.sin(2.0 * (clock.now_s() - begun_s))
                commands.publish(JointCommand(position_rad=tuple(joints.tolist())))
                await clock.sleep(0.01)
                fastest = max(fastest, cell.speed_rad_s())
            return fastest

        assert (await cell.bus.call(SwitchDirectControl(on=True, watchdog_s=0.1), to="left")).success
        begun_s = clock.now_s()
        moving = await send(1.0)
        wanted = home()[0] + 0.3 * math.sin(2.0 * (clock.now_s() - begun_s))
        behind = abs(cell.joints()[0] - wanted)
        await clock.sleep(1.0)
        silent = cell.speed_rad_s()
        rejected = await cell.perform(HOME)
        spoken_to = await send(0.5)
        assert (await cell.bus.call(SwitchDirectControl(on=False), to="left")).success
        after = await cell.perform(HOME)
    assert behind < 0.1
    assert (moving > 0.1, spoken_to > 0.1, silent < 0.01) == (True, True, True)
    assert (rejected.status, after.status) == (GoalStatus.REJECTED, GoalStatus.SUCCEEDED)


@pytest.mark.virtual
async def test_a_jump_and_a_place_beyond_the_limits_are_followed_within_the_limits() -> None:
    """The user's set points need not be smooth; the arm's are."""
    limits = panda_model().limits
    async with simulated() as cell:
        await cell.bus.call(SwitchDirectControl(on=True, watchdog_s=2.0), to="left")
        far = (home() + np.array([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 9.0])).tolist()
        cell.bus.topic("left/direct_joints", JointCommand).publish(JointCommand(position_rad=tuple(far)))
        fastest = 0.0
        for _ in range(150):
            await cell.bus.clock.sleep(0.01)
            fastest = max(fastest, cell.speed_rad_s())
        await cell.bus.call(SwitchDirectControl(on=False), to="left")
        joints = cell.joints()
    assert 0.5 < fastest < limits.velocity_rad_s[6] * 1.05
    assert limits.upper_rad[6] - 0.1 < joints[6] < limits.upper_rad[6] + 0.005
