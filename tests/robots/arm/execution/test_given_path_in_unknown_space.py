"""Motions along given paths through space that no camera has seen, by the policy `slow`: slowed there only."""

from __future__ import annotations

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.cause_chain import describe_cause
from engine.skills.identification import IdentifyFriction
from engine.skills.motion import JointTrapVel
from robots.workspace.unknown_space import SLOW_SPEED, UnknownSpaceRule
from tests.robots.panda_arm import panda_model
from tests.robots.workspace.fake_cell import FakeCell, fake_cell
from tests.robots.workspace.free_cell import ACROSS, THERE, free

HALF = ((-0.6, -0.6, 0.1), (0.6, -0.1, 0.9))
"""All that is mapped on the side of ACROSS."""
SLOW = UnknownSpaceRule(policy="slow")


async def there(cell: FakeCell) -> None:
    """Go where the motions begin, through seen space."""
    cell.cameras.see_all_but()
    end = await cell.bus.send_goal(free(THERE, speed=1.0), to="left").result()
    assert end.status is GoalStatus.SUCCEEDED, end.cause


@pytest.mark.virtual
async def test_a_fast_motion_is_slowed_where_it_passes_unknown_space_and_fast_before() -> None:
    async with fake_cell(unknown_space=SLOW) as cell:
        await there(cell)
        cell.cameras.see_all_but(HALF)
        end = await cell.bus.send_goal(JointTrapVel(joints=ACROSS, speed=0.5), to="left").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        followed = cell.port.followed[-1]
    shares = np.abs(followed.velocity_rad_s) / np.array(panda_model().limits.velocity_rad_s)
    turned = followed.position_rad[:, 0]
    np.testing.assert_allclose(followed.position_rad[-1], ACROSS, atol=1e-6)
    assert shares.max() > 0.3
    assert shares[turned < -0.2].max() <= SLOW_SPEED * 1.001


@pytest.mark.virtual
async def test_a_motion_whose_task_depends_on_its_time_is_refused_there_with_the_speed_that_is_accepted() -> None:
    async with fake_cell(unknown_space=SLOW) as cell:
        await there(cell)
        before = len(cell.port.followed)
        cell.cameras.see_all_but(((-0.6, -0.6, 0.1), (0.6, 0.6, 0.9)))
        goal = IdentifyFriction(joints=("panda_joint1",), amplitude_rad=1.0)
        end = await cell.bus.send_goal(goal, to="left").result()
        why = describe_cause(end.cause) if end.cause else ""
        assert (end.status, len(cell.port.followed)) == (GoalStatus.REJECTED, before), why
        for words in ("unknown space", "at most 10% of the joint speed limits", "cannot be slowed"):
            assert words in why, why
