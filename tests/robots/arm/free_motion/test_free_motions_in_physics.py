"""Collision-free motion of a simulated arm: around what is put into its way, waiting where it cannot go around."""

from __future__ import annotations

import asyncio
from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.clock import run_virtual
from engine.messages import Pose
from engine.skills.arm_control import SetSpeedOverride
from engine.skills.motion import ForwardKinematics
from engine.skills.planning import FreeMotionFeedback, MotionTarget, MoveFree, PathPreview, PlanOptions
from tests.robots.workspace.free_cell import (
    ACROSS,
    POST,
    REST_RAD_S,
    THERE,
    WALL,
    Witness,
    box,
    free,
    free_cell,
    put_after_the_check,
)
from tests.tiers import nightly

# Stretched out, each arm reaches beyond the middle between them.
FAR_THERE, FAR_ACROSS = (1.0, 0.4, 0.0, -1.9, 0.0, 2.3, 0.8), (-1.0, 0.4, 0.0, -1.9, 0.0, 2.3, 0.8)


@pytest.mark.virtual
async def test_an_arm_reaches_its_goal_and_says_what_that_took(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        result = await opened.go(THERE)
        assert np.abs(np.array(result.joints) - THERE).max() < 0.005
        assert (result.stops, result.replans, result.reused, result.waited_s, result.blocked) == (0, 0, 0, 0.0, "")


@pytest.mark.virtual
async def test_what_gets_into_the_path_between_its_check_and_the_start_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        witness = Witness(opened, POST)
        put_after_the_check(opened, POST, monkeypatch)
        result = await opened.go(ACROSS)
        await witness.end()
        assert (result.stops, witness.touched) == (1, set())


@pytest.mark.virtual
async def test_an_obstacle_put_into_the_way_of_a_moving_arm_is_gone_around_without_touching_it(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        witness = Witness(opened, POST)
        await opened.put(POST)
        end = await handle.result()
        await witness.end()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.replans) == (GoalStatus.SUCCEEDED, 1, 1)
        assert np.abs(opened.joints() - ACROSS).max() < 0.005
        assert (witness.touched, witness.looks > 100) == (set(), True)
        assert opened.phases() == ["planning", "moving", "braking", "planning", "moving"]
        assert any("would touch post" in message.reason for message in opened.told)


def test_the_same_scenario_goes_the_same_way_twice(tmp_path: Path) -> None:
    """Bit for bit, searches and stops included."""

    async def scenario(folder: Path) -> list[FreeMotionFeedback]:
        async with free_cell(folder) as opened:
            await opened.go(THERE)
            handle = opened.send(free(ACROSS))
            await opened.until(lambda: opened.speed_rad_s() > 0.4)
            await opened.put(POST)
            await handle.result()
            return opened.told

    first, second = run_virtual(scenario(tmp_path)), run_virtual(scenario(tmp_path))
    assert first == second
    assert first[-1].replans == 1


@pytest.mark.virtual
async def test_the_answer_to_an_obstacle_takes_no_more_than_milliseconds(tmp_path: Path) -> None:
    """In the time that the simulated planner takes; see the benchmark for the true one."""
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        put_s = opened.bus.clock.now_s()
        await opened.put(POST)
        await opened.until_phase("braking")
        assert opened.bus.clock.now_s() - put_s < 0.03


@pytest.mark.virtual
async def test_an_obstacle_that_vanishes_lets_the_arm_go_on_along_its_way(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await opened.put(WALL)
        waiting = await opened.until_phase("waiting")
        assert "wall" in waiting.reason
        await opened.bus.clock.sleep(2.0)
        assert opened.speed_rad_s() < REST_RAD_S
        await opened.remove("wall")
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.reused, end.result.replans) == (GoalStatus.SUCCEEDED, 1, 0)
        assert 1.5 < end.result.waited_s < 4.0


@pytest.mark.virtual
async def test_a_way_that_stays_blocked_is_waited_for_with_the_reason_until_the_goal_is_cancelled(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await opened.put(WALL)
        await opened.bus.clock.sleep(10.0)
        assert (opened.told[-1].phase, "wall" in opened.told[-1].reason) == ("waiting", True)
        assert 5.0 < opened.told[-1].waited_s < 10.0
        shown = opened.bus.topic("left/planned_path", PathPreview).latest
        assert shown is not None
        assert (shown.state, "wall" in shown.reason) == ("blocked", True)
        handle.cancel()
        end = await handle.result()
        assert (end.status, opened.speed_rad_s() < REST_RAD_S) == (GoalStatus.CANCELED, True)
        await opened.remove("wall")
        assert (await opened.bus.send_goal(free(ACROSS), to="left").result()).status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
@pytest.mark.parametrize("patience_s", [0.0, 2.0])
async def test_when_patience_is_over_the_goal_fails_at_rest_and_its_result_says_what_was_in_the_way(
    tmp_path: Path, patience_s: float
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS, patience_s=patience_s))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        put_s = opened.bus.clock.now_s()
        await opened.put(WALL)
        end = await handle.result()
        assert end.cause is not None
        assert end.result is not None
        assert (end.status, end.result.stops) == (GoalStatus.ABORTED, 1)
        assert "wall" in end.result.blocked
        assert "wall" in end.cause.chain()[-1].message
        assert patience_s <= opened.bus.clock.now_s() - put_s < patience_s + 2.5
        assert opened.speed_rad_s() < REST_RAD_S


@pytest.mark.virtual
async def test_what_appears_too_near_to_stop_before_it_stops_the_arm_all_the_same_and_is_said(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS, speed=0.8))
        await opened.until(lambda: opened.speed_rad_s() > 1.2)
        x, y, z = (await opened.bus.call(ForwardKinematics(), to="left")).xyz
        await opened.put(box("hand", (0.1, 0.05, 0.1), (x + 0.03, y - 0.08, z)))
        await opened.until_phase("waiting")
        assert any("too late to stop before it" in message.reason for message in opened.told)
        assert opened.speed_rad_s() < REST_RAD_S
        handle.cancel()
        assert (await handle.result()).status is GoalStatus.CANCELED


@pytest.mark.virtual
async def test_a_held_goal_stays_held_whatever_comes_and_its_way_is_looked_at_before_it_goes_on(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await handle.hold()
        at = opened.joints()
        await opened.put(POST)
        await opened.bus.clock.sleep(1.0)
        await opened.remove("post")
        await opened.bus.clock.sleep(1.0)
        await opened.put(POST)
        await opened.bus.clock.sleep(1.0)
        assert (handle.status, np.abs(opened.joints() - at).max() < 0.001) == (GoalStatus.HELD, True)
        witness = Witness(opened, POST)
        await handle.resume()
        end = await handle.result()
        await witness.end()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.replans) == (GoalStatus.SUCCEEDED, 0, 1)
        assert witness.touched == set()


@pytest.mark.virtual
async def test_a_goal_held_while_it_waits_does_not_go_on_when_its_way_is_free_again(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS, patience_s=3.0))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await opened.put(WALL)
        await opened.until_phase("waiting")
        await handle.hold()
        at = opened.joints()
        await opened.remove("wall")
        await opened.bus.clock.sleep(10.0)
        assert (handle.status, np.abs(opened.joints() - at).max() < 0.001) == (GoalStatus.HELD, True)
        await handle.resume()
        assert (await handle.result()).status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
@pytest.mark.parametrize("cancel_after_s", [0.0, 0.01, 0.13, 0.2, *map(nightly, (0.001, 0.1, 0.125, 0.14, 0.15))])
async def test_a_goal_cancelled_in_any_moment_of_an_adaptation_ends_at_rest(
    tmp_path: Path, cancel_after_s: float
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await opened.put(POST)
        await opened.bus.clock.sleep(cancel_after_s)
        handle.cancel()
        end = await handle.result()
        assert (end.status, opened.speed_rad_s() < REST_RAD_S) == (GoalStatus.CANCELED, True)
        assert (await opened.go(THERE)).stops == 0


@pytest.mark.virtual
@pytest.mark.parametrize("hold_after_s", [0.0, 0.14, *map(nightly, (0.001, 0.1, 0.125, 0.13, 0.15, 0.2))])
async def test_a_goal_held_in_any_moment_of_an_adaptation_rests_and_goes_on_when_it_is_resumed(
    tmp_path: Path, hold_after_s: float
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await opened.put(POST)
        await opened.bus.clock.sleep(hold_after_s)
        await handle.hold()
        at = opened.joints()
        assert opened.speed_rad_s() < REST_RAD_S
        await opened.bus.clock.sleep(3.0)
        assert (handle.status, np.abs(opened.joints() - at).max() < 0.001) == (GoalStatus.HELD, True)
        witness = Witness(opened, POST)
        await handle.resume()
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
        await witness.end()
        assert witness.touched == set()


@pytest.mark.virtual
async def test_an_obstacle_that_keeps_approaching_a_resting_arm_finds_it_at_rest(tmp_path: Path) -> None:
    """There would be a way around; the arm does not start towards what moves beside it."""
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await opened.put(box("hand", (0.1, 0.1, 0.1), opened.ahead(0.6)))
        await opened.until_phase("braking")
        await opened.until(lambda: opened.speed_rad_s() < REST_RAD_S)
        x, y, z = (await opened.bus.call(ForwardKinematics(), to="left")).xyz
        at = opened.joints()
        for step in range(40):
            await opened.put(box("hand", (0.1, 0.1, 0.1), (x, y - 0.12 + 0.0005 * step, z)))
            await opened.bus.clock.sleep(0.05)
        assert np.abs(opened.joints() - at).max() < 0.001
        assert "hand moves within" in opened.told[-1].reason
        await opened.remove("hand")
        assert (await handle.result()).status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_an_obstacle_that_comes_and_goes_makes_the_arm_rest_ever_longer_and_never_tremble(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        for _ in range(20):
            await opened.put(WALL)
            await opened.bus.clock.sleep(0.1)
            await opened.remove("wall")
            await opened.bus.clock.sleep(0.1)
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops <= 8) == (GoalStatus.SUCCEEDED, True)


@pytest.mark.virtual
async def test_a_slowed_arm_is_watched_as_well(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        await opened.bus.call(SetSpeedOverride(share=0.2), to="left")
        handle = opened.send(free(ACROSS))
        await opened.until(lambda: opened.speed_rad_s() > 0.1)
        witness = Witness(opened, POST)
        await opened.put(POST)
        end = await handle.result()
        await witness.end()
        assert end.result is not None, end.cause
        assert (end.status, end.result.replans, witness.touched) == (GoalStatus.SUCCEEDED, 1, set())


@pytest.mark.virtual
async def test_without_watching_the_arm_goes_its_way_whatever_appears(tmp_path: Path) -> None:
    async with free_cell(tmp_path) as opened:
        await opened.go(THERE)
        handle = opened.send(free(ACROSS, watch=False))
        await opened.until(lambda: opened.speed_rad_s() > 0.4)
        await opened.put(WALL)
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops) == (GoalStatus.SUCCEEDED, 0)


@pytest.mark.virtual
@pytest.mark.parametrize("watch", [True, False])
async def test_two_arms_that_cross_reach_their_goals_and_only_touch_if_they_do_not_watch(
    tmp_path: Path, watch: bool
) -> None:
    """Both sweep the space between them at the same time; each has planned before the other one moved."""
    async with free_cell(tmp_path) as opened:
        await asyncio.gather(opened.go(FAR_THERE), opened.go(FAR_THERE, to="right"))
        touched = False
        began_s = opened.bus.clock.now_s()
        handles = [opened.send(free(FAR_ACROSS, watch=watch), to=arm) for arm in ("left", "right")]
        while not all(handle.finished for handle in handles):
            touched = touched or opened.touching() != ""
            await opened.bus.clock.sleep(0.01)
        ends = [await handle.result() for handle in handles]
        assert touched is not watch
        if watch:
            for end in ends:
                assert end.result is not None, end.cause
                assert np.abs(np.array(end.result.joints) - FAR_ACROSS).max() < 0.005
            assert opened.bus.clock.now_s() - began_s < 15.0


@pytest.mark.virtual
async def test_an_irb_goes_around_a_post_that_appears(tmp_path: Path) -> None:
    right, left = (-0.57, 0.17, -0.07, 0.0, 1.47, -0.57), (0.57, 0.17, -0.07, 0.0, 1.47, 0.57)
    async with free_cell(tmp_path, cell="irb4600.yaml") as opened:
        await opened.go(right, to="arm")
        handle = opened.send(free(left, speed=0.4), to="arm")
        await opened.until(lambda: opened.speed_rad_s("arm") > 0.3)
        x, y, _ = opened.ahead(0.6, arm="arm")
        post = box("post", (0.2, 0.2, 1.4), (x, y, 0.7))
        witness = Witness(opened, post, arm="arm")
        await opened.put(post)
        end = await handle.result()
        await witness.end()
        assert end.result is not None, end.cause
        assert (end.status, end.result.replans, witness.touched) == (GoalStatus.SUCCEEDED, 1, set())
        tool = await opened.bus.call(ForwardKinematics(), to="arm")
        assert np.abs(np.array(tool.xyz) - (1.1, 0.7, 1.2)).max() < 0.01


@pytest.mark.virtual
async def test_an_irb_goes_to_a_pose(tmp_path: Path) -> None:
    pose = Pose(xyz=(1.1, 0.7, 1.2), xyzw=(0.0, 1.0, 0.0, 0.0))
    async with free_cell(tmp_path, cell="irb4600.yaml") as opened:
        goal = MoveFree(target=MotionTarget(pose=pose), options=PlanOptions(speed=0.4))
        assert (await opened.bus.send_goal(goal, to="arm").result()).status is GoalStatus.SUCCEEDED
        tool = await opened.bus.call(ForwardKinematics(), to="arm")
        assert np.abs(np.array(tool.xyz) - pose.xyz).max() < 0.005
