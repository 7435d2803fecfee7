"""The collision-free motion skills: what is refused, what is planned and gone, what becomes of broken helpers."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.messages import Pose
from engine.skills.planning import (
    Adaptation,
    ExecutePlan,
    MotionTarget,
    MoveFree,
    PathPreview,
    PlanMotion,
    PlannedMotion,
    PlanOptions,
)
from engine.skills.planning_scene import AllowContact, ForgetOccupancy, PutObstacle, RemoveObstacle
from tests.robots.workspace.fake_cell import FakeCell, fake_cell
from tests.robots.workspace.free_cell import ACROSS, POST, THERE, WALL, box, free

FAR = Pose(xyz=(3.0, 0.0, 0.5))
HAND = ((-0.1, 0.05, 0.1), (0.0, 0.15, 0.75))
"""In the way from THERE to ACROSS, seen by the cameras."""


async def go(cell: FakeCell, joints: tuple[float, ...]) -> None:
    """Move to `joints`."""
    end = await cell.bus.send_goal(free(joints), to="left").result()
    assert end.status is GoalStatus.SUCCEEDED, end.cause


async def planned(cell: FakeCell, joints: tuple[float, ...] = THERE) -> PlannedMotion:
    """Plan to `joints`."""
    end = await cell.bus.send_goal(PlanMotion(target=MotionTarget(joints=joints)), to="left").result()
    assert end.result is not None, end.cause
    return end.result


def preview(cell: FakeCell) -> PathPreview:
    """Return what is shown."""
    shown = cell.bus.topic("left/planned_path", PathPreview).latest
    assert shown is not None
    return shown


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("target", "options", "words"),
    [
        (MotionTarget(), PlanOptions(), "either `joints` or `pose`"),
        (MotionTarget(joints=THERE, pose=FAR), PlanOptions(), "either `joints` or `pose`"),
        (MotionTarget(joints=(0.0, 1.0)), PlanOptions(), "got 2 joints"),
        (MotionTarget(joints=(float("nan"), *THERE[1:])), PlanOptions(), "not finite"),
        (MotionTarget(joints=(9.0, *THERE[1:])), PlanOptions(), "panda_joint1 at 9.0000 rad is outside"),
        (MotionTarget(pose=FAR), PlanOptions(), "reach"),
        (MotionTarget(pose=Pose(xyz=(0.0, 0.0, 0.5), frame="moon")), PlanOptions(), "'moon' is not known"),
        (MotionTarget(pose=Pose(xyz=(0.0, 0.0, 0.5), xyzw=(0.0, 0.0, 0.0, 0.0))), PlanOptions(), "not a pose"),
        (MotionTarget(joints=THERE), PlanOptions(planner="RRTConect"), "did you mean RRTConnect"),
        (MotionTarget(joints=(0.0, 1.6, 0.0, -0.8, 0.0, 1.6, 0.8)), PlanOptions(), "touches table"),
    ],
)
async def test_what_cannot_be_reached_is_rejected_with_the_reason_and_nothing_moves(
    target: MotionTarget, options: PlanOptions, words: str
) -> None:
    async with fake_cell() as cell:
        before = cell.port.sample().position_rad.copy()
        end = await cell.bus.send_goal(MoveFree(target=target, options=options), to="left").result()
        assert end.cause is not None
        assert (end.status, words in str(end.cause)) == (GoalStatus.REJECTED, True), end.cause
        assert (cell.port.followed, cell.cameras.required) == ([], 0)
        plan = await cell.bus.send_goal(PlanMotion(target=target, options=options), to="left").result()
        assert plan.cause is not None
        assert (plan.status in (GoalStatus.REJECTED, GoalStatus.ABORTED), words in str(plan.cause)) == (True, True)
        assert np.array_equal(cell.port.sample().position_rad, before)
        await go(cell, THERE)


@pytest.mark.virtual
async def test_a_plan_is_shown_and_not_gone_and_then_gone_as_it_is() -> None:
    async with fake_cell() as cell:
        plan = await planned(cell)
        assert (cell.port.followed, preview(cell).state) == ([], "proposed")
        assert plan.waypoints[0] == pytest.approx(tuple(cell.port.sample().position_rad))
        assert plan.waypoints[-1] == pytest.approx(THERE)
        assert preview(cell).joints[-1] == pytest.approx(THERE)
        assert len(preview(cell).tool_path) == len(preview(cell).joints)
        handle = cell.bus.send_goal(ExecutePlan(plan=plan), to="left")
        await handle.accepted()
        await cell.bus.clock.sleep(0.1)
        assert preview(cell).state == "moving"
        end = await handle.result()
        assert end.result is not None, end.cause
        assert np.abs(np.array(end.result.joints) - THERE).max() < 0.001
        assert end.result.duration_s == pytest.approx(plan.duration_s, abs=0.1)
        assert preview(cell).state == "none"


@pytest.mark.virtual
async def test_a_plan_may_begin_elsewhere_and_is_then_not_gone_from_here() -> None:
    async with fake_cell() as cell:
        goal = PlanMotion(target=MotionTarget(joints=ACROSS), start=THERE)
        plan = (await cell.bus.send_goal(goal, to="left").result()).result
        assert plan is not None
        assert plan.waypoints[0] == pytest.approx(THERE)
        end = await cell.bus.send_goal(ExecutePlan(plan=plan), to="left").result()
        assert (end.status, "does not start at the arm's current" in str(end.cause)) == (GoalStatus.REJECTED, True)


@pytest.mark.virtual
async def test_plans_that_make_no_sense_are_rejected() -> None:
    async with fake_cell() as cell:
        plan = await planned(cell)
        for changed, words in (
            (msgspec.structs.replace(plan, robot="right"), "the plan is for right"),
            (msgspec.structs.replace(plan, waypoints=()), "no waypoints"),
            (msgspec.structs.replace(plan, waypoints=((0.0,),)), "got 1 joints"),
            (msgspec.structs.replace(plan, waypoints=(plan.waypoints[0], (float("inf"),) * 7)), "not finite"),
            (msgspec.structs.replace(plan, waypoints=(plan.waypoints[0], (9.0, *THERE[1:]))), "outside"),
        ):
            end = await cell.bus.send_goal(ExecutePlan(plan=changed), to="left").result()
            assert (end.status, words in str(end.cause)) == (GoalStatus.REJECTED, True), end.cause
        assert cell.port.followed == []


@pytest.mark.virtual
async def test_a_planned_way_that_is_blocked_by_now_is_gone_around_or_rejected_where_nothing_may_be_adapted() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        plan = await planned(cell, ACROSS)
        await cell.bus.call(PutObstacle(obstacle=POST), to="cell")
        strict = ExecutePlan(plan=plan, adaptation=Adaptation(watch=False))
        end = await cell.bus.send_goal(strict, to="left").result()
        assert (end.status, "post" in str(end.cause)) == (GoalStatus.REJECTED, True), end.cause
        end = await cell.bus.send_goal(ExecutePlan(plan=plan), to="left").result()
        assert (end.status, np.abs(cell.port.sample().position_rad - ACROSS).max() < 0.001) == (
            GoalStatus.SUCCEEDED,
            True,
        )


@pytest.mark.virtual
async def test_what_the_cameras_see_is_gone_around_and_they_are_only_needed_meanwhile() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        assert cell.cameras.required == 0
        handle = await cell.begun(free(ACROSS))
        assert cell.cameras.required == 1
        cell.cameras.see(HAND)
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.replans) == (GoalStatus.SUCCEEDED, 1, 1)
        assert any("would touch an obstacle seen by the cameras" in message.reason for message in cell.told)
        assert cell.cameras.required == 0


BODY = ((-0.3, -0.36, 0.4), (-0.1, -0.2, 0.7))
"""Somebody who stands where the tool is to go, ACROSS."""


@pytest.mark.virtual
async def test_who_stands_at_the_goal_before_the_motion_begins_is_waited_for() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        cell.cameras.see(BODY)
        followed = len(cell.port.followed)
        handle = await cell.begun(free(ACROSS, time_s=0.2), after_s=2.0)
        assert (cell.told[-1].phase, len(cell.port.followed)) == ("waiting", followed)
        assert "an obstacle seen by the cameras" in cell.told[-1].reason or "no path" in cell.told[-1].reason
        cell.cameras.see()
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.replans) == (GoalStatus.SUCCEEDED, 0, 0)
        assert end.result.waited_s > 1.0


@pytest.mark.virtual
async def test_who_stands_at_the_goal_is_not_waited_for_without_patience() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        cell.cameras.see(BODY)
        goal = msgspec.structs.replace(free(ACROSS, time_s=0.2), adaptation=Adaptation(patience_s=0.0))
        end = await cell.bus.send_goal(goal, to="left").result()
        assert end.status is GoalStatus.REJECTED, end.cause


@pytest.mark.virtual
async def test_a_goal_that_waits_for_its_first_way_is_cancelled_and_held_like_any_other() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        cell.cameras.see(BODY)
        followed = len(cell.port.followed)
        handle = await cell.begun(free(ACROSS, time_s=0.2), after_s=1.0)
        await handle.hold()
        cell.cameras.see()
        await cell.bus.clock.sleep(1.0)
        assert len(cell.port.followed) == followed
        cell.cameras.see(BODY)
        await handle.resume()
        assert len(cell.port.followed) == followed
        handle.cancel()
        end = await handle.result()
        assert (end.status, len(cell.port.followed)) == (GoalStatus.CANCELED, followed), end.cause
        await go(cell, THERE)


@pytest.mark.virtual
async def test_cameras_know_what_the_scene_knows_and_forget_on_demand() -> None:
    async with fake_cell() as cell:
        await cell.bus.call(PutObstacle(obstacle=POST), to="cell")
        assert cell.cameras.known is not None
        assert {one.name for one in cell.cameras.known.obstacles} == {"table", "post"}
        await cell.bus.call(ForgetOccupancy(), to="cell")
        assert cell.cameras.forgotten == 1


@pytest.mark.virtual
async def test_an_arm_stops_and_waits_while_the_cameras_are_blind_and_goes_on_when_they_see_again() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        cell.cameras.go_blind("the camera process ended")
        await cell.bus.clock.sleep(1.0)
        assert (cell.moves(), cell.told[-1].phase) == (False, "waiting")
        assert "the camera process ended" in cell.told[-1].reason
        cell.cameras.see()
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.reused) == (GoalStatus.SUCCEEDED, 1)


@pytest.mark.virtual
async def test_with_blind_cameras_nothing_starts() -> None:
    async with fake_cell() as cell:
        cell.cameras.see()
        cell.cameras.go_blind("cameras lost")
        end = await cell.bus.send_goal(free(THERE), to="left").result()
        assert (end.status, "cameras lost" in str(end.cause)) == (GoalStatus.REJECTED, True), end.cause
        assert (cell.port.followed, cell.cameras.required) == ([], 0)


@pytest.mark.virtual
@pytest.mark.parametrize("sees", [True, False])
async def test_cameras_that_are_still_starting_are_waited_for(sees: bool) -> None:
    """On a new machine that takes half a minute; once they are up, an image is due within 3 s."""
    async with fake_cell() as cell:
        cell.cameras.see()
        cell.cameras.starting = True
        cell.cameras.go_blind("the cameras are still starting")
        handle = cell.bus.send_goal(free(THERE), to="left")
        await cell.bus.clock.sleep(30.0)
        assert cell.port.followed == []
        cell.cameras.starting = False
        cell.cameras.go_blind("no camera image yet")
        await cell.bus.clock.sleep(1.0)
        if sees:
            cell.cameras.see()
            assert (await handle.result()).status is GoalStatus.SUCCEEDED
        else:
            began_s = cell.bus.clock.now_s()
            end = await handle.result()
            assert (end.status, "no camera image yet" in str(end.cause)) == (GoalStatus.REJECTED, True), end.cause
            assert cell.bus.clock.now_s() - began_s == pytest.approx(2.0)


@pytest.mark.virtual
async def test_a_planner_that_dies_rejects_the_goal_that_needs_it_and_the_next_one_works() -> None:
    async with fake_cell() as cell:
        cell.planner.failing = "the planning process was ended by SIGKILL"
        end = await cell.bus.send_goal(free(THERE), to="left").result()
        assert (end.status, "SIGKILL" in str(end.cause)) == (GoalStatus.REJECTED, True), end.cause
        plan = await cell.bus.send_goal(PlanMotion(target=MotionTarget(joints=THERE)), to="left").result()
        assert (plan.status, "SIGKILL" in str(plan.cause)) == (GoalStatus.ABORTED, True), plan.cause
        cell.planner.failing = ""
        await go(cell, THERE)


@pytest.mark.virtual
async def test_an_arm_whose_watching_process_dies_stops_and_goes_on_with_a_new_one() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        cell.planner.failing = "the planning process was ended by SIGKILL"
        cell.cameras.see()
        await cell.bus.clock.sleep(1.0)
        assert (cell.moves(), cell.told[-1].phase) == (False, "waiting")
        assert "SIGKILL" in cell.told[-1].reason
        cell.planner.failing = ""
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops, end.result.reused) == (GoalStatus.SUCCEEDED, 1, 1)


@pytest.mark.virtual
async def test_a_change_that_nobody_can_look_at_stops_the_arm_at_once() -> None:
    """Who looked has died, and the next one takes seconds to start: nobody waits for an answer meanwhile."""
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        cell.planner.gone, cell.planner.silent_s = "the planning process was ended by SIGKILL", 3.0
        cell.cameras.see()
        await cell.bus.clock.sleep(0.02)
        assert (cell.told[-1].phase, "SIGKILL" in cell.told[-1].reason) == ("braking", True)
        cell.planner.gone, cell.planner.silent_s = "", 0.0
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.stops) == (GoalStatus.SUCCEEDED, 1)


@pytest.mark.virtual
async def test_an_arm_whose_check_is_not_answered_in_time_stops() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        cell.planner.silent_s = 1.0
        cell.cameras.see()
        await cell.bus.clock.sleep(0.5)
        assert (cell.moves(), "not checked within" in cell.told[-1].reason) == (False, True)
        cell.planner.silent_s = 0.0
        assert (await handle.result()).status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_the_search_is_not_repeated_without_end_while_nothing_changes() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        await cell.bus.call(PutObstacle(obstacle=WALL), to="cell")
        await cell.bus.clock.sleep(30.0)
        plans, checks = cell.planner.plans, cell.planner.checks
        await cell.bus.clock.sleep(30.0)
        assert cell.planner.plans - plans <= 16
        assert cell.planner.checks - checks <= 200
        await cell.bus.call(RemoveObstacle(name="wall"), to="cell")
        assert (await handle.result()).status is GoalStatus.SUCCEEDED


@pytest.mark.virtual
async def test_a_motion_that_fails_by_itself_fails_its_goal_also_while_it_is_watched_or_waits() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        cell.port.trip("panda_joint2 met 90 Nm")
        end = await handle.result()
        assert (end.status, "90 Nm" in str(end.cause)) == (GoalStatus.ABORTED, True)
        cell.port.recover()
        handle = await cell.begun(free(ACROSS))
        await cell.bus.call(PutObstacle(obstacle=WALL), to="cell")
        await cell.bus.clock.sleep(1.0)
        cell.port.trip("panda_joint2 met 95 Nm")
        end = await handle.result()
        assert (end.status, "95 Nm" in str(end.cause)) == (GoalStatus.ABORTED, True)


@pytest.mark.virtual
async def test_a_stop_by_somebody_else_ends_a_waiting_goal() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        await cell.bus.call(PutObstacle(obstacle=WALL), to="cell")
        await cell.bus.clock.sleep(1.0)
        await cell.arm.stop()
        end = await handle.result()
        assert (end.status, "stopped by another command" in str(end.cause)) == (GoalStatus.ABORTED, True)
        assert cell.cameras.required == 0


@pytest.mark.virtual
@pytest.mark.parametrize("after_s", [0.0, 0.05, 0.15, 0.29, 0.31, 1.0, 5.0])
@pytest.mark.parametrize("how", ["stop", "cancel"])
async def test_no_stop_waits_for_a_planner_that_says_nothing(how: str, after_s: float) -> None:
    """As while its process, which was killed, starts again."""
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        cell.planner.silent_s = 60.0
        cell.cameras.see(HAND)
        await cell.bus.clock.sleep(after_s)
        asked_s = cell.bus.clock.now_s()
        if how == "stop":
            await cell.arm.stop()
        else:
            handle.cancel()
        end = await handle.result()
        assert end.status is (GoalStatus.ABORTED if how == "stop" else GoalStatus.CANCELED)
        assert cell.bus.clock.now_s() - asked_s < 0.5
        assert (cell.moves(), cell.cameras.required) == (False, 0)


@pytest.mark.virtual
async def test_a_contact_that_becomes_allowed_lets_a_waiting_arm_go_on() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS))
        await cell.bus.call(PutObstacle(obstacle=WALL), to="cell")
        await cell.bus.clock.sleep(1.0)
        assert not handle.finished
        await cell.bus.call(AllowContact(first="left", second="wall"), to="cell")
        end = await handle.result()
        assert end.result is not None, end.cause
        assert (end.status, end.result.reused) == (GoalStatus.SUCCEEDED, 1)


@pytest.mark.virtual
async def test_a_goal_may_be_cancelled_while_it_is_planned() -> None:
    async with fake_cell() as cell:
        cell.planner.silent_s = 5.0
        handle = cell.bus.send_goal(free(THERE), to="left")
        await cell.bus.clock.sleep(0.5)
        handle.cancel()
        assert (await handle.result()).status is GoalStatus.CANCELED
        assert (cell.port.followed, cell.cameras.required) == ([], 0)
        cell.planner.silent_s = 0.0
        await go(cell, THERE)


@pytest.mark.virtual
async def test_an_obstacle_at_the_goal_is_waited_for_and_named() -> None:
    async with fake_cell() as cell:
        await go(cell, THERE)
        handle = await cell.begun(free(ACROSS, patience_s=5.0))
        x, y, z = preview(cell).tool_path[-1]
        await cell.bus.call(PutObstacle(obstacle=box("crate", (0.2, 0.2, 0.2), (x, y, z))), to="cell")
        end = await handle.result()
        assert end.result is not None
        assert (end.status, "crate" in end.result.blocked) == (GoalStatus.ABORTED, True)
