"""The planning process answers without holding up the loop, is withdrawn from, survives its own death."""

from __future__ import annotations

import asyncio
import os
import signal
import time

import msgspec
import numpy as np
import pytest

from benchmarks.planning_scenes import ARM, alone, cases
from engine.clock import LoopClock, run_virtual
from engine.errors import CellError, RobotError
from engine.messages import Pose
from engine.shapes import Capsule, Obstacle
from robots.model.kinematics import ArmKinematics
from robots.model.registry import robot_model
from robots.model.rigid import Rigid
from robots.planning.request import JointGoal, Plan, PlanRequest, Refusal
from robots.planning.worker import InlinePlanner, PlanningWorker, plan_service

SHELF = cases()[-1].request


def never_found() -> PlanRequest:
    """A post that the first link of an arm of two joints cannot pass."""
    origin = Rigid.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    tool = ArmKinematics(robot_model("servo_arm"), base=origin).tool_pose(np.array([1.57, 0.0]))
    x, y, z = tool.xyz.tolist()
    post = Obstacle.of("post", Capsule(radius_m=0.02, length_m=0.5), Pose(xyz=(0.3 * x, 0.3 * y, z)))
    return PlanRequest(
        scene=alone("servo_arm").with_obstacles(post),
        arm=ARM,
        start_rad=(0.4, 0.0),
        goal=JointGoal(joints_rad=((2.7, 0.0),)),
        time_s=60.0,
    )


async def test_plans_come_from_another_process_which_dies_and_is_replaced_and_the_loop_stays_free() -> None:
    """One story, because a start of the process takes seconds."""

    async with PlanningWorker() as planner:
        first = planner.pid
        assert first not in (0, os.getpid())
        answer = await planner.plan(msgspec.structs.replace(SHELF, speed=1.0))
        assert isinstance(answer, Plan)
        assert answer.timed is not None

        refused = await planner.plan(msgspec.structs.replace(SHELF, planner="EST"))
        assert isinstance(refused, Refusal)
        assert refused.reason == "unknown_planner"
        with pytest.raises(CellError, match="no arm in the planning scene is called left"):
            await planner.plan(msgspec.structs.replace(SHELF, arm="left"))

        # A request under way does not hold up the loop, and ends soon after it is withdrawn.
        longest_s = 0.0
        asked = asyncio.ensure_future(planner.plan(never_found()))
        for _ in range(50):
            before = time.monotonic()
            await asyncio.sleep(0.002)
            longest_s = max(longest_s, time.monotonic() - before)
        assert not asked.done()
        assert longest_s < 1.0
        asked.cancel()
        with pytest.raises(asyncio.CancelledError):
            await asked
        assert isinstance(await planner.plan(SHELF), Plan)
        assert planner.pid == first

        # Several at once are answered in turn.
        answers = await asyncio.gather(*(planner.plan(msgspec.structs.replace(SHELF, seed=k)) for k in range(4)))
        assert all(isinstance(one, Plan) for one in answers)

        # Killed while it works: who waits hears of it, the next request finds a new process.
        doomed = asyncio.ensure_future(planner.plan(never_found()))
        await asyncio.sleep(0.1)
        os.kill(first, signal.SIGKILL)
        with pytest.raises(RobotError, match="SIGKILL"):
            await doomed
        assert isinstance(await planner.plan(SHELF), Plan)
        assert planner.pid not in (0, first)
        last = planner.pid
    assert planner.pid == 0
    with pytest.raises(ProcessLookupError):
        os.kill(last, 0)
    with pytest.raises(RobotError, match="closed"):
        await planner.plan(SHELF)


def test_in_virtual_time_planning_is_inline_takes_no_time_and_repeats() -> None:
    async def story() -> tuple[object, float]:
        clock = LoopClock()
        service = plan_service(clock)
        assert isinstance(service, InlinePlanner)
        async with service as planner:
            answer = await planner.plan(SHELF)
            assert isinstance(answer, Plan)
            failed = await planner.plan(msgspec.structs.replace(never_found(), time_s=0.5))
            assert isinstance(failed, Refusal)
            assert failed.reason == "no_path_in_time"
            return (answer.waypoints_rad, failed), clock.now_s()

    first, second = run_virtual(story()), run_virtual(story())
    assert first == second
    assert first[1] == 0.0
