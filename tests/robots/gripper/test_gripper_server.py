"""Gripper skills over a fake port: honest grasp results, and stopping."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock
from engine.skills.gripper import GripperGrasp, GripperMove, GripperOpen, GripperSetting, ReadGripper
from robots.gripper import GripperServer
from tests.robots.fake_port import FakeGripperPort

HAND = "left/gripper"
GRASP = GripperGrasp(width_m=0.03, force_n=20.0)


@asynccontextmanager
async def served(port: FakeGripperPort) -> AsyncGenerator[SkillBus]:
    """A bus with one gripper on it."""
    async with SkillBus(new_clock()) as bus:
        GripperServer(name=HAND, port=port).register(bus)
        yield bus


async def grasp_reason(port: FakeGripperPort) -> str:
    """Grasp and return why nothing is held; `held` says the opposite of it."""
    async with served(port) as bus:
        end = await bus.send_goal(GRASP, to=HAND).result()
        assert end.status is GoalStatus.SUCCEEDED
        assert end.result is not None
        assert end.result.held is not bool(end.result.reason)
        return end.result.reason


@pytest.mark.virtual
async def test_a_part_of_the_expected_width_between_both_pads_is_held() -> None:
    """The plain success."""
    assert await grasp_reason(FakeGripperPort(obstacle_m=0.031)) == ""


@pytest.mark.virtual
async def test_fingers_that_meet_nothing_say_so() -> None:
    """A missing part."""
    assert await grasp_reason(FakeGripperPort()) == "fingers closed to 0.0 mm and touch nothing"


@pytest.mark.virtual
async def test_one_pad_on_the_table_is_no_grasp() -> None:
    """A finger that came down on something."""
    reason = await grasp_reason(FakeGripperPort(obstacle_m=0.03, contacts=("table", "")))
    assert reason == "only the left pad touches table, fingers at 30.0 mm"


@pytest.mark.virtual
async def test_pads_on_different_bodies_are_no_grasp() -> None:
    """Two things between the fingers, neither of them held."""
    reason = await grasp_reason(FakeGripperPort(obstacle_m=0.03, contacts=("table", "part")))
    assert reason == "the pads touch different things, table and part"


@pytest.mark.virtual
async def test_a_part_of_another_width_is_not_the_part() -> None:
    """Judged by the final opening and the tolerances of the goal."""
    reason = await grasp_reason(FakeGripperPort(obstacle_m=0.045))
    assert reason == "the fingers stopped at 45.0 mm on part, expected 20.0 mm to 40.0 mm"


@pytest.mark.virtual
async def test_contact_without_force_is_no_grasp() -> None:
    """Fingers that merely lean on a part."""
    reason = await grasp_reason(FakeGripperPort(obstacle_m=0.03, force_share=0.2))
    assert reason == "the pads press with 4.0 N on part, expected 20.0 N"


@pytest.mark.virtual
async def test_a_gripper_that_cannot_name_what_it_touches_can_still_hold() -> None:
    """Real grippers report contact as `?`."""
    assert await grasp_reason(FakeGripperPort(obstacle_m=0.03, contacts=("?", "?"))) == ""


@pytest.mark.virtual
async def test_a_lost_part_is_no_longer_held_when_asked() -> None:
    """ReadGripper judges anew each time."""
    port = FakeGripperPort(obstacle_m=0.03)
    async with served(port) as bus:
        await bus.send_goal(GRASP, to=HAND).result()
        before = await bus.call(ReadGripper(), to=HAND)
        port.lose_the_part()
        after = await bus.call(ReadGripper(), to=HAND)
    assert (before.held, after.held) == (True, False)


@pytest.mark.virtual
async def test_fingers_that_were_moved_hold_nothing_even_where_they_touch() -> None:
    """Only a grasp makes something held."""
    async with served(FakeGripperPort(obstacle_m=0.03)) as bus:
        await bus.send_goal(GRASP, to=HAND).result()
        end = await bus.send_goal(GripperMove(width_m=0.03), to=HAND).result()
        state = await bus.call(ReadGripper(), to=HAND)
    assert end.result is not None
    assert (end.result.held, state.held, state.force_n > 10.0) == (False, False, True)


@pytest.mark.virtual
async def test_opening_opens_fully() -> None:
    """And says how far."""
    async with served(FakeGripperPort(obstacle_m=0.03)) as bus:
        await bus.send_goal(GRASP, to=HAND).result()
        end = await bus.send_goal(GripperOpen(), to=HAND).result()
    assert end.result is not None
    assert (end.status, end.result.width_m) == (GoalStatus.SUCCEEDED, 0.08)


@pytest.mark.virtual
async def test_fingers_that_cannot_open_fail_and_report_where_they_stopped() -> None:
    """Blocked on the way out."""
    async with served(FakeGripperPort(obstacle_m=0.03, opens_to_m=0.05)) as bus:
        await bus.send_goal(GRASP, to=HAND).result()
        end = await bus.send_goal(GripperOpen(), to=HAND).result()
    assert end.status is GoalStatus.ABORTED
    assert end.cause is not None
    assert end.cause.message.startswith("the fingers stopped at 50.0 mm, instead of 80.0 mm")


@pytest.mark.virtual
async def test_an_opening_beyond_the_hand_is_rejected() -> None:
    """Before anything moves."""
    port = FakeGripperPort()
    async with served(port) as bus:
        end = await bus.send_goal(GripperMove(width_m=0.2), to=HAND).result()
    assert end.cause is not None
    assert (end.status, port.motion) == (GoalStatus.REJECTED, None)
    assert "opens to 80.0 mm" in end.cause.message


@pytest.mark.virtual
async def test_a_device_fault_is_the_cause_of_the_failure() -> None:
    """The port's reason is passed on."""
    port = FakeGripperPort(obstacle_m=0.03)
    async with served(port) as bus:
        handle = bus.send_goal(GRASP, to=HAND)
        await bus.clock.sleep(0.2)
        assert port.motion is not None
        port.motion.fail("motor overheated")
        end = await handle.result()
    assert end.cause is not None
    assert (end.status, end.cause.chain()[-1].message) == (GoalStatus.ABORTED, "motor overheated")


@pytest.mark.virtual
async def test_a_cancelled_grasp_ends_at_rest_and_the_next_goal_is_taken() -> None:
    """Preemption needs no restart."""
    port = FakeGripperPort(obstacle_m=0.03)
    async with served(port) as bus:
        handle = bus.send_goal(GRASP, to=HAND)
        await bus.clock.sleep(0.2)
        handle.cancel()
        canceled = await handle.result()
        assert port.motion is not None
        at_rest = port.motion.ended
        following = await bus.send_goal(GripperOpen(), to=HAND).result()
    assert canceled.result is not None
    assert 0.03 < canceled.result.width_m < 0.08
    assert (canceled.status, at_rest, following.status) == (GoalStatus.CANCELED, True, GoalStatus.SUCCEEDED)


@pytest.mark.virtual
async def test_every_goal_tells_how_the_gripper_was_before() -> None:
    """So that it can be undone: what it held, how hard, and how wide it was open."""
    async with served(FakeGripperPort(obstacle_m=0.031)) as bus:
        grasped = (await bus.send_goal(GRASP, to=HAND).result()).result
        opened = (await bus.send_goal(GripperOpen(), to=HAND).result()).result
    assert grasped is not None
    assert opened is not None
    assert grasped.start == GripperSetting(width_m=0.08, held=False)
    assert opened.start == GripperSetting(width_m=0.031, held=True, force_n=20.0)


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("contacts", "part", "by"),
    [(("part", "part"), "part", "contact"), (("?", "part"), "part", "contact"), (("?", "?"), "?", "width")],
)
async def test_a_gripper_says_what_it_holds_and_what_tells_it(contacts: tuple[str, str], part: str, by: str) -> None:
    """In the result of the grasp and later; without a contact that names a body only the opening tells."""
    async with served(FakeGripperPort(obstacle_m=0.03, contacts=contacts)) as bus:
        result = (await bus.send_goal(GRASP, to=HAND).result()).result
        state = await bus.call(ReadGripper(), to=HAND)
    assert result is not None
    assert (result.held, result.part, result.by) == (True, part, by)
    assert (state.held, state.part, state.by) == (True, part, by)


@pytest.mark.virtual
async def test_a_gripper_that_holds_nothing_names_nothing() -> None:
    async with served(FakeGripperPort()) as bus:
        result = (await bus.send_goal(GRASP, to=HAND).result()).result
    assert result is not None
    assert (result.held, result.part, result.by) == (False, "", "width")
