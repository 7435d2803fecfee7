"""The guarded move in physics: the table is found, gently."""

from __future__ import annotations

import pytest

from engine.bus import GoalStatus
from engine.messages import Pose
from engine.skills.arm_control import ControllerName, SetController
from engine.skills.contact import MoveUntilContact
from engine.skills.motion import CartTrapVel
from tests.robots.arm.simulated import HOME, simulated
from tests.tiers import nightly

ABOVE = CartTrapVel(pose=Pose(xyz=(-0.1, 0.1, 0.02), xyzw=(1.0, 0.0, 0.0, 0.0)), speed=0.5)
# The pads end so far before the tool centre point (robots/tools/panda_hand/tool.yaml and the hand's URDF).
TIP_M = 0.0584 + 0.04525 + 0.0185 / 2 - 0.1034


@pytest.mark.virtual
@pytest.mark.parametrize("law", ["joint_impedance", "cartesian_impedance"])
@pytest.mark.parametrize(("speed_m_s", "peak_n"), [nightly(0.005, 15.0), (0.02, 60.0)])
async def test_the_table_is_found_within_two_millimetres_and_the_arm_rests_pressing_no_harder_than_asked_for(
    speed_m_s: float, peak_n: float, law: ControllerName
) -> None:
    """Rigid pads on a rigid table ring when they meet: the peak is the arm's momentum, not its path."""
    async with simulated() as cell:
        await cell.bus.call(SetController(controller=law), to="left")
        await cell.perform(ABOVE)
        search = MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.02, speed_m_s=speed_m_s, force_n=5.0)
        handle = cell.bus.send_goal(search, to="left")
        felt: list[float] = []
        while not handle.finished:
            felt.append(float(cell.port.sample().wrench[2]))
            await cell.bus.clock.sleep(0.002)
        end = await handle.result()
        back = await cell.perform(HOME)
    assert end.status is GoalStatus.SUCCEEDED, end.cause
    assert end.result is not None
    assert end.result.contact
    assert end.result.pose.xyz[2] == pytest.approx(TIP_M, abs=0.002)
    assert end.result.travelled_m == pytest.approx(0.02 - TIP_M, abs=0.002)
    assert -1.0 < end.result.force_n < 5.0
    assert 5.0 < max(felt) < peak_n
    assert back.status is GoalStatus.SUCCEEDED, back.cause


@pytest.mark.virtual
async def test_with_a_peak_the_table_is_touched_no_harder_and_the_result_says_how_hard() -> None:
    """The first five millimetres are clear; what compensates friction pushes on at the touch, and counts."""
    async with simulated() as cell:
        await cell.perform(ABOVE)
        search = MoveUntilContact(
            direction=(0.0, 0.0, -1.0), distance_m=0.02, speed_m_s=0.05, force_n=5.0, peak_n=10.0, clear_m=0.005
        )
        handle = cell.bus.send_goal(search, to="left")
        felt: list[float] = []
        while not handle.finished:
            felt.append(float(cell.port.sample().wrench[2]))
            await cell.bus.clock.sleep(0.002)
        end = await handle.result()
    assert end.result is not None
    assert end.result.contact
    assert end.result.pose.xyz[2] == pytest.approx(TIP_M, abs=0.002)
    assert 5.0 < end.result.peak_n <= 10.0
    assert max(felt) <= end.result.peak_n + 1e-6


@pytest.mark.virtual
async def test_nothing_in_the_way_is_no_contact_however_fast_the_arm_starts_and_stops() -> None:
    """What its own motion needs is no force of the surroundings."""
    async with simulated() as cell:
        end = await cell.perform(
            MoveUntilContact(direction=(0.0, 1.0, 0.2), distance_m=0.25, speed_m_s=0.2, force_n=5.0)
        )
    assert end.result is not None
    assert (end.status, end.result.contact) == (GoalStatus.SUCCEEDED, False)
    assert end.result.travelled_m == pytest.approx(0.25, abs=0.003)


@pytest.mark.virtual
async def test_a_hand_in_the_way_is_a_contact_and_a_push_from_behind_is_none() -> None:
    """Only the force against the way counts."""
    async with simulated() as cell:
        search = MoveUntilContact(direction=(0.0, 1.0, 0.0), distance_m=0.1, speed_m_s=0.05, force_n=8.0)
        handle = await cell.begun(search, after_s=1.0)
        cell.push((0.0, 15.0, 0.0), duration_s=0.5)
        await cell.bus.clock.sleep(0.7)
        from_behind = handle.finished
        cell.push((0.0, -15.0, 0.0), duration_s=0.5)
        end = await handle.result()
    assert end.result is not None
    assert (from_behind, end.result.contact) == (False, True)
    assert end.result.travelled_m < 0.09
